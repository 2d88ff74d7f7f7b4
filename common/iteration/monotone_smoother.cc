#include <common/contact/contact_forces.h>
#include <common/iteration/monotone_smoother.h>
#include <common/nodes/interface_damping.h>
#include <common/parallel/run_clock.h>

#include <algorithm>
#include <utility>

namespace Friction
{
  template <int dim>
  MonotoneSmoother<dim>::MonotoneSmoother(const DiscreteProblem<dim> &problem,
                                          const LocalSolver local_solver)
    : problem(problem)
    , inverses(problem.constraints.n_owned_nodes(), zero_block<dim>())
  {
    const RunScope               part(problem.communicator(), RunPart::levels);
    const NodeBlockMatrix<dim>  &matrix      = problem.stiffness.blocks();
    const NodalConstraints<dim> &constraints = problem.constraints;
    const ContactBoundary<dim>  &contact     = problem.contact;

    NodeRanges        ordinary;
    std::vector<char> is_ordinary(constraints.n_owned_nodes());
    for (unsigned int node = 0; node < is_ordinary.size(); ++node)
      is_ordinary[node] = !constraints.is_fixed(node);

    local_problems.reserve(contact.size());
    for (const ContactNode<dim> &p : contact)
      {
        is_ordinary[p.node] = false;

        NodeBlock<dim>       A       = zero_block<dim>();
        const NodeBlock<dim> damping = interface_damping(matrix, p.node);
        for (unsigned int e = 0; e < dim * dim; ++e)
          A[e] = matrix.diagonal(p.node)[e] + damping[e];
        if (damping != zero_block<dim>())
          damped_diagonals[p.node] = A;

        // The diagonal block in the frame of the node.
        std::array<double, dim * dim> block;
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int r = 0; r < dim; ++r)
            {
              double sum = 0;
              for (unsigned int k = 0; k < dim; ++k)
                for (unsigned int l = 0; l < dim; ++l)
                  sum += p.frame[r][k] * A[l * dim + k] * p.frame[c][l];
              block[c * dim + r] = sum;
            }
        local_problems.emplace_back(
          block, p.gap, p.n_free_tangents, local_solver);
      }

    // Hanging nodes, whose rows are empty, interrupt no range.
    for (unsigned int node = 0; node < is_ordinary.size(); ++node)
      if (matrix.is_empty(node))
        append(ordinary, node);
      else if (is_ordinary[node])
        {
          append(ordinary, node);

          NodeBlock<dim> block;
          std::copy_n(matrix.diagonal(node), dim * dim, block.begin());
          const NodeBlock<dim> damping = interface_damping(matrix, node);
          for (unsigned int e = 0; e < dim * dim; ++e)
            block[e] += damping[e];
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int r = 0; r < dim; ++r)
              if (constraints.is_prescribed(node, c) ||
                  constraints.is_prescribed(node, r))
                block[c * dim + r] = 0.;
          inverses[node] =
            pseudo_inverse<dim>(block, 1e-10 * trace<dim>(block.data()));
        }

    ordinary_nodes =
      std::make_unique<GaussSeidel<dim>>(matrix, inverses, ordinary);
    for (unsigned int p = 0; p < contact.size(); ++p)
      in_order.push_back(p);
    std::sort(in_order.begin(),
              in_order.end(),
              [&](const unsigned int p, const unsigned int q) {
                return contact[p].node < contact[q].node;
              });
    const SweepSchedule<dim> &schedule = ordinary_nodes->schedule();
    first_of_chunk.assign(schedule.n_chunks() + 1, 0);
    for (const ContactNode<dim> &p : contact)
      ++first_of_chunk[schedule.chunk_of(p.node) + 1];
    for (unsigned int c = 0; c < schedule.n_chunks(); ++c)
      first_of_chunk[c + 1] += first_of_chunk[c];
  }



  template <int dim>
  void
  MonotoneSmoother<dim>::relax(Iterate           &x,
                               const unsigned int n_sweeps,
                               const bool trust_first_normal_forces) const
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::leading_sweeps);
    const NodeBlockMatrix<dim> &matrix   = problem.stiffness.blocks();
    const BlockRows<dim>        rows     = matrix.rows();
    const ContactBoundary<dim> &contact  = problem.contact;
    const SweepSchedule<dim>   &schedule = ordinary_nodes->schedule();
    const double               *f        = problem.forces.begin();
    double                     *u        = x.u.begin();
    problem.stiffness.update_ghosts(x.u);
    if (x.residual.size() != x.u.size())
      x.residual.reinit(x.u, true);

    // Rows that are no ordinary nodes': contact nodes, and between them some
    // where nothing can move.
    const auto do_others = [&](const RowKernels::RowLoop &loop,
                               const bool                 update) {
      const RowRange all = loop.rows;
      const auto pass = [&](const unsigned int first, const unsigned int end) {
        if (first < end)
          RowKernels::pass<dim>(
            rows, {{first, end}, loop.prefetch, loop.left}, u);
      };
      const unsigned int chunk = schedule.chunk_of(all.first);
      const auto         node  = [&](const unsigned int number) {
        return contact[in_order[number]].node;
      };
      unsigned int begin = first_of_chunk[chunk],
                   end   = first_of_chunk[chunk + 1];
      while (begin < end && node(begin) < all.first)
        ++begin;
      while (begin < end && node(end - 1) >= all.second)
        --end;
      unsigned int next = all.first;
      for (unsigned int i = begin; i < end; ++i)
        {
          pass(std::exchange(next, node(i) + 1), node(i));
          loop.prefetch.step();
          relax_contact_node(in_order[i], x, update, loop.left);
        }
      pass(next, all.second);
    };

    schedule.run(
      n_sweeps,
      /*with residual =*/true,
      [&](const Stage &stage, const RowRange &ahead) {
        const RowRange all   = schedule.chunk(stage.chunk);
        Prefetch       fetch = matrix.prefetch(ahead, all.second - all.first);
        RowKernels::RowLoop loop{all, fetch, ordinary_nodes->left_sums(stage)};
        if (stage.computes_residual)
          return RowKernels::residual<dim>(
            rows, loop, x.residual.begin(), f, u);
        const bool update = x.updates_normal_forces &&
          (stage.sweep > 0 || !trust_first_normal_forces);
        ordinary_nodes->relax_chunk(
          stage, loop, f, u, [&](const RowKernels::RowLoop &others) {
            do_others(others, update);
          });
      },
      problem.stiffness.ghosts(),
      u);

    // The normal forces of the iterate as it is now, for all that follows.
    if (x.updates_normal_forces)
      set_normal_forces(problem.contact, x.residual, x.state);
  }



  template <int dim>
  void
  MonotoneSmoother<dim>::relax_contact_node(
    const unsigned int          p,
    Iterate                    &x,
    const bool                  update_normal_force,
    const RowKernels::LeftSums &left) const
  {
    const NodeBlockMatrix<dim> &matrix = problem.stiffness.blocks();
    const ContactNode<dim>     &node   = problem.contact[p];
    double                     *value  = x.u.begin() + dim * node.node;

    // The force that the other nodes leave, r~ = r + A_pp u_p in (6.18); at an
    // interface to other processes with the damping in A_pp. Displacements of
    // the local problem count from where friction does.
    const NodeValue<dim> product =
      RowKernels::times<dim>(matrix.rows(), node.node, x.u.begin(), left);
    const auto     damped = damped_diagonals.find(node.node);
    Tensor<1, dim> residual, force, old_value;
    NodeValue<dim> from_origin;
    for (unsigned int d = 0; d < dim; ++d)
      from_origin[d] = old_value[d] = value[d] - node.slip_origin[d];
    const NodeValue<dim> diagonal =
      times<dim>(damped == damped_diagonals.end() ? matrix.diagonal(node.node)
                                                  : damped->second.data(),
                 from_origin.data());
    for (unsigned int d = 0; d < dim; ++d)
      {
        residual[d] =
          problem.forces.local_element(dim * node.node + d) - product[d];
        force[d] = residual[d] + diagonal[d];
      }

    double bound = 0;
    if (problem.has_friction())
      {
        if (update_normal_force && !node.bound_is_given)
          x.state.set_normal_force(p,
                                   x.state.in_contact(p)
                                     ? std::max(0., residual * node.normal())
                                     : 0.);
        bound = problem.effective_coefficient(node) * x.state.normal_force(p);
      }

    std::array<double, dim>     b;
    std::array<double, dim - 1> tangential;
    for (unsigned int e = 0; e < dim; ++e)
      {
        b[e] = node.frame[e] * force;
        if (e > 0)
          tangential[e - 1] = node.frame[e] * old_value;
      }

    const LocalSolution<dim> z =
      local_problems[p].solve(b, bound, tangential, x.state.in_contact(p));
    Tensor<1, dim> new_value = node.slip_origin + z.normal * node.normal();
    for (unsigned int t = 1; t < dim; ++t)
      new_value += z.tangential[t - 1] * node.frame[t];
    for (unsigned int d = 0; d < dim; ++d)
      value[d] = new_value[d];
    x.state.set(p, z.in_contact, z.sticks);
    RowKernels::add_share<dim>(matrix.rows(), node.node, x.u.begin(), left);
  }



  template class MonotoneSmoother<2>;
  template class MonotoneSmoother<3>;
} // namespace Friction

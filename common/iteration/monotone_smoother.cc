#include <common/nodes/interface_damping.h>
#include <common/iteration/monotone_smoother.h>

#include <algorithm>

namespace Friction
{
  template <int dim>
  MonotoneSmoother<dim>::MonotoneSmoother(
    const NodeBlockMatrix<dim>  &matrix,
    const NodalConstraints<dim> &constraints,
    const ContactBoundary<dim>  &contact,
    const double                 friction_coefficient,
    const LocalSolver            local_solver)
    : matrix(matrix)
    , contact(contact)
    , friction_coefficient(friction_coefficient)
    , inverses(constraints.n_owned_nodes(), zero_block<dim>())
  {
    NodeRanges        ordinary;
    std::vector<char> is_ordinary(constraints.n_owned_nodes());
    for (unsigned int node = 0; node < is_ordinary.size(); ++node)
      is_ordinary[node] = !constraints.is_fixed(node);

    for (const ContactNode<dim> &p : contact)
      {
        is_ordinary[p.node] = false;

        NodeBlock<dim>       A       = zero_block<dim>();
        const NodeBlock<dim> damping = interface_damping(matrix, p.node);
        for (unsigned int e = 0; e < dim * dim; ++e)
          A[e] = matrix.block(matrix.row_begin(p.node))[e] + damping[e];
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

    for (unsigned int node = 0; node < is_ordinary.size(); ++node)
      if (is_ordinary[node])
        {
          append(ordinary, node);

          NodeBlock<dim> block;
          std::copy_n(
            matrix.block(matrix.row_begin(node)), dim * dim, block.begin());
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

    std::vector<unsigned int> coupled;
    std::vector<char>         is_coupled(constraints.n_nodes(), 0);
    for (unsigned int i = 0; i < matrix.n_rows(); ++i)
      for (std::size_t e = matrix.row_begin(i); e < matrix.row_end(i); ++e)
        is_coupled[matrix.column(e)] = 1;
    for (unsigned int i = matrix.n_rows(); i < is_coupled.size(); ++i)
      if (is_coupled[i])
        coupled.push_back(i);
    exchange =
      std::make_unique<GhostExchange>(constraints.numbering(), coupled);

    schedule = SweepSchedule<dim>(matrix, ordinary);
    first_contact.assign(schedule.n_chunks() + 1, 0);
    for (const ContactNode<dim> &p : contact)
      ++first_contact[schedule.chunk_of(p.node) + 1];
    for (unsigned int c = 0; c < schedule.n_chunks(); ++c)
      first_contact[c + 1] += first_contact[c];
    by_chunk.resize(contact.size());
    std::vector<unsigned int> next(first_contact.begin(),
                                   first_contact.end() - 1);
    for (unsigned int p = 0; p < contact.size(); ++p)
      by_chunk[next[schedule.chunk_of(contact[p].node)]++] = p;
  }



  template <int dim>
  void
  MonotoneSmoother<dim>::sweeps(VectorType       &u,
                                const VectorType &f,
                                ContactState     &state,
                                const Sweeps     &what,
                                VectorType       *residual) const
  {
    const auto relax_ordinary_nodes = [&](const unsigned int chunk) {
      const NodeRanges &nodes = schedule.nodes(chunk);
      for (unsigned int i = 0; i < nodes.size(); ++i)
        relax_nodes<dim>(matrix,
                         inverses,
                         nodes[what.backwards ? nodes.size() - 1 - i : i],
                         f.begin(),
                         u.begin(),
                         what.backwards);
    };
    const auto relax_contact_nodes = [&](const unsigned int chunk,
                                         const bool         update) {
      const unsigned int begin = first_contact[chunk],
                         end   = first_contact[chunk + 1];
      const auto at            = [&](const unsigned int i) {
        return by_chunk[what.backwards ? begin + end - 1 - i : i];
      };
      for (unsigned int i = begin; i < end; ++i)
        {
          if (i + 1 < end)
            matrix.prefetch(contact[at(i + 1)].node);
          relax_contact_node(at(i), u, f, state, update);
        }
    };

    schedule.run(
      what.n,
      residual != nullptr,
      what.backwards,
      [&](const unsigned int stage, const unsigned int chunk) {
        const bool update = what.update_normal_forces &&
          (stage > 0 || !what.trust_first_normal_forces);
        if (stage == what.n)
          matrix.residual(residual->begin(),
                          f.begin(),
                          u.begin(),
                          schedule.chunk(chunk).first,
                          schedule.chunk(chunk).second);
        else if (what.backwards)
          {
            relax_contact_nodes(chunk, update);
            relax_ordinary_nodes(chunk);
          }
        else
          {
            relax_ordinary_nodes(chunk);
            relax_contact_nodes(chunk, update);
          }
      },
      *exchange,
      u.begin());
  }



  template <int dim>
  void
  MonotoneSmoother<dim>::relax_contact_node(
    const unsigned int p,
    VectorType        &u,
    const VectorType  &f,
    ContactState      &state,
    const bool         update_normal_forces) const
  {
    const ContactNode<dim> &node  = contact[p];
    double                 *value = u.begin() + dim * node.node;

    // The force that the other nodes leave, r~ = r + A_pp u_p in (6.18); at an
    // interface to other processes with the damping in A_pp.
    const NodeValue<dim> product = matrix.row_times(node.node, u.begin());
    const auto           damped  = damped_diagonals.find(node.node);
    const NodeValue<dim> diagonal =
      times<dim>(damped == damped_diagonals.end()
                   ? matrix.block(matrix.row_begin(node.node))
                   : damped->second.data(),
                 value);
    Tensor<1, dim> residual, force, old_value;
    for (unsigned int d = 0; d < dim; ++d)
      {
        old_value[d] = value[d];
        residual[d]  = f.local_element(dim * node.node + d) - product[d];
        force[d]     = residual[d] + diagonal[d];
      }

    double bound = 0;
    if (friction_coefficient > 0)
      {
        if (update_normal_forces)
          state.set_normal_force(
            p,
            state.in_contact(p) ? std::max(0., residual * node.normal()) : 0.);
        bound = friction_coefficient * state.normal_force(p);
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
      local_problems[p].solve(b, bound, tangential, state.in_contact(p));
    Tensor<1, dim> new_value = z.normal * node.normal();
    for (unsigned int t = 1; t < dim; ++t)
      new_value += z.tangential[t - 1] * node.frame[t];
    for (unsigned int d = 0; d < dim; ++d)
      value[d] = new_value[d];
    state.set(p, z.in_contact, z.sticks);
  }



  template class MonotoneSmoother<2>;
  template class MonotoneSmoother<3>;
} // namespace Friction

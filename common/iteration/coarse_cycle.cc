#include <common/iteration/coarse_cycle.h>
#include <common/parallel/phase_costs.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace Friction
{
  namespace
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();

    // Sums the values that a node inherits from its parents into y.
    template <int dim>
    inline void
    add_prolongated(const NodeWeights &parents,
                    const unsigned int node,
                    const double      *coarse,
                    double            *y)
    {
      for (auto p = parents.begin(node); p != parents.end(node); ++p)
        for (unsigned int d = 0; d < dim; ++d)
          y[d] += p->weight * coarse[dim * p->node + d];
    }
  } // namespace



  template <int dim>
  CoarseCycle<dim>::CoarseCycle(const NodeBlockMatrix<dim>  &leaf_matrix,
                                const LevelHierarchy<dim>   &hierarchy,
                                const NodalConstraints<dim> &constraints,
                                const Cycle                  cycle,
                                const unsigned int           smoothing_steps,
                                const CoarsestMethod         coarsest_method)
    : hierarchy(hierarchy)
    , constraints(constraints)
    , cycle_parameter(cycle == Cycle::V ? 1 : 2)
    , smoothing_steps(smoothing_steps)
    , matrices(leaf_matrix, hierarchy, constraints)
  {
    coarsest = std::make_unique<CoarsestSolver<dim>>(
      hierarchy, matrices, coarsest_method);
    const unsigned int n = matrices.n_levels();
    for (unsigned int k = 0; k < n; ++k)
      {
        const auto &level = hierarchy.level(k);
        rhs.emplace_back(dim * level.n_local_nodes());
        schedules.emplace_back(matrices.matrix(k), level.relaxed_nodes());
        coupled_ghosts.emplace_back(level.numbering(), level.coupled_ghosts());
        transfer_ghosts.emplace_back(level.numbering(),
                                     level.transfer_ghosts());
      }
    correction = defect = work = rhs;
    start.resize(n);
    for (unsigned int k = 1; k < n; ++k)
      start[k] = rhs[k - 1];
  }



  template <int dim>
  std::size_t
  CoarseCycle<dim>::update(const Truncation<dim> &new_truncation)
  {
    return matrices.update(new_truncation);
  }



  template <int dim>
  void
  CoarseCycle<dim>::apply(VectorType &v, const VectorType &r)
  {
    bounded = false;
    run(v, r);
  }



  template <int dim>
  void
  CoarseCycle<dim>::apply_within_bounds(VectorType       &v,
                                        const VectorType &r,
                                        const VectorType &lower_bounds,
                                        const VectorType &upper_bounds)
  {
    bounded    = true;
    leaf_lower = &lower_bounds;
    leaf_upper = &upper_bounds;
    if (lower.empty())
      {
        lower = upper = rhs;
        for (const LevelVector &vector : rhs)
          restricted_bounds.emplace_back(4 * vector.size());
      }
    run(v, r);
  }



  template <int dim>
  void
  CoarseCycle<dim>::run(VectorType &v, const VectorType &r)
  {
    leaf_residual = &r;
    v             = 0.;
    for (LevelVector &c : correction)
      std::fill(c.begin(), c.end(), 0.);

    // The finest level has no unknowns of its own: its leaf nodes' residuals
    // are restricted as they are. If it is the coarsest one, too, there is no
    // cycle, but a direct solve.
    const unsigned int finest = hierarchy.n_levels() - 1;
    const unsigned int top    = finest == 0 ? 0 : finest - 1;
    restrict_residual(top);
    if (bounded)
      restrict_bounds(top);
    for (unsigned int i = 0; i < (top == 0 ? 1 : cycle_parameter); ++i)
      visit(top);

    // Each leaf node takes its correction from its finest level.
    {
      const PhaseScope phase(SolverPhase::transfer);
      transfer_ghosts[top].update(correction[top].data(), dim);
    }
    for (unsigned int k = 0; k <= top; ++k)
      for (const auto &own : hierarchy.level(k).own_nodes())
        for (unsigned int d = 0; d < dim; ++d)
          v.local_element(dim * own.leaf + d) =
            correction[k][dim * own.node + d];
    if (finest > top)
      for (const auto &own : hierarchy.level(finest).own_nodes())
        add_prolongated<dim>(hierarchy.level(finest).parents(),
                             own.node,
                             correction[top].data(),
                             v.begin() + dim * own.leaf);
    matrices.current_truncation().apply(v.begin());
  }



  // A W-cycle comes here more than once with the same right hand side. The
  // correction of each level then accumulates, and what a level has passed down
  // before is taken out of the defect, because the coarser levels remember it.
  template <int dim>
  void
  CoarseCycle<dim>::visit(const unsigned int k)
  {
    if (k == 0)
      {
        solve_coarsest();
        return;
      }

    const NodeWeights &parents = hierarchy.level(k).parents();
    const unsigned int n_nodes = hierarchy.level(k).n_nodes();
    LevelVector       &c       = correction[k];
    LevelVector       &coarse  = correction[k - 1];
    LevelVector       &before  = start[k];
    before                     = coarse;
    if (cycle_parameter == 1)
      relax(k, false, defect[k].data());
    else
      {
        // Defect of everything but the part inherited from below.
        relax(k, false);
        LevelVector &own = work[k];
        own              = c;
        for (unsigned int node = 0; node < n_nodes; ++node)
          {
            double inherited[dim] = {};
            add_prolongated<dim>(parents, node, coarse.data(), inherited);
            for (unsigned int d = 0; d < dim; ++d)
              own[dim * node + d] -= inherited[d];
          }
        const PhaseScope phase(SolverPhase::coarse_sweeps);
        coupled_ghosts[k].update(own.data(), dim);
        matrices.matrix(k).residual(
          defect[k].data(), rhs[k].data(), own.data());
      }
    restrict_residual(k - 1);
    if (bounded)
      restrict_bounds(k - 1);

    for (unsigned int i = 0; i < (k == 1 ? 1 : cycle_parameter); ++i)
      visit(k - 1);

    {
      const PhaseScope phase(SolverPhase::transfer);
      transfer_ghosts[k - 1].update(coarse.data(), dim);
      for (unsigned int i = 0; i < coarse.size(); ++i)
        before[i] = coarse[i] - before[i];
      for (unsigned int node = 0; node < n_nodes; ++node)
        add_prolongated<dim>(
          parents, node, before.data(), c.data() + dim * node);
      coupled_ghosts[k].update(c.data(), dim);
    }

    relax(k, true);
  }



  template <int dim>
  void
  CoarseCycle<dim>::relax(const unsigned int k,
                          const bool         backwards,
                          double            *defect_after)
  {
    const PhaseScope phase(SolverPhase::coarse_sweeps);
    if (!bounded)
      gauss_seidel_sweeps<dim>(schedules[k],
                               matrices.matrix(k),
                               matrices.inverse_diagonals(k),
                               rhs[k].data(),
                               correction[k].data(),
                               backwards,
                               smoothing_steps,
                               coupled_ghosts[k],
                               defect_after);
    else
      {
        for (unsigned int step = 0; step < smoothing_steps; ++step)
          relax_within_bounds(k, hierarchy.level(k).relaxed_nodes(), backwards);
        if (defect_after != nullptr)
          matrices.matrix(k).residual(
            defect_after, rhs[k].data(), correction[k].data());
      }
  }



  // Minimise over the node's box. Where the unconstrained block solution lies
  // inside, it is the minimiser; otherwise a few steps of coordinate descent,
  // each of which stays inside and lowers the energy, come close enough.
  template <int dim>
  void
  CoarseCycle<dim>::relax_within_bounds(const unsigned int k,
                                        const NodeRanges  &nodes,
                                        const bool         backwards)
  {
    const NodeBlockMatrix<dim> &B = matrices.matrix(k);
    double                     *c = correction[k].data();
    const double               *b = rhs[k].data(), *lo = lower[k].data(),
                 *up = upper[k].data();

    const auto relax_node = [&](const unsigned int i) {
      if (B.row_begin(i) == B.row_end(i))
        return;
      const NodeBlock<dim> &inverse = matrices.inverse_diagonals(k)[i];
      NodeValue<dim>        defect  = B.row_times(i, c);
      for (unsigned int d = 0; d < dim; ++d)
        defect[d] = b[dim * i + d] - defect[d];
      NodeValue<dim> step = times<dim>(inverse.data(), defect.data());

      bool inside = true;
      for (unsigned int d = 0; d < dim; ++d)
        inside = inside && c[dim * i + d] + step[d] <= up[dim * i + d] &&
          c[dim * i + d] + step[d] >= lo[dim * i + d];
      if (!inside)
        {
          const NodeBlock<dim> block = matrices.majorized_diagonal(k, i);
          NodeValue<dim>       before;
          step = NodeValue<dim>{};
          for (unsigned int sweep = 0; sweep < 10; ++sweep)
            {
              before = step;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  // A component that cannot move has a zero row in the inverse.
                  if (inverse[d * dim + d] == 0.)
                    continue;
                  double gradient = defect[d];
                  for (unsigned int e = 0; e < dim; ++e)
                    if (e != d)
                      gradient -= block[e * dim + d] * step[e];
                  step[d] = std::min(
                    std::max(gradient / block[d * dim + d],
                             std::min(0., lo[dim * i + d] - c[dim * i + d])),
                    std::max(0., up[dim * i + d] - c[dim * i + d]));
                }
              if (before == step)
                break;
            }
        }
      for (unsigned int d = 0; d < dim; ++d)
        c[dim * i + d] += step[d];
    };

    if (!backwards)
      for (const auto &range : nodes)
        for (unsigned int i = range.first; i < range.second; ++i)
          relax_node(i);
    else
      for (auto range = nodes.rbegin(); range != nodes.rend(); ++range)
        for (unsigned int i = range->second; i-- > range->first;)
          relax_node(i);
    coupled_ghosts[k].update(c, dim);
  }



  // Within bounds, the solution serves if it happens to be admissible.
  // Otherwise, in turns, relax, which settles what touches its bounds and what
  // leaves them, and solve for all that does not touch. A step that leaves the
  // bounds is projected back, or if the energy does not like this, shortened.
  // Each part stays within the bounds and lowers the energy, so that it may
  // end anywhere; what is left over is left to the next cycle. Few nodes have
  // bounds, however many the level has: few turns do.
  template <int dim>
  void
  CoarseCycle<dim>::solve_coarsest()
  {
    const PhaseScope   phase(SolverPhase::coarsest);
    LevelVector       &c        = correction[0];
    const unsigned int n_values = dim * hierarchy.level(0).n_nodes();
    if (!bounded)
      {
        coarsest->solve(c.data(), rhs[0].data());
        return;
      }

    const MPI_Comm              comm = constraints.communicator();
    const NodeBlockMatrix<dim> &B    = matrices.matrix(0);
    const LevelVector          &lo   = lower[0];
    const LevelVector          &up   = upper[0];
    LevelVector                &step = work[0];
    LevelVector                &r    = defect[0];
    LevelVector                 part(c.size()), image(c.size());
    const auto clamp = [&](const unsigned int i, const double length) {
      return std::min(std::max(c[i] + length * step[i], lo[i]), up[i]);
    };

    // Returns whether the bounds allow the whole step.
    const auto make_step = [&]() {
      double admissible = 1.;
      for (unsigned int i = 0; i < n_values; ++i)
        {
          const double room = (step[i] > 0 ? up[i] : lo[i]) - c[i];
          if (std::abs(step[i]) > std::abs(room))
            admissible = std::min(admissible, room / step[i]);
        }
      admissible    = -max_over_processes(-admissible, comm);
      double length = 1.;
      if (admissible < 1.)
        {
          const auto lowers_energy = [&]() {
            for (unsigned int i = 0; i < n_values; ++i)
              part[i] = clamp(i, length) - c[i];
            coupled_ghosts[0].update(part.data(), dim);
            B.vmult(image.data(), part.data());
            double gain = 0;
            for (unsigned int i = 0; i < n_values; ++i)
              gain += part[i] * (r[i] - .5 * image[i]);
            return sum_over_processes(gain, comm) > 0;
          };
          while (length > std::max(admissible, .01) && !lowers_energy())
            length *= .5;
          if (length <= std::max(admissible, .01))
            length = admissible;
        }
      for (unsigned int i = 0; i < n_values; ++i)
        c[i] = clamp(i, length);
      coupled_ghosts[0].update(c.data(), dim);
      return admissible == 1.;
    };

    coupled_ghosts[0].update(c.data(), dim);
    B.residual(r.data(), rhs[0].data(), c.data());
    coarsest->solve(step.data(), r.data());
    if (make_step())
      return;

    const NodeRanges  all = {{0, hierarchy.level(0).n_nodes()}};
    std::vector<char> is_fixed(n_values);
    for (unsigned int turn = 0; turn < 10; ++turn)
      {
        step = c;
        relax_within_bounds(0, all, false);
        relax_within_bounds(0, all, true);
        std::array<double, 2> change_and_size{};
        for (unsigned int i = 0; i < n_values; ++i)
          {
            change_and_size[0] =
              std::max(change_and_size[0], std::abs(c[i] - step[i]));
            change_and_size[1] = std::max(change_and_size[1], std::abs(c[i]));
          }
        change_and_size = max_over_processes(change_and_size, comm);
        if (change_and_size[0] <= 1e-6 * change_and_size[1])
          break;
        B.residual(r.data(), rhs[0].data(), c.data());
        for (unsigned int i = 0; i < n_values; ++i)
          is_fixed[i] = (c[i] <= lo[i] || c[i] >= up[i]);
        coarsest->solve_on_face(step.data(), r.data(), is_fixed);
        make_step();
      }
  }



  // The residual of a level: that of its own leaf nodes, and what the next
  // finer level leaves over. A process contributes what it owns of these, to
  // nodes of others as well.
  template <int dim>
  void
  CoarseCycle<dim>::restrict_residual(const unsigned int k)
  {
    const PhaseScope phase(SolverPhase::transfer);
    const auto      &level = hierarchy.level(k);
    LevelVector     &r     = rhs[k];
    const double    *finer = k + 2 < hierarchy.n_levels() ? defect[k + 1].data()
                                                          : leaf_residual->begin();
    for (unsigned int node = 0; node < level.n_local_nodes(); ++node)
      {
        double sum[dim] = {};
        for (auto child = level.children().begin(node);
             child != level.children().end(node);
             ++child)
          for (unsigned int d = 0; d < dim; ++d)
            sum[d] += child->weight * finer[dim * child->node + d];
        for (unsigned int d = 0; d < dim; ++d)
          r[dim * node + d] = sum[d];
      }
    for (const auto &own : level.own_nodes())
      for (unsigned int d = 0; d < dim; ++d)
        r[dim * own.node + d] +=
          leaf_residual->local_element(dim * own.leaf + d);
    transfer_ghosts[k].collect(r.data(), dim, GhostExchange::Combine::add);
  }



  // Monotone restriction: what the finer nodes in the support of a coarse
  // function have left, added to what the coarse node has already moved; and
  // the bounds of the level's own leaf nodes, which are bounds of all of it.
  // The lower bounds are turned around, so that there are only minima.
  template <int dim>
  void
  CoarseCycle<dim>::restrict_bounds(const unsigned int k)
  {
    const PhaseScope phase(SolverPhase::transfer);
    const auto      &level      = hierarchy.level(k);
    const bool       finer_last = (k + 2 >= hierarchy.n_levels());
    LevelVector     &bounds     = restricted_bounds[k];
    const auto       room = [&](const bool is_upper, const unsigned int i) {
      if (finer_last)
        return is_upper ? leaf_upper->local_element(i)
                              : -leaf_lower->local_element(i);
      return is_upper ? upper[k + 1][i] - correction[k + 1][i]
                            : correction[k + 1][i] - lower[k + 1][i];
    };

    std::fill(bounds.begin(), bounds.end(), infinity);
    for (unsigned int node = 0; node < level.n_local_nodes(); ++node)
      for (auto child = level.children().begin(node);
           child != level.children().end(node);
           ++child)
        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int side = 0; side < 2; ++side)
            {
              double &bound = bounds[4 * (dim * node + d) + side];
              bound = std::min(bound, room(side == 0, dim * child->node + d));
            }
    for (const auto &own : level.own_nodes())
      for (unsigned int d = 0; d < dim; ++d)
        {
          double            *bound = &bounds[4 * (dim * own.node + d)];
          const unsigned int leaf  = dim * own.leaf + d;
          bound[2] = std::min(bound[2], leaf_upper->local_element(leaf));
          bound[3] = std::min(bound[3], -leaf_lower->local_element(leaf));
        }
    transfer_ghosts[k].collect(
      bounds.data(), 4 * dim, GhostExchange::Combine::minimum);

    for (unsigned int i = 0; i < dim * level.n_nodes(); ++i)
      {
        const double *bound = &bounds[4 * i];
        const double  moved = correction[k][i];
        upper[k][i] = std::min(moved + std::max(0., bound[0]), bound[2]);
        lower[k][i] = std::max(moved - std::max(0., bound[1]), -bound[3]);
      }
  }



  template <int dim>
  std::size_t
  CoarseCycle<dim>::memory_consumption() const
  {
    std::size_t bytes = matrices.memory_consumption();
    for (const auto &v : {&rhs,
                          &correction,
                          &start,
                          &defect,
                          &work,
                          &lower,
                          &upper,
                          &restricted_bounds})
      for (const LevelVector &vector : *v)
        bytes += vector.capacity() * sizeof(double);
    return bytes;
  }



  template class CoarseCycle<2>;
  template class CoarseCycle<3>;
} // namespace Friction

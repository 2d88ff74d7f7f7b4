#include <common/compatibility.h>
#include <common/multigrid/coarse_cycle.h>

#include <algorithm>
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
  CoarseCycle<dim>::CoarseCycle(const DoFHandler<dim>       &dof_handler,
                                const NodeBlockMatrix<dim>  &leaf_matrix,
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
      dof_handler, matrices, coarsest_method);
    const unsigned int n = matrices.n_levels();
    rhs.resize(n);
    for (unsigned int k = 0; k < n; ++k)
      rhs[k].reinit(dof_handler.locally_owned_mg_dofs(k),
                    Compatibility::mpi_communicator(dof_handler));
    correction = defect = work = rhs;
    for (unsigned int k = 0; k < n; ++k)
      schedules.emplace_back(matrices.matrix(k),
                             hierarchy.level(k).relaxed_nodes());
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
      lower = upper = rhs;
    run(v, r);
  }



  template <int dim>
  void
  CoarseCycle<dim>::run(VectorType &v, const VectorType &r)
  {
    leaf_residual = &r;
    v             = 0.;
    for (auto &c : correction)
      c = 0.;

    const unsigned int finest = hierarchy.n_levels() - 1;
    if (finest == 0)
      {
        // The coarsest mesh is the leaf mesh: no cycle, but a direct solve.
        restrict_residual(0, finest_residual);
        if (bounded)
          restrict_bounds(0);
        solve_coarsest();
        for (const unsigned int node : hierarchy.level(0).own_nodes())
          for (unsigned int d = 0; d < dim; ++d)
            v.local_element(dim * hierarchy.level(0).leaf_node(node) + d) =
              correction[0].local_element(dim * node + d);
        matrices.current_truncation().apply(v.begin());
        return;
      }

    // The finest level has no unknowns of its own: its leaf nodes' residuals
    // are restricted as they are.
    const auto        &level = hierarchy.level(finest);
    const unsigned int below = finest - 1;
    if (finest_residual.size() == 0)
      finest_residual.reinit(dim * level.n_nodes());
    for (const unsigned int node : level.own_nodes())
      for (unsigned int d = 0; d < dim; ++d)
        finest_residual.local_element(dim * node + d) =
          r.local_element(dim * level.leaf_node(node) + d);
    restrict_residual(below, finest_residual);
    if (bounded)
      restrict_bounds(below);

    for (unsigned int i = 0; i < (below == 0 ? 1 : cycle_parameter); ++i)
      visit(below);

    // Each leaf node takes its correction from its finest level.
    for (unsigned int k = 0; k <= finest; ++k)
      for (const unsigned int node : hierarchy.level(k).own_nodes())
        {
          const unsigned int leaf  = hierarchy.level(k).leaf_node(node);
          double            *value = v.begin() + dim * leaf;
          if (k < finest)
            for (unsigned int d = 0; d < dim; ++d)
              value[d] = correction[k].local_element(dim * node + d);
          else
            add_prolongated<dim>(
              level.parents(), node, correction[below].begin(), value);
        }
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
    VectorType        &c       = correction[k];
    VectorType        &coarse  = correction[k - 1];
    VectorType        &before  = start[k];
    before                     = coarse;
    if (cycle_parameter == 1)
      relax(k, false, defect[k].begin());
    else
      {
        // Defect of everything but the part inherited from below.
        relax(k, false);
        VectorType &own = work[k];
        own             = c;
        for (unsigned int node = 0; node < hierarchy.level(k).n_nodes(); ++node)
          {
            double inherited[dim] = {};
            add_prolongated<dim>(parents, node, coarse.begin(), inherited);
            for (unsigned int d = 0; d < dim; ++d)
              own.local_element(dim * node + d) -= inherited[d];
          }
        matrices.matrix(k).residual(
          defect[k].begin(), rhs[k].begin(), own.begin());
      }
    restrict_residual(k - 1, defect[k]);
    if (bounded)
      restrict_bounds(k - 1);

    for (unsigned int i = 0; i < (k == 1 ? 1 : cycle_parameter); ++i)
      visit(k - 1);

    before.sadd(-1., 1., coarse);
    for (unsigned int node = 0; node < hierarchy.level(k).n_nodes(); ++node)
      add_prolongated<dim>(
        parents, node, before.begin(), c.begin() + dim * node);

    relax(k, true);
  }



  template <int dim>
  void
  CoarseCycle<dim>::relax(const unsigned int k,
                          const bool         backwards,
                          double            *defect_after)
  {
    if (!bounded)
      gauss_seidel_sweeps<dim>(schedules[k],
                               matrices.matrix(k),
                               matrices.inverse_diagonals(k),
                               rhs[k].begin(),
                               correction[k].begin(),
                               backwards,
                               smoothing_steps,
                               defect_after);
    else
      {
        for (unsigned int step = 0; step < smoothing_steps; ++step)
          relax_within_bounds(k, hierarchy.level(k).relaxed_nodes(), backwards);
        if (defect_after != nullptr)
          matrices.matrix(k).residual(
            defect_after, rhs[k].begin(), correction[k].begin());
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
    double                     *c = correction[k].begin();
    const double               *b = rhs[k].begin(), *lo = lower[k].begin(),
                 *up = upper[k].begin();

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
          const double  *block = B.block(B.row_begin(i));
          NodeValue<dim> before;
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
    VectorType &c = correction[0];
    if (!bounded)
      {
        coarsest->solve(c, rhs[0]);
        return;
      }

    const NodeBlockMatrix<dim> &B    = matrices.matrix(0);
    const double               *lo   = lower[0].begin();
    const double               *up   = upper[0].begin();
    VectorType                 &step = work[0];
    VectorType                 &r    = defect[0];
    const auto clamp = [&](const unsigned int i, const double length) {
      const double x = c.local_element(i) + length * step.local_element(i);
      return std::min(std::max(x, lo[i]), up[i]);
    };

    // Returns whether the bounds allow the whole step.
    const auto make_step = [&]() {
      double admissible = 1.;
      for (unsigned int i = 0; i < step.locally_owned_size(); ++i)
        {
          const double s    = step.local_element(i);
          const double room = (s > 0 ? up[i] : lo[i]) - c.local_element(i);
          if (std::abs(s) > std::abs(room))
            admissible = std::min(admissible, room / s);
        }
      double length = 1.;
      if (admissible < 1.)
        {
          const auto lowers_energy = [&]() {
            VectorType part(step), image(step);
            for (unsigned int i = 0; i < step.locally_owned_size(); ++i)
              part.local_element(i) = clamp(i, length) - c.local_element(i);
            B.vmult(image.begin(), part.begin());
            return part * r > .5 * (part * image);
          };
          while (length > std::max(admissible, .01) && !lowers_energy())
            length *= .5;
          if (length <= std::max(admissible, .01))
            length = admissible;
        }
      for (unsigned int i = 0; i < step.locally_owned_size(); ++i)
        c.local_element(i) = clamp(i, length);
      return admissible == 1.;
    };

    B.residual(r.begin(), rhs[0].begin(), c.begin());
    coarsest->solve(step, r);
    if (make_step())
      return;

    const NodeRanges  all = {{0, hierarchy.level(0).n_nodes()}};
    std::vector<char> is_fixed(c.locally_owned_size());
    for (unsigned int turn = 0; turn < 10; ++turn)
      {
        step = c;
        relax_within_bounds(0, all, false);
        relax_within_bounds(0, all, true);
        step -= c;
        if (step.linfty_norm() <= 1e-6 * c.linfty_norm())
          break;
        B.residual(r.begin(), rhs[0].begin(), c.begin());
        for (unsigned int i = 0; i < c.locally_owned_size(); ++i)
          is_fixed[i] =
            (c.local_element(i) <= lo[i] || c.local_element(i) >= up[i]);
        coarsest->solve_on_face(step, r, is_fixed);
        make_step();
      }
  }



  // The residual of a level: that of its own leaf nodes, and what the next
  // finer level leaves over.
  template <int dim>
  void
  CoarseCycle<dim>::restrict_residual(const unsigned int k,
                                      const VectorType  &finer_defect)
  {
    const auto &level = hierarchy.level(k);
    VectorType &r     = rhs[k];
    for (unsigned int node = 0; node < level.n_nodes(); ++node)
      {
        double sum[dim] = {};
        for (auto child = level.children().begin(node);
             child != level.children().end(node);
             ++child)
          for (unsigned int d = 0; d < dim; ++d)
            sum[d] +=
              child->weight * finer_defect.local_element(dim * child->node + d);
        for (unsigned int d = 0; d < dim; ++d)
          r.local_element(dim * node + d) = sum[d];
      }
    for (const unsigned int node : level.own_nodes())
      for (unsigned int d = 0; d < dim; ++d)
        r.local_element(dim * node + d) +=
          leaf_residual->local_element(dim * level.leaf_node(node) + d);
  }



  // Monotone restriction: what the finer nodes in the support of a coarse
  // function have left, added to what the coarse node has already moved.
  template <int dim>
  void
  CoarseCycle<dim>::restrict_bounds(const unsigned int k)
  {
    const auto &level       = hierarchy.level(k);
    const bool  has_finer   = (k + 1 < hierarchy.n_levels());
    const auto &finer       = hierarchy.level(has_finer ? k + 1 : k);
    const bool  finer_last  = (k + 2 == hierarchy.n_levels());
    const auto  finer_bound = [&](const bool         is_upper,
                                 const unsigned int node,
                                 const unsigned int d) {
      const unsigned int leaf = finer.leaf_node(node);
      if (finer_last)
        return constraints.is_hanging(leaf)
           ? (is_upper ? infinity : -infinity)
           : (is_upper ? leaf_upper : leaf_lower)->local_element(dim * leaf + d);
      return (is_upper ? upper : lower)[k + 1].local_element(dim * node + d) -
        correction[k + 1].local_element(dim * node + d);
    };

    for (unsigned int node = 0; node < level.n_nodes(); ++node)
      for (unsigned int d = 0; d < dim; ++d)
        {
          double up = infinity, lo = -infinity;
          for (auto child = level.children().begin(node);
               child != level.children().end(node);
               ++child)
            {
              up = std::min(up, finer_bound(true, child->node, d));
              lo = std::max(lo, finer_bound(false, child->node, d));
            }
          const double moved = correction[k].local_element(dim * node + d);
          upper[k].local_element(dim * node + d) = moved + std::max(0., up);
          lower[k].local_element(dim * node + d) = moved + std::min(0., lo);
        }
    for (const unsigned int node : level.own_nodes())
      for (unsigned int d = 0; d < dim; ++d)
        {
          const unsigned int leaf = dim * level.leaf_node(node) + d;
          double            &up   = upper[k].local_element(dim * node + d);
          double            &lo   = lower[k].local_element(dim * node + d);
          up = std::min(up, leaf_upper->local_element(leaf));
          lo = std::max(lo, leaf_lower->local_element(leaf));
        }
  }



  template <int dim>
  std::size_t
  CoarseCycle<dim>::memory_consumption() const
  {
    std::size_t bytes = matrices.memory_consumption();
    for (const auto &v :
         {&rhs, &correction, &start, &defect, &work, &lower, &upper})
      for (const VectorType &vector : *v)
        bytes += vector.memory_consumption();
    return bytes;
  }



  template class CoarseCycle<2>;
  template class CoarseCycle<3>;
} // namespace Friction

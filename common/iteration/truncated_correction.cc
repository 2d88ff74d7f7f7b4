#include <common/iteration/truncated_correction.h>
#include <common/parallel/owned_values.h>

namespace Friction
{
  namespace
  {
    // When a level is visited twice in a V-cycle: from a share of nodes in
    // lines or planes on the next finer level, and from a ratio of unknowns on;
    // and on how many levels at most, since that many times double the visits
    // of the coarsest.
    constexpr double       mostly_together = .5;
    constexpr unsigned int coarsening = 3, most_doubled = 4;
  } // namespace



  template <int dim>
  TruncatedCorrection<dim>::TruncatedCorrection(
    Levels<dim>       &levels,
    const Cycle        cycle,
    const unsigned int smoothing_steps,
    const bool         relaxes_together)
    : levels(levels)
    , relaxes_together(relaxes_together)
    , cycle(cycle)
    , smoothing_steps(smoothing_steps)
  {}



  template <int dim>
  void
  TruncatedCorrection<dim>::set_up()
  {
    const unsigned int n = levels.n_correction_levels();
    relaxes_leaf = relaxes_together && levels.hierarchy().n_levels() > 1 &&
      levels.share_relaxed_together(n) > 0;
    // The coarsest level is solved, so that once is enough.
    n_visits.assign(n, 1);
    unsigned int n_doubled = 0;
    for (unsigned int k = n; k-- > 1;)
      if (cycle == Cycle::W)
        n_visits[k] = 2;
      else if (relaxes_together &&
               levels.share_relaxed_together(k + 1) >= mostly_together &&
               coarsening * levels.n_dofs(k) <= levels.n_dofs(k + 1) &&
               n_doubled < most_doubled)
        {
          n_visits[k] = 2;
          ++n_doubled;
        }
    for (unsigned int k = 0; k < n; ++k)
      {
        rhs.push_back(levels.vector(k));
        correction.push_back(levels.vector(k));
        defect.push_back(levels.vector(k));
      }
    start.resize(n);
    work.resize(n);
  }



  template <int dim>
  void
  TruncatedCorrection<dim>::update(const Linearization<dim> &linearization,
                                   const Iterate &)
  {
    levels.update(linearization.truncation());
  }



  template <int dim>
  void
  TruncatedCorrection<dim>::apply(VectorType &v, const VectorType &r)
  {
    const PhaseScope phase(levels.communicator(), SolverPhase::transfer);
    const LevelTransfer<dim> &transfer = levels.transfer();
    if (rhs.empty())
      set_up();

    // If there is but one level, there is no cycle, but a direct solve.
    const unsigned int finest      = levels.hierarchy().n_levels() - 1;
    const unsigned int top         = finest == 0 ? 0 : finest - 1;
    const unsigned int leaf_sweeps = (smoothing_steps + 1) / 2;
    leaf_residual                  = &r;
    v                              = 0.;
    if (relaxes_leaf)
      {
        leaf_defect.reinit(r, true);
        levels.relax_leaf(v, r, leaf_sweeps, &leaf_defect);
        leaf_start    = v;
        v             = 0.;
        leaf_residual = &leaf_defect;
      }
    for (VectorType &c : correction)
      c = 0.;
    is_untouched.assign(correction.size(), true);
    restrict_residual(top);
    for (unsigned int i = 0; i < n_visits[top]; ++i)
      visit(top);

    // Each leaf node takes its correction from its finest level.
    for (unsigned int k = 0; k <= top; ++k)
      transfer.copy_to_leaf(k, v, correction[k]);
    if (finest > 0)
      transfer.prolongate_to_leaf(v, correction[top]);
    levels.matrices().current_truncation().apply(v.begin());
    if (relaxes_leaf)
      {
        add_owned(v, 1., leaf_start);
        levels.relax_leaf(v, r, leaf_sweeps);
      }
  }



  // A W-cycle comes here more than once with the same right hand side. The
  // correction of each level then accumulates, and what a level has passed down
  // before is taken out of the defect, because the coarser levels remember it.
  template <int dim>
  void
  TruncatedCorrection<dim>::visit(const unsigned int k)
  {
    is_untouched[k] = false;
    if (k == 0)
      {
        solve_coarsest();
        return;
      }

    const LevelTransfer<dim> &transfer = levels.transfer();
    VectorType               &c        = correction[k];
    VectorType               &coarse   = correction[k - 1];
    const bool                is_first = is_untouched[k - 1];
    if (is_first)
      relax(k, &defect[k]);
    else
      {
        // Defect of everything but the part inherited from below.
        start[k] = coarse;
        relax(k, nullptr);
        VectorType &own = work[k];
        own.reinit(c);
        transfer.prolongate_and_add(k, own, coarse);
        scale_owned(own, -1.);
        add_owned(own, 1., c);
        const PhaseScope phase(levels.communicator(),
                               SolverPhase::coarse_sweeps);
        levels.coupled_ghosts(k).update(own.begin(), dim);
        levels.matrices().matrix(k).residual(
          defect[k].begin(), rhs[k].begin(), own.begin());
      }
    restrict_residual(k - 1);

    for (unsigned int i = 0; i < n_visits[k - 1]; ++i)
      visit(k - 1);

    if (is_first)
      transfer.prolongate_and_add(k, c, coarse);
    else
      {
        VectorType &change = start[k];
        scale_owned(change, -1.);
        add_owned(change, 1., coarse);
        transfer.prolongate_and_add(k, c, change);
      }
    levels.coupled_ghosts(k).update(c.begin(), dim);
    relax(k, nullptr);
  }



  // The residual of a level: that of its own leaf nodes, and what the next
  // finer level leaves over.
  template <int dim>
  void
  TruncatedCorrection<dim>::restrict_residual(const unsigned int k)
  {
    const LevelTransfer<dim> &transfer = levels.transfer();
    rhs[k]                             = 0.;
    if (k + 1 < levels.n_correction_levels())
      transfer.restrict_and_add(k + 1, rhs[k], defect[k + 1]);
    else if (k + 1 < levels.hierarchy().n_levels())
      transfer.restrict_from_leaf(rhs[k], *leaf_residual);
    transfer.add_from_leaf(k, rhs[k], *leaf_residual);
    prepare_visits(k);
  }



  template <int dim>
  void
  TruncatedCorrection<dim>::relax(const unsigned int k,
                                  VectorType        *defect_after)
  {
    levels.relax(k, correction[k], rhs[k], smoothing_steps, defect_after);
  }



  template <int dim>
  void
  TruncatedCorrection<dim>::solve_coarsest()
  {
    const PhaseScope phase(levels.communicator(), SolverPhase::coarsest);
    levels.coarsest_solver().solve(correction[0].begin(), rhs[0].begin());
  }



  template <int dim>
  std::size_t
  TruncatedCorrection<dim>::memory_consumption() const
  {
    std::size_t bytes = levels.memory_consumption();
    bytes += leaf_defect.memory_consumption() + leaf_start.memory_consumption();
    for (const auto &vectors : {&rhs, &correction, &start, &defect, &work})
      for (const VectorType &vector : *vectors)
        bytes += vector.memory_consumption();
    return bytes;
  }



  template class TruncatedCorrection<2>;
  template class TruncatedCorrection<3>;
} // namespace Friction

#include <common/algorithms/newton_finish.h>

#include <algorithm>

namespace Friction
{
  namespace
  {
    // Iterations for one linear problem of Newton's method, and altogether: as
    // a part of the cycles that would be left, but so many at least.
    constexpr unsigned int per_problem       = 5;
    constexpr double       part_of_the_rest  = .5;
    constexpr unsigned int fewest_altogether = 12;
  } // namespace



  template <int dim>
  NewtonFinish<dim>::NewtonFinish(MonotoneMultigrid<dim> &iteration,
                                  const MakeNewton       &make_newton,
                                  const unsigned int      longest_end)
    : iteration(iteration)
    , make_newton(make_newton)
    , longest_end(longest_end)
  {}



  template <int dim>
  SolverReport
  NewtonFinish<dim>::solve(VectorType            &u,
                           ContactState          &state,
                           const CoulombSettings &settings,
                           const Progress        &progress)
  {
    const DiscreteProblem<dim> &problem = iteration.problem();
    if (!problem.has_coulomb_friction() ||
        settings.algorithm == Algorithm::fixed_point)
      return CoulombSolver<dim>(iteration, settings).solve(u, state, progress);

    CoulombSettings newtons_settings(settings);
    newtons_settings.limits.patience = per_problem;
    SolverReport           by_newton;
    std::vector<CycleInfo> cycles;
    unsigned int           next_try      = 0;
    bool                   is_hopeless   = false;
    const auto             try_to_finish = [&](const unsigned int n_cycles,
                                   const double       cycles_left) {
      if (is_hopeless || n_cycles < next_try || cycles_left <= longest_end)
        return false;
      const double left =
        std::min(cycles_left, 1. * settings.limits.maximum_cycles);
      newtons_settings.limits.maximum_cycles = std::max(
        fewest_altogether, static_cast<unsigned int>(part_of_the_rest * left));
      VectorType         solution       = u;
      ContactState       solution_state = state;
      NewtonSolver<dim> &newton         = make_newton();
      by_newton                         = solve_by_newton(
        newton, solution, solution_state, newtons_settings, progress);
      cycles.insert(
        cycles.end(), by_newton.cycles.begin(), by_newton.cycles.end());
      if (by_newton.converged)
        {
          u     = solution;
          state = solution_state;
        }
      is_hopeless = newton.n_steps() <= 1;
      next_try    = 2 * n_cycles;
      return by_newton.converged;
    };
    CoulombSettings its_settings(settings);
    its_settings.limits.finish = try_to_finish;
    SolverReport report =
      CoulombSolver<dim>(iteration, its_settings).solve(u, state, progress);
    report.finished_by_newton = by_newton.converged;
    if (by_newton.converged)
      report.algebraic_error = by_newton.algebraic_error;
    report.cycles.insert(report.cycles.end(), cycles.begin(), cycles.end());
    return report;
  }



  template class NewtonFinish<2>;
  template class NewtonFinish<3>;
} // namespace Friction

#include <common/algorithms/newton_finish.h>

#include <algorithm>
#include <utility>
#include <vector>

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

    SolverReport by_newton;
    bool         is_hopeless = false;
    unsigned int next_try    = 0;

    // Those of Newton's method, and after how many of Algorithm 3 they were
    // made.
    std::vector<std::pair<unsigned int, CycleInfo>> more_cycles;

    const Progress progress_of_all = [&](const unsigned int n_cycles,
                                         const double       increment) {
      if (progress)
        progress(n_cycles + more_cycles.size(), increment);
    };

    const auto try_to_finish = [&](const unsigned int n_cycles,
                                   const double       cycles_left) {
      if (is_hopeless || n_cycles < next_try || cycles_left <= longest_end)
        return false;
      const double left = std::min<double>(
        cycles_left, settings.limits.maximum_cycles - n_cycles);
      CoulombSettings its_settings(settings);
      its_settings.limits.iterations_per_problem = per_problem;
      its_settings.limits.maximum_cycles         = std::max(
        fewest_altogether, static_cast<unsigned int>(part_of_the_rest * left));
      VectorType         solution       = u;
      ContactState       solution_state = state;
      NewtonSolver<dim> &newton         = make_newton();
      by_newton =
        solve_by_newton<dim>(newton,
                             solution,
                             solution_state,
                             its_settings,
                             [&](const unsigned int k, const double increment) {
                               progress_of_all(n_cycles + k, increment);
                             });
      for (const CycleInfo &cycle : by_newton.cycles)
        more_cycles.emplace_back(n_cycles, cycle);
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
    SolverReport report        = CoulombSolver<dim>(iteration, its_settings)
                            .solve(u, state, progress_of_all);
    report.finished_by_newton = by_newton.converged;
    if (by_newton.converged)
      report.algebraic_error = by_newton.algebraic_error;
    // Levels are the same.
    report.solver_memory =
      std::max(report.solver_memory,
               by_newton.solver_memory +
                 iteration.leading_smoother().memory_consumption());
    for (std::size_t k = more_cycles.size(); k-- > 0;)
      report.cycles.insert(report.cycles.begin() + more_cycles[k].first,
                           more_cycles[k].second);
    return report;
  }



  template class NewtonFinish<2>;
  template class NewtonFinish<3>;
} // namespace Friction

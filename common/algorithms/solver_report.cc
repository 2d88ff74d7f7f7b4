#include <common/algorithms/solver_report.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  double
  SolverReport::rho_tau_as_printed() const
  {
    double logarithm = 0;
    for (const double change : outer_changes)
      logarithm += std::log(std::max(change, 1e-300));
    return outer_changes.empty() ? 0.
                                 : std::exp(logarithm / outer_changes.size());
  }



  double
  SolverReport::rho_tau_contraction() const
  {
    if (outer_changes.size() < 2 || outer_changes.front() == 0)
      return 0.;
    return std::pow(outer_changes.back() / outer_changes.front(),
                    1. / (outer_changes.size() - 1));
  }



  void
  SolverReport::set_result(const MultigridResult &result)
  {
    converged        = result.converged;
    inner_converged  = result.converged;
    algebraic_error  = result.algebraic_error;
    outer_iterations = 1;
    cycles           = result.cycles;
    contraction      = result.contraction();
    pace             = contraction;
  }



  void
  SolverReport::add_earlier(const SolverReport &report)
  {
    outer_iterations += report.outer_iterations;
    cycles.insert(cycles.begin(), report.cycles.begin(), report.cycles.end());
    // The same again, as when a force is searched for, is told once.
    std::vector<SolverAttempt> earlier = report.attempts;
    if (!earlier.empty() && !attempts.empty() && earlier.back().converged &&
        attempts.front().converged &&
        earlier.back().name == attempts.front().name)
      {
        attempts.front().cycles += earlier.back().cycles;
        earlier.pop_back();
      }
    attempts.insert(attempts.begin(), earlier.begin(), earlier.end());
  }
} // namespace Friction

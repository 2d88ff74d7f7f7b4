#ifndef friction_tests_benchmarks_report_h
#define friction_tests_benchmarks_report_h

#include <common/nodes/nodal_constraints.h>

#include <functional>
#include <string>

namespace Benchmark
{
  using namespace Friction;

  /** How a solver to compare with has fared. */
  struct BaselineReport
  {
    /// Its own criterion has been met; whether the solution is one is for the
    /// certificate to say.
    bool converged = false;

    unsigned int iterations       = 0; ///< Newton steps, sweeps, iterations
    unsigned int inner_iterations = 0; ///< of GMRES within them
    unsigned int n_setups         = 1; ///< factorisations, or AMG hierarchies
    std::size_t  memory           = 0; ///< bytes held at most

    /// The product's safeguards: how many attempts, and the name of the last.
    unsigned int n_attempts = 1;
    std::string  attempt;
  };

  /**
   * Is called after each iteration and may ask for the present iterate, which
   * some methods do not have at hand: what it costs to make it up is no part of
   * the method.
   */
  using Watch = std::function<void(const std::function<VectorType()> &)>;
} // namespace Benchmark

#endif

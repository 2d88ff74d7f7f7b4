#ifndef friction_tests_benchmarks_gauss_seidel_h
#define friction_tests_benchmarks_gauss_seidel_h

#include <common/discretization/discrete_problem.h>
#include <common/iteration/monotone_smoother.h>

#include <tests/benchmarks/baselines/report.h>

namespace Benchmark
{
  /**
   * Nonlinear block Gauss-Seidel on the leaf mesh alone: the product without
   * its coarse levels. Stops when the relative energy norm of the increment of
   * a sweep is at most the product's tolerance, which says little about the
   * error, or when its time is up.
   */
  template <int dim>
  class GaussSeidel
  {
  public:
    GaussSeidel(const DiscreteProblem<dim> &problem,
                const double                tolerance,
                const double                seconds);

    BaselineReport
    solve(VectorType &u, ContactState &state, const Watch &watch = {});

  private:
    const DiscreteProblem<dim>  problem;
    const double                tolerance, seconds;
    const MonotoneSmoother<dim> smoother;
  };
} // namespace Benchmark

#endif

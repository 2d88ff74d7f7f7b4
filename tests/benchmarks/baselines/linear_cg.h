#ifndef friction_tests_benchmarks_linear_cg_h
#define friction_tests_benchmarks_linear_cg_h

#include <tests/benchmarks/baselines/elasticity_amg.h>
#include <tests/benchmarks/baselines/report.h>

namespace Benchmark
{
  /**
   * Conjugate gradients for the linear problem without any contact,
   * preconditioned by the same algebraic multigrid as in NewtonGmres and with
   * the same criterion to stop.
   */
  template <int dim>
  class LinearCg
  {
  public:
    static constexpr unsigned int maximum_iterations = 1000;
    static constexpr double       tolerance          = 1e-9;

    LinearCg(const DiscreteProblem<dim>    &problem,
             const std::vector<Point<dim>> &points);

    BaselineReport solve(VectorType &u, const Watch &watch = {});

  private:
    const RotatedProblem<dim> rotated;
    std::vector<char>         fixed;
    ElasticityAmg<dim>        amg;
  };
} // namespace Benchmark

#endif

#include <deal.II/base/timer.h>

#include <tests/benchmarks/baselines/gauss_seidel.h>

#include <cmath>

namespace Benchmark
{
  template <int dim>
  GaussSeidel<dim>::GaussSeidel(const DiscreteProblem<dim> &problem,
                                const double                tolerance,
                                const double                seconds)
    : problem(problem)
    , tolerance(tolerance)
    , seconds(seconds)
    , smoother(this->problem)
  {}



  template <int dim>
  BaselineReport
  GaussSeidel<dim>::solve(VectorType   &u,
                          ContactState &state,
                          const Watch  &watch)
  {
    // Sweeps are quickest several at a time. The increment is that of the last
    // one, for which residuals are compared only now and then.
    constexpr unsigned int n_at_a_time = 10;
    BaselineReport         report;
    Timer                  timer;
    Iterate                x(u, state, problem.has_friction());
    bool                   first = true;
    report.memory                = smoother.memory_consumption();

    VectorType last_u, last_residual;
    while (timer.cpu_time() < seconds)
      {
        smoother.relax(x, n_at_a_time - 1, first);
        first         = false;
        last_u        = u;
        last_residual = x.residual;
        smoother.relax(x, 1);
        const VectorType &residual = x.residual;
        report.iterations += n_at_a_time;

        double increment = 0, norm = 0;
        for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
          {
            increment += (u.local_element(i) - last_u.local_element(i)) *
              (last_residual.local_element(i) - residual.local_element(i));
            norm += u.local_element(i) *
              (problem.forces.local_element(i) - residual.local_element(i));
          }
        if (watch)
          {
            timer.stop();
            watch([&]() { return u; });
            timer.start();
          }
        if (!std::isfinite(increment))
          break;
        if (increment <= tolerance * tolerance * norm)
          {
            report.converged = true;
            break;
          }
      }
    return report;
  }



  template class GaussSeidel<2>;
  template class GaussSeidel<3>;
} // namespace Benchmark

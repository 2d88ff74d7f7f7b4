#include <tests/benchmarks/baselines/linear_cg.h>

#include <cmath>

namespace Benchmark
{
  namespace
  {
    template <int dim>
    std::vector<char>
    fixed_dofs(const RotatedProblem<dim> &rotated)
    {
      std::vector<char> fixed(rotated.n_dofs());
      for (std::size_t i = 0; i < fixed.size(); ++i)
        fixed[i] = rotated.is_fixed(i);
      return fixed;
    }
  } // namespace



  template <int dim>
  LinearCg<dim>::LinearCg(const DiscreteProblem<dim>    &problem,
                          const std::vector<Point<dim>> &points)
    : rotated(problem)
    , fixed(fixed_dofs(rotated))
    , amg(rotated, points, fixed)
  {
    AssertThrow(problem.contact.size() == 0,
                ExcMessage("A linear solver cannot cope with contact."));
  }



  template <int dim>
  BaselineReport
  LinearCg<dim>::solve(VectorType &u, const Watch &watch)
  {
    BaselineReport report;
    report.memory     = amg.memory_consumption();
    VectorType r      = rotated.residual(u), z(r), p(r), Ap(r);
    double     energy = 0;
    for (std::size_t i = 0; i < fixed.size(); ++i)
      {
        energy += u.local_element(i) *
          (rotated.problem.forces.local_element(i) - r.local_element(i));
        if (fixed[i])
          r.local_element(i) = 0.;
      }
    amg.vmult(z, r);
    p                   = z;
    double       rz     = r * z;
    const double target = tolerance * std::sqrt(std::max(energy, 1e-300));
    while (std::isfinite(rz) && std::sqrt(rz) > target &&
           report.iterations < maximum_iterations)
      {
        rotated.vmult(Ap, p);
        for (std::size_t i = 0; i < fixed.size(); ++i)
          if (fixed[i])
            Ap.local_element(i) = 0.;
        const double length = rz / (p * Ap);
        u.add(length, p);
        r.add(-length, Ap);
        ++report.iterations;
        if (watch)
          watch([&]() { return u; });
        amg.vmult(z, r);
        const double before = rz;
        rz                  = r * z;
        p.sadd(rz / before, 1., z);
      }
    report.converged = std::sqrt(rz) <= target;
    return report;
  }



  template class LinearCg<2>;
  template class LinearCg<3>;
} // namespace Benchmark

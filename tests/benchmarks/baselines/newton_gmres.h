#ifndef friction_tests_benchmarks_newton_gmres_h
#define friction_tests_benchmarks_newton_gmres_h

#include <tests/benchmarks/baselines/coulomb_law.h>
#include <tests/benchmarks/baselines/elasticity_amg.h>
#include <tests/benchmarks/baselines/report.h>

#include <memory>
#include <vector>

namespace Benchmark
{
  /**
   * The semismooth Newton method for Coulomb friction with an iterative solver:
   * GMRES, preconditioned by algebraic multigrid, and solved no more accurately
   * than the step of Newton's method deserves (Eisenstat and Walker 1996). In
   * three dimensions nothing is known that is quicker.
   *
   * Within a step normal components in contact and sticking components are
   * known, and are eliminated. The matrix of the others is symmetric but for
   * the dependence of the friction bounds on normal forces in the rows of
   * sliding nodes.
   *
   * GMRES minimises the residual in the norm of the preconditioner's inverse,
   * $\sqrt{r^TM^{-1}r}$, which is the energy norm of the error but for the
   * quality of the preconditioner. Newton's method stops when it is a given
   * fraction of the energy norm of the solution, whatever the mesh.
   *
   * The preconditioner is made once, for the phases of the initial guess: a
   * node that has changed its phase costs an iteration at most, whereas a new
   * hierarchy costs as much as many. Derivatives of friction that have become
   * larger or smaller since are taken care of by scaling.
   */
  template <int dim>
  class NewtonGmres
  {
  public:
    static constexpr unsigned int maximum_steps      = 60;
    static constexpr unsigned int maximum_iterations = 1000; // per step
    static constexpr unsigned int restart            = 100;
    static constexpr double       tolerance          = 1e-9;

    /** Makes the preconditioner. */
    NewtonGmres(const DiscreteProblem<dim>    &problem,
                const std::vector<Point<dim>> &points,
                const VectorType              &u,
                const ContactState            &state);

    BaselineReport
    solve(VectorType &u, ContactState &state, const Watch &watch = {});

  private:
    const RotatedProblem<dim>           rotated;
    const double                        F;
    const std::vector<Point<dim>>       points;
    std::vector<double>                 stiffness;
    std::vector<LinearizedLaw<dim>>     laws;
    std::vector<char>                   fixed; // in the present step
    std::unique_ptr<ElasticityAmg<dim>> amg;
    ContactBlocks<dim>                  amg_second;
    std::vector<NodeBlock<dim>>         scaling;

    ContactBlocks<dim> second_derivatives() const;
    void               fix_components();
    void               make_preconditioner();
    void               scale_preconditioner();
    void               linearize_all(const VectorType &u, const VectorType &r);
    void               vmult(VectorType &y, const VectorType &x) const;
    void               precondition(VectorType &z, const VectorType &r) const;

    // Improves v until the residual, initially R with z = M^{-1} R, is at most
    // the target. Returns the number of iterations.
    unsigned int gmres(VectorType       &v,
                       VectorType        R,
                       VectorType        z,
                       const double      target,
                       const VectorType &u,
                       const Watch      &watch) const;
  };
} // namespace Benchmark

#endif

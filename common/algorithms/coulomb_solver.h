#ifndef friction_algorithms_coulomb_solver_h
#define friction_algorithms_coulomb_solver_h

#include <common/algorithms/multigrid_loop.h>
#include <common/algorithms/solver_report.h>
#include <common/parameters/solver_settings.h>

namespace Friction
{
  /** Which algorithm, and when it ends. */
  struct CoulombSettings
  {
    /** What the user has chosen. */
    explicit CoulombSettings(const SolverSettings &settings);

    Algorithm       algorithm;
    MultigridLimits limits; ///< of each multigrid iteration

    /// Of Algorithm 2; see SolverSettings.
    double       outer_tolerance;
    unsigned int maximum_outer_iterations;
    double       outer_damping;
    unsigned int mixed_outer_iterations;

    double certificate_tolerance;
  };



  /**
   * Solves the discrete contact problem with the law of friction it has.
   *
   * Without friction, and with given friction bounds (Tresca), the monotone
   * multigrid iteration does it. Coulomb's law ties the bounds to the normal
   * forces of the solution itself:
   * - Algorithm 2 iterates (6.11): solve with given normal forces, take those
   *   of the solution, and so on until they no longer change.
   * - Algorithm 3 lets the leading relaxation use the normal forces of the
   *   intermediate iterate, and needs no outer iteration.
   */
  template <int dim>
  class CoulombSolver
  {
  public:
    /**
     * @param iteration  the step to be repeated, and with it the discrete
     *                   problem; kept by reference.
     * @param settings   which algorithm, and when to stop.
     */
    CoulombSolver(MonotoneMultigrid<dim> &iteration,
                  const CoulombSettings  &settings);

    /**
     * Solves, and certifies the solution. Collective.
     * @param u      admissible initial guess, and solution.
     * @param state  the same; with the law of Tresca its normal forces are the
     *               given ones.
     */
    SolverReport
    solve(VectorType &u, ContactState &state, const Progress &progress = {});

  private:
    MonotoneMultigrid<dim> &iteration;
    const CoulombSettings   settings;

    void iterate_normal_forces(SolverReport   &report,
                               Iterate        &x,
                               const Progress &progress);
  };



  /**
   * Fills in what the report says of a displacement itself, as opposed to how
   * it was found: residual, energy and certificate. Collective.
   */
  template <int dim>
  void certify(SolverReport                &report,
               const TrescaFunctional<dim> &functional,
               const VectorType            &u,
               const ContactState          &state);
} // namespace Friction

#endif

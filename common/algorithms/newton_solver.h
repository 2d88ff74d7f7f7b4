#ifndef friction_algorithms_newton_solver_h
#define friction_algorithms_newton_solver_h

#include <common/algorithms/multigrid_loop.h>
#include <common/contact/semismooth_law.h>
#include <common/iteration/contact_strip.h>
#include <common/iteration/contact_truncation.h>
#include <common/iteration/leaf_relaxation.h>
#include <common/iteration/tresca_functional.h>
#include <common/iteration/truncated_correction.h>

#include <vector>

namespace Friction
{
  /**
   * Newton's method for the laws of contact and friction, SemismoothLaw: for
   * the problems in which the bounds of friction react so strongly to the
   * displacement that iterations with bounds of the moment, Algorithms 2 and 3,
   * go to and fro.
   *
   * A step eliminates what is known of it, normal components in contact and
   * tangential ones that stick, and solves for the others by GMRES (Saad 1993,
   * the flexible variant). The matrix is the truncated one of Linearization,
   * but for the rows of sliding nodes, where the bound of friction depends on
   * the displacement; so a multigrid cycle for the truncated matrix, a
   * TruncatedCorrection with relaxation of the leaf mesh before and after it,
   * is its preconditioner. What friction adds acts on the contact boundary
   * only, as an operator of order zero, on waves of all lengths alike. The
   * cycle leaves it to GMRES, which would take the more iterations the larger
   * the coefficient of friction is. So a strip along sliding nodes is solved
   * with all terms before the correction and after it, see ContactStrip.
   *
   * Linear problems are solved no more accurately than the step deserves
   * (Eisenstat and Walker 1996). There is no energy that would decrease. What
   * decides over the length of a step is the violation of the law, the
   * Euclidean norm of all nodal forces that are wrong; steps after the first
   * are halved until it decreases, six times at most.
   */
  template <int dim>
  class NewtonSolver
  {
  public:
    /// Layers of the strip along sliding nodes. In three dimensions factors of
    /// a deep one cost more than they save.
    static constexpr unsigned int n_layers = dim == 2 ? 8 : 2;

    /** References are kept. Collective.
     * @param smoother         for relaxation of the leaf mesh.
     * @param correction       with levels that are @p levels.
     * @param smoothing_steps  on the leaf mesh before and after a correction.
     */
    NewtonSolver(const TrescaFunctional<dim> &functional,
                 const MonotoneSmoother<dim> &smoother,
                 Levels<dim>                 &levels,
                 TruncatedCorrection<dim>    &correction,
                 const unsigned int           smoothing_steps);

    /**
     * Solves. Collective.
     * @param u      initial guess with its prescribed values, and solution.
     * @param state  the phases and normal forces of the guess, with which the
     *               first step reckons, and those of the solution.
     * @param limits Of these, one cycle is one iteration of GMRES.
     * @return a record per iteration of GMRES, with the increment of the step
     *         of Newton's method that it belongs to.
     */
    MultigridResult solve(VectorType            &u,
                          ContactState          &state,
                          const MultigridLimits &limits,
                          const Progress        &progress = {});

    /** Steps of Newton's method in the last solution. */
    unsigned int
    n_steps() const
    {
      return steps;
    }

    /** Bytes on this process, those of the correction included. */
    std::size_t memory_consumption() const;

  private:
    const TrescaFunctional<dim>    &functional;
    const DiscreteProblem<dim>     &problem;
    Levels<dim>                    &levels;
    TruncatedCorrection<dim>       &correction;
    const unsigned int              smoothing_steps;
    ContactTruncation<dim>          truncation;
    LeafRelaxation<dim>             relaxation;
    ContactStrip<dim>               strip;
    std::vector<SemismoothLaw<dim>> laws;
    std::vector<NodeValue<dim>>     slopes; // F e, of each contact node
    unsigned int                    steps = 0;

    // f - A u; and vectors of work, an image under A among them.
    VectorType residual, image, defect, smoothed, correction_part;

    // Truncation, levels and relaxation become those of the laws.
    void follow_phases();

    // Turns A v into the left hand side of the equations to be solved.
    void apply_laws(VectorType &Av, const VectorType &v) const;

    // On return @p step is what is known of it, and @p rhs what is to be solved
    // for the rest.
    void eliminate_known(VectorType &step, VectorType &rhs);

    // What is left of @p r.
    void find_defect(const VectorType &r, const VectorType &v);

    // A multigrid cycle, with the strip before and after coarse levels.
    void precondition(VectorType &v, const VectorType &r);

    struct LinearSolution
    {
      bool         converged  = true;
      unsigned int iterations = 0;
    };

    LinearSolution solve_linear(VectorType        &v,
                                const VectorType  &rhs,
                                const double       tolerance,
                                const unsigned int maximum_iterations);

    // The norm of all nodal forces that are wrong.
    double violation(const VectorType &residual) const;

    bool same_phases(const std::vector<SemismoothLaw<dim>> &others) const;

    void set_state(ContactState &state, const VectorType &residual) const;
  };
} // namespace Friction

#endif

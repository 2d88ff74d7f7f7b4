#ifndef friction_iteration_multigrid_newton_step_h
#define friction_iteration_multigrid_newton_step_h

#include <common/iteration/contact_strip.h>
#include <common/iteration/leaf_relaxation.h>
#include <common/iteration/newton_equations.h>
#include <common/iteration/truncated_correction.h>

namespace Friction
{
  /**
   * Solves the equations of a step of Newton's method by GMRES (Saad 1993, the
   * flexible variant). A multigrid cycle for the truncated matrix, a
   * TruncatedCorrection with relaxation of the leaf mesh before and after it,
   * is its preconditioner. What friction adds acts on the contact boundary
   * only, as an operator of order zero, on waves of all lengths alike. The
   * cycle leaves it to GMRES, which would take the more iterations the larger
   * the coefficient of friction is. So a strip along sliding nodes is solved
   * with all terms before the correction and after it, see ContactStrip.
   */
  template <int dim>
  class MultigridNewtonStep : public NewtonStep<dim>
  {
  public:
    /// Layers of the strip along sliding nodes. With a coefficient of friction
    /// of at most one it has none, and consists of the sliding nodes only. In
    /// three dimensions factors of a deep strip cost more than they save.
    static constexpr unsigned int n_layers = dim == 2 ? 8 : 2;

    /** References are kept.
     * @param smoother         for relaxation of the leaf mesh.
     * @param correction       with levels that are @p levels.
     * @param smoothing_steps  on the leaf mesh before and after a correction.
     */
    MultigridNewtonStep(const DiscreteProblem<dim>  &problem,
                        const MonotoneSmoother<dim> &smoother,
                        Levels<dim>                 &levels,
                        TruncatedCorrection<dim>    &correction,
                        const unsigned int           smoothing_steps);

    void update(const NewtonEquations<dim> &equations) override;

    typename NewtonStep<dim>::Outcome
    solve(VectorType        &v,
          const VectorType  &r,
          const double       accuracy,
          const unsigned int maximum_iterations) override;

    /** That of the correction included. */
    std::size_t memory_consumption() const override;

  private:
    const DiscreteProblem<dim> &problem;
    Levels<dim>                &levels;
    TruncatedCorrection<dim>   &correction;
    const unsigned int          smoothing_steps;
    const NewtonEquations<dim> *equations = nullptr;
    LeafRelaxation<dim>         relaxation;
    ContactStrip<dim>           strip;
    VectorType                  defect, smoothed, correction_part;

    // What is left of @p r.
    void find_defect(const VectorType &r, const VectorType &v);

    // A multigrid cycle, with the strip before and after coarse levels.
    void precondition(VectorType &v, const VectorType &r);
  };
} // namespace Friction

#endif

#ifndef friction_iteration_aggregate_correction_h
#define friction_iteration_aggregate_correction_h

#include <common/iteration/truncated_correction.h>
#include <common/levels/aggregate_levels.h>

namespace Friction
{
  /**
   * The cycle of TruncatedCorrection, and after it one over AggregateLevels for
   * what it leaves over: for materials that jump where coarse cells do not see
   * it. Functions on coarse cells serve what is smooth across the whole body,
   * and all processes; functions on groups of strongly coupled nodes serve
   * stiff parts, which move as a whole, and soft ones between them.
   *
   * Each cycle by itself lowers the energy; but on groups several processes
   * solve each for its own nodes at once, which may go too far. What the sum
   * may do to the energy the line search finds out.
   */
  template <int dim>
  class AggregateCorrection : public Correction<dim>
  {
  public:
    /** References are kept. */
    AggregateCorrection(Levels<dim>                &levels,
                        const DiscreteProblem<dim> &problem,
                        const Cycle                 cycle,
                        const unsigned int          smoothing_steps);

    void update(const Linearization<dim> &linearization,
                const Iterate            &x) override;

    void apply(VectorType &v, const VectorType &r) override;

    std::size_t memory_consumption() const override;

  private:
    const DiscreteProblem<dim> &problem;
    TruncatedCorrection<dim>    mesh_levels;
    AggregateLevels<dim>        aggregates;
    VectorType                  defect, second;
  };
} // namespace Friction

#endif

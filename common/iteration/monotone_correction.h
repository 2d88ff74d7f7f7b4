#ifndef friction_iteration_monotone_correction_h
#define friction_iteration_monotone_correction_h

#include <common/iteration/truncated_correction.h>

#include <vector>

namespace Friction
{
  /**
   * The `monotone` coarse correction of the thesis: the cycle of
   * TruncatedCorrection, in which every single relaxation keeps the prolonged
   * correction within bounds that make it admissible and cause no change of
   * phase, (6.12); see Linearization::bounds(). In two dimensions no line
   * search is needed; in three the energy may rise, see MonotoneMultigrid.
   *
   * The bounds of a coarse function are the tightest of the fine nodes in its
   * support; since the weights of the prolongation lie in [0,1] and sum up to
   * one, a correction within them stays within the bounds of the fine nodes
   * (monotone restriction).
   */
  template <int dim>
  class MonotoneCorrection : public TruncatedCorrection<dim>
  {
  public:
    /** @p levels is kept by reference. */
    MonotoneCorrection(Levels<dim>       &levels,
                       const Cycle        cycle,
                       const unsigned int smoothing_steps);

    void update(const Linearization<dim> &linearization,
                const Iterate            &x) override;

    /** Sets the bounds of the correction at the leaf nodes, by component,
     * instead of taking them from a linearisation. Zero must be admissible;
     * infinite bounds are allowed. */
    void set_bounds(const VectorType &lower, const VectorType &upper);

    std::size_t memory_consumption() const override;

  protected:
    void set_up() override;

    void prepare_visits(const unsigned int level) override;

    void relax(const unsigned int level, VectorType *defect_after) override;

    void solve_coarsest() override;

  private:
    using Base = TruncatedCorrection<dim>;
    using Base::correction;
    using Base::defect;
    using Base::levels;
    using Base::rhs;
    using Base::smoothing_steps;

    VectorType leaf_lower, leaf_upper, coarsest_step;

    // Per level: bounds of the correction, and four numbers per component that
    // become bounds.
    std::vector<VectorType>          lower, upper;
    std::vector<std::vector<double>> restricted;

    // What a level needs to know of others to restrict its bounds.
    std::vector<GhostExchange> transfer_ghosts;

    void relax_within_bounds(const unsigned int level, const NodeRanges &nodes);

    bool step_within_bounds();
  };
} // namespace Friction

#endif

#ifndef friction_iteration_coarse_cycle_h
#define friction_iteration_coarse_cycle_h

#include <common/levels/coarsest_solver.h>
#include <common/levels/level_matrices.h>
#include <common/nodes/sweep_schedule.h>
#include <common/parallel/ghost_exchange.h>
#include <common/parameters/solver_settings.h>

#include <memory>
#include <vector>

namespace Friction
{
  /**
   * One multigrid cycle for the truncated linear problem
   * $T(A+\omega'')T\,v = r$: everything below the leaf mesh.
   *
   * Restricted residuals go down, block Gauss-Seidel relaxes each level
   * forwards before and backwards after the coarser levels, so that the V-cycle
   * is a symmetric positive definite operator, and the coarsest level is solved
   * by CoarsestSolver. With local refinement a level sees residuals from two
   * sides: those of its own leaf nodes, and those restricted from the next
   * finer level.
   *
   * With bounds, every single relaxation keeps the prolonged correction within
   * them: this is the `monotone` coarse correction of the thesis. The bounds of
   * a coarse function are the tightest of the fine nodes in its support; since
   * the weights of the prolongation lie in [0,1] and sum up to one, a
   * correction within them stays within the bounds of the fine nodes (monotone
   * restriction).
   *
   * The recursion is our own: that of deal.II's class Multigrid runs W-cycles
   * as V-cycles in the releases up to 9.7, and knows nothing of bounds.
   */
  template <int dim>
  class CoarseCycle
  {
  public:
    /** The arguments given by reference are kept. */
    CoarseCycle(
      const NodeBlockMatrix<dim>  &leaf_matrix,
      const LevelHierarchy<dim>   &hierarchy,
      const NodalConstraints<dim> &constraints,
      const Cycle                  cycle,
      const unsigned int           smoothing_steps,
      const CoarsestMethod         coarsest_method = CoarsestMethod::automatic);

    /** Follows a change of phases. Returns the number of block rows computed.
     */
    std::size_t update(const Truncation<dim> &truncation);

    const LevelMatrices<dim> &
    level_matrices() const
    {
      return matrices;
    }

    /**
     * Computes a correction.
     * @param v  on return the correction at the leaf nodes, truncated. Values
     * of hanging nodes are zero.
     * @param r  truncated residual at the leaf nodes.
     */
    void apply(VectorType &v, const VectorType &r);

    /**
     * The same, with lower <= v <= upper for each component wherever the node
     * is not truncated. Zero must be admissible; infinite bounds are allowed.
     */
    void apply_within_bounds(VectorType       &v,
                             const VectorType &r,
                             const VectorType &lower,
                             const VectorType &upper);

    std::size_t memory_consumption() const;

  private:
    const LevelHierarchy<dim>   &hierarchy;
    const NodalConstraints<dim> &constraints;
    const unsigned int           cycle_parameter;
    const unsigned int           smoothing_steps;

    LevelMatrices<dim>                   matrices;
    std::unique_ptr<CoarsestSolver<dim>> coarsest;
    std::vector<SweepSchedule<dim>>      schedules;

    // Ghosts that rows couple to, and those that transfers need.
    std::vector<GhostExchange> coupled_ghosts, transfer_ghosts;

    // Per level: right hand side, correction, what the next coarser level had
    // when the visit began, and vectors of work; values of owned nodes, then of
    // ghosts. The corrections of a W-cycle accumulate over its visits to a
    // level.
    using LevelVector = std::vector<double>;
    std::vector<LevelVector> rhs, correction, start, defect, work;

    // Per level, only if bounds are in use: bounds of the correction.
    bool                     bounded = false;
    std::vector<LevelVector> lower, upper, restricted_bounds;

    const VectorType *leaf_residual = nullptr;
    const VectorType *leaf_lower    = nullptr;
    const VectorType *leaf_upper    = nullptr;

    void run(VectorType &v, const VectorType &r);

    void visit(const unsigned int level);

    void relax(const unsigned int level,
               const bool         backwards,
               double            *defect_after = nullptr);

    void relax_within_bounds(const unsigned int level,
                             const NodeRanges  &nodes,
                             const bool         backwards);

    void solve_coarsest();

    void restrict_residual(const unsigned int level);

    void restrict_bounds(const unsigned int level);
  };
} // namespace Friction

#endif

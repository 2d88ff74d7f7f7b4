#ifndef friction_nodes_gauss_seidel_h
#define friction_nodes_gauss_seidel_h

#include <common/nodes/sweep_schedule.h>

#include <vector>

namespace Friction
{
  /**
   * Block Gauss-Seidel for A x = b: one node after the other takes the value
   * that solves the equations of its row,
   * @f[ x_p \leftarrow x_p + A_{pp}^{+} (b_p - (A x)_p). @f]
   */
  template <int dim>
  class GaussSeidel
  {
  public:
    /**
     * @param A                   symmetric, see NodePattern::complete().
     * @param inverse_diagonals   one block per row, the (pseudo-)inverse of its
     *                            diagonal block; a zero block leaves its node
     *                            alone. Kept by reference, as is @p A.
     * @param nodes               those to be relaxed.
     * @param chunk_size          see SweepSchedule.
     */
    GaussSeidel(const NodeBlockMatrix<dim>        &A,
                const std::vector<NodeBlock<dim>> &inverse_diagonals,
                const NodeRanges                  &nodes,
                const unsigned int chunk_size = nodes_per_chunk);

    /**
     * Several sweeps in the order of the rows, and then, if @p residual is not
     * null, the residual b - A x of all rows.
     * @param b       one value per component of each owned node.
     * @param x       the same and the ghosts, which must be valid, and are on
     *                return.
     * @param ghosts  exchanges them.
     */
    void run(const unsigned int n_sweeps,
             const double      *b,
             double            *x,
             GhostExchange     &ghosts,
             double            *residual = nullptr) const;

    /** A stage of such sweeps over one chunk of schedule(). The rows of @p loop
     * are set here, and its prefetch makes one step for each node.
     * @param do_others  called with each range of rows of the chunk that are
     * not relaxed, in place of RowKernels::pass(). */
    template <typename DoOthers>
    void relax_chunk(const Stage         &stage,
                     RowKernels::RowLoop &loop,
                     const double        *b,
                     double              *x,
                     const DoOthers      &do_others) const;

    /** What a stage does with the sums of the left of the diagonal. */
    RowKernels::LeftSums
    left_sums(const Stage &stage) const
    {
      return {A->partial_sums(), stage.clears, stage.adds};
    }

    const SweepSchedule<dim> &
    schedule() const
    {
      return sweep_schedule;
    }

  private:
    const NodeBlockMatrix<dim>        *A;
    const std::vector<NodeBlock<dim>> *inverse_diagonals;
    SweepSchedule<dim>                 sweep_schedule;
  };



  template <int dim>
  template <typename DoOthers>
  void
  GaussSeidel<dim>::relax_chunk(const Stage         &stage,
                                RowKernels::RowLoop &loop,
                                const double        *b,
                                double              *x,
                                const DoOthers      &do_others) const
  {
    const BlockRows<dim>  rows    = A->rows();
    const NodeBlock<dim> *inverse = inverse_diagonals->data();
    for (const auto &part : sweep_schedule.parts(stage.chunk))
      {
        loop.rows = part.rows;
        if (part.is_relaxed)
          RowKernels::relax<dim>(rows, inverse, loop, b, x);
        else
          do_others(loop);
      }
  }
} // namespace Friction

#endif

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
     * @param A                   whose pattern must be symmetric.
     * @param inverse_diagonals   one block per row, the (pseudo-)inverse of its
     *                            diagonal block; a zero block leaves its node
     *                            alone. Kept by reference, as is @p A.
     * @param nodes               those to be relaxed.
     * @param chunk_size          see SweepSchedule.
     */
    GaussSeidel(const NodeBlockMatrix<dim>        &A,
                const std::vector<NodeBlock<dim>> &inverse_diagonals,
                const NodeRanges                  &nodes,
                const unsigned int                 chunk_size = 128);

    /**
     * Several sweeps, and then, if @p residual is not null, the residual
     * b - A x of all rows.
     * @param b       one value per component of each owned node.
     * @param x       the same and the ghosts, which must be valid, and are on
     *                return.
     * @param ghosts  exchanges them.
     */
    void run(const Sweeps  &sweeps,
             const double  *b,
             double        *x,
             GhostExchange &ghosts,
             double        *residual = nullptr) const;

    /** One sweep over the nodes of one chunk of schedule(), for a caller that
     * relaxes other nodes in between. @p fetch makes one step for each node. */
    void relax_chunk(const unsigned int chunk,
                     const double      *b,
                     double            *x,
                     const bool         backwards,
                     Prefetch          &fetch) const;

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
} // namespace Friction

#endif

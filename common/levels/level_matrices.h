#ifndef friction_levels_level_matrices_h
#define friction_levels_level_matrices_h

#include <common/levels/level_hierarchy.h>
#include <common/nodes/node_block_matrix.h>
#include <common/nodes/truncation.h>

#include <map>
#include <vector>

namespace Friction
{
  /**
   * The exact Galerkin matrices of the truncated functions of all levels.
   * @f[ B_k = M_k^T\, T (A + \omega'') T\, M_k, @f]
   * where $M_k$ prolongs from level $k$ to the leaf mesh. They are built
   * without that global product, from the blocks of the leaf matrix: the block
   * that couples leaf nodes $i,j$ belongs to level $\min(\ell(i),\ell(j))$, the
   * finest one that has both, and from there upwards
   * @f[ B_k = \text{own blocks} + P_{k+1}^T B_{k+1} P_{k+1}. @f]
   * Truncation enters the own blocks only, never $P$: a node that several
   * levels share keeps its untruncated coefficient on all of them.
   *
   * This is the cell-wise sum $\sum_K (TC_K)^T A_K (TC_K)$ over the active
   * cells $K$ of a level, with their stiffness matrices $A_K$ and $C_K$ the
   * constraints that express the values at their vertices, some of which may
   * hang, by those of the level's nodes. It is read off the assembled leaf
   * matrix, so that no cell matrix has to be kept. Rows of hanging nodes stay
   * zero.
   *
   * When the truncation changes at some contact nodes, only rows that depend on
   * them are computed anew, by the same code and hence to the same values as a
   * fresh assembly: O(contact nodes) work, as in section 4.5 of the thesis.
   *
   * With several processes each has the rows of the nodes that it owns. What it
   * contributes to rows of others, because their children or leaf nodes are
   * its own, it sends to their owners, in a fresh assembly and in an update.
   *
   * Level matrices exist for the correction levels 0,...,n_levels-2; if there
   * is but one level, for that one, which is then the leaf mesh itself.
   */
  template <int dim>
  class LevelMatrices
  {
  public:
    /** Assembles for the truncation that only prescribed components cause. The
     * arguments are kept by reference. Collective. */
    LevelMatrices(const NodeBlockMatrix<dim>  &leaf_matrix,
                  const LevelHierarchy<dim>   &hierarchy,
                  const NodalConstraints<dim> &constraints);

    LevelMatrices(const LevelMatrices &) = delete;

    /** Brings all levels up to date with @p truncation, which must be right at
     * ghost nodes, too. Returns the number of block rows that this process had
     * to compute. Collective. */
    std::size_t update(const Truncation<dim> &truncation);

    /** The truncation that the matrices are up to date with. */
    const Truncation<dim> &
    current_truncation() const
    {
      return truncation;
    }

    unsigned int
    n_levels() const
    {
      return matrices.size();
    }

    const NodeBlockMatrix<dim> &
    matrix(const unsigned int level) const
    {
      return matrices[level];
    }

    /** Pseudo-inverses of the diagonal blocks, with what relaxation needs at
     * interfaces to other processes, see interface_damping(); prescribed
     * components and directions in which a function has vanished are zero. */
    const std::vector<NodeBlock<dim>> &
    inverse_diagonals(const unsigned int level) const
    {
      return inverses[level];
    }

    /** The diagonal block of an owned row with the whole interface_majorant(),
     * for problems that are not solved exactly. */
    NodeBlock<dim> majorized_diagonal(const unsigned int level,
                                      const unsigned int row) const;

    /** At the nodes of the coarsest level: the projector onto the directions
     * in which nothing can or may move. */
    const std::vector<NodeBlock<dim>> &
    coarsest_null_spaces() const
    {
      return null_spaces;
    }

    /** Counts changes of the coarsest matrix, so that its factorisation can be
     * kept as long as possible. */
    unsigned int
    coarsest_version() const
    {
      return version;
    }

    std::size_t memory_consumption() const;

  private:
    const NodeBlockMatrix<dim>  &leaf_matrix;
    const LevelHierarchy<dim>   &hierarchy;
    const NodalConstraints<dim> &constraints;

    Truncation<dim>                          truncation;
    std::vector<NodeBlockMatrix<dim>>        matrices;
    std::vector<std::vector<NodeBlock<dim>>> inverses;
    std::vector<std::vector<double>>         untruncated_traces;
    std::vector<NodeBlock<dim>>              null_spaces;
    unsigned int                             version = 0;

    // Per level: parts of rows that others own, parts that others have computed
    // of ours, and where in our rows they go.
    struct IncomingPart
    {
      std::vector<std::size_t> positions;
      std::vector<double>      values;
    };
    std::vector<NodeBlockMatrix<dim>>                              outgoing;
    std::vector<std::map<unsigned int, std::vector<IncomingPart>>> incoming;
    std::vector<std::vector<std::vector<const IncomingPart *>>>    parts_of_row;
    std::vector<std::vector<unsigned int>> outgoing_row_of;

    // Which leaf rows couple to a ghost of the leaf mesh.
    std::vector<std::vector<unsigned int>> leaf_rows_of_ghost;

    std::vector<std::vector<unsigned int>> position_of_column;

    // Of the row that is being computed: its sums by columns of the finer
    // level.
    std::vector<unsigned int>   slot_of_finer_column, finer_columns;
    std::vector<NodeBlock<dim>> finer_sums;

    void prepare_exchange(const unsigned int level);

    // A row of this process, or its part of a row of another process.
    void compute_row(const unsigned int level, const unsigned int row);

    // Sends parts of rows of others, and receives parts of ours; returns which
    // of ours.
    std::vector<unsigned int>
    exchange_parts(const unsigned int               level,
                   const std::vector<unsigned int> &changed_rows);

    void compute_inverse(const unsigned int level, const unsigned int row);

    NodeBlock<dim> free_diagonal(const unsigned int    level,
                                 const unsigned int    row,
                                 const NodeBlock<dim> &addition) const;
  };
} // namespace Friction

#endif

#ifndef friction_multigrid_level_matrices_h
#define friction_multigrid_level_matrices_h

#include <common/multigrid/level_hierarchy.h>
#include <common/multigrid/node_block_matrix.h>
#include <common/multigrid/truncation.h>

#include <vector>

namespace Friction
{
  /**
   * The exact Galerkin matrices of the truncated functions of all levels,
   * @f[ B_k = M_k^T\, T (A + \omega'') T\, M_k, @f]
   * where $M_k$ prolongs from level $k$ to the leaf mesh. They are built
   * without that global product, from the blocks of the leaf matrix: the block
   * that couples leaf nodes $i,j$ belongs to level $\min(f(i),f(j))$, the
   * finest one that has both, and from there upwards
   * @f[ B_k = \text{own blocks} + P_{k+1}^T B_{k+1} P_{k+1}. @f]
   * Truncation enters the own blocks only, never $P$: a node that several
   * levels share keeps its untruncated coefficient on all of them.
   *
   * This is the cell-wise sum $\sum_K (TC_K)^T A_K (TC_K)$ over the active
   * cells of a level, read off the assembled leaf matrix so that no cell matrix
   * has to be kept. Rows of hanging nodes stay zero.
   *
   * When the truncation changes at some contact nodes, only rows that depend on
   * them are computed anew, by the same code and hence to the same values as a
   * fresh assembly: O(contact nodes) work, as in section 4.5 of the thesis.
   *
   * Level matrices exist for the correction levels 0,...,n_levels-2; if there
   * is but one level, for that one, which is then the leaf mesh itself.
   */
  template <int dim>
  class LevelMatrices
  {
  public:
    /** Assembles for the truncation that only prescribed components cause. The
     * arguments are kept by reference. */
    LevelMatrices(const NodeBlockMatrix<dim>  &leaf_matrix,
                  const LevelHierarchy<dim>   &hierarchy,
                  const NodalConstraints<dim> &constraints);

    /** Brings all levels up to date with @p truncation. Returns the number of
     * block rows that had to be computed. */
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

    /** Pseudo-inverses of the diagonal blocks; prescribed components and
     * directions in which a function has vanished are zero. */
    const std::vector<NodeBlock<dim>> &
    inverse_diagonals(const unsigned int level) const
    {
      return inverses[level];
    }

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

    std::vector<std::vector<unsigned int>> position_of_column;

    // Of the row that is being computed: its sums by columns of the finer
    // level.
    std::vector<unsigned int>   slot_of_finer_column, finer_columns;
    std::vector<NodeBlock<dim>> finer_sums;

    void make_pattern(const unsigned int level);

    void compute_row(const unsigned int level, const unsigned int row);

    void compute_inverse(const unsigned int level, const unsigned int row);

    const NodeWeights &finer_parents(const unsigned int level) const;

    // Calls own_block(column, i, j, position) for the blocks (i,j) of the leaf
    // matrix that belong to a row of this level, and finer_block(weight,
    // column, block) for those that come from the next finer level.
    template <typename OwnBlock, typename FinerBlock>
    void for_each_contribution(const unsigned int level,
                               const unsigned int row,
                               const OwnBlock    &own_block,
                               const FinerBlock  &finer_block) const;
  };
} // namespace Friction

#endif

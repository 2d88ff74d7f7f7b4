#ifndef friction_nodes_node_block_matrix_h
#define friction_nodes_node_block_matrix_h

#include <common/nodes/huge_pages.h>
#include <common/nodes/node_block.h>
#include <common/nodes/row_kernels.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace Friction
{
  /**
   * Which blocks a matrix has, in compressed row storage. The columns of row i
   * are in the order i, i+1, ..., and from the last one on to 0, 1, ..., i-1:
   * the diagonal comes first, then what is to its right, columns of other
   * processes included, whose numbers are larger than those of all rows.
   *
   * A symmetric matrix is stored by halves: what is to the left of the diagonal
   * is stored as a block of another row only. A row still knows all of its
   * columns, and where the blocks of the left ones are.
   */
  struct NodePattern
  {
    std::vector<std::size_t>  starts = {0}; ///< n_rows + 1 of them
    std::vector<unsigned int> columns;

    /// If only half of the blocks are stored: how many are in the rows before
    /// each one, and in all; otherwise empty.
    std::vector<std::size_t> stored_starts;

    /// For each block that is not stored, row after row: the number of the
    /// stored one that is its transpose.
    std::vector<unsigned int> mirror_images;

    unsigned int
    n_rows() const
    {
      return starts.size() - 1;
    }

    /** Whether column @p a comes before column @p b in a row. An unsigned
     * difference to the diagonal is small to its right, and huge to its left.
     */
    static bool
    is_before(const unsigned int row,
              const unsigned int a,
              const unsigned int b)
    {
      return a - row < b - row;
    }

    /** Takes @p row_columns, which it sorts, as the columns of the next row. */
    void append_row(std::vector<unsigned int> &row_columns);

    /** To be called when all rows are there, for a symmetric matrix: stores
     * half of it, where that is faster, see stores_half. Among the rows the
     * pattern itself has to be symmetric, and each row that has a block has a
     * diagonal one. */
    template <int dim>
    void
    complete()
    {
      columns.shrink_to_fit();
      if (stores_half<dim>)
        store_half();
    }

    std::size_t
    memory_consumption() const
    {
      return (starts.capacity() + stored_starts.capacity()) *
        sizeof(std::size_t) +
        (columns.capacity() + mirror_images.capacity()) * sizeof(unsigned int);
    }

  private:
    void store_half();
  };



  /**
   * A sparse matrix of dense dim x dim blocks, one row of blocks per node.
   *
   * Everything the method does is nodewise: relaxation solves a dim x dim
   * problem at each node, truncation acts on the blocks of a node. Storing one
   * column index per block instead of one per entry also makes a relaxation
   * sweep read a third less memory, and memory is what a sweep waits for. So
   * does, once more by nearly half, storing a symmetric matrix by halves, see
   * NodePattern. What works with whole matrices, products and sweeps, needs
   * that; a row by itself can be read in any case.
   *
   * Rows are the locally owned nodes; columns count owned nodes first and ghost
   * nodes after them, as the local elements of
   * LinearAlgebra::distributed::Vector do, so that a vector enters as a plain
   * pointer to its local values, node by node. The first entry of each row is
   * the diagonal block, for the order of the others see NodePattern.
   */
  template <int dim>
  class NodeBlockMatrix
  {
  public:
    NodeBlockMatrix() = default;

    /** A zero matrix with given pattern, which several matrices may share. */
    explicit NodeBlockMatrix(std::shared_ptr<const NodePattern> pattern);

    unsigned int
    n_rows() const
    {
      return pattern == nullptr ? 0 : pattern->n_rows();
    }

    std::size_t
    n_blocks() const
    {
      return pattern == nullptr ? 0 : pattern->columns.size();
    }

    /** How many of them are stored. */
    std::size_t
    n_stored_blocks() const
    {
      return pattern == nullptr ? 0 : stored_starts[n_rows()];
    }

    /** Which blocks there are. */
    const NodePattern &
    sparsity() const
    {
      return *pattern;
    }

    /** The position of the first block of a row, which is the diagonal one. */
    std::size_t
    row_begin(const unsigned int row) const
    {
      return row_starts[row];
    }

    std::size_t
    row_end(const unsigned int row) const
    {
      return row_starts[row + 1];
    }

    /** The end of the blocks that are stored with a row, by which the others
     * begin. */
    std::size_t
    stored_end(const unsigned int row) const
    {
      return row_starts[row] + stored_starts[row + 1] - stored_starts[row];
    }

    unsigned int
    column(const std::size_t position) const
    {
      return columns[position];
    }

    /** The dim*dim values, row by row, of the block of a row at a position
     * before stored_end(). */
    double *
    block(const unsigned int row, const std::size_t position)
    {
      Assert(position < stored_end(row), dealii::ExcInternalError());
      return values.data() +
        (stored_starts[row] + position - row_starts[row]) * (dim * dim);
    }

    const double *
    block(const unsigned int row, const std::size_t position) const
    {
      Assert(position < stored_end(row), dealii::ExcInternalError());
      return values.data() +
        (stored_starts[row] + position - row_starts[row]) * (dim * dim);
    }

    /** The block of a row at any of its positions, like all blocks by
     * themselves column by column. */
    NodeBlock<dim>
    value(const unsigned int row, const std::size_t position) const
    {
      NodeBlock<dim>    result;
      const std::size_t end = stored_end(row);
      if (position >= end)
        std::copy_n(
          mirror_image(row, position - end), dim * dim, result.begin());
      else
        {
          const double *stored = block(row, position);
          for (int c = 0; c < dim; ++c)
            for (int r = 0; r < dim; ++r)
              result[c * dim + r] = stored[r * dim + c];
        }
      return result;
    }

    /** Sets a block at a position before stored_end(), given column by column.
     */
    void
    set(const unsigned int    row,
        const std::size_t     position,
        const NodeBlock<dim> &value)
    {
      double *stored = block(row, position);
      for (int r = 0; r < dim; ++r)
        for (int c = 0; c < dim; ++c)
          stored[r * dim + c] = value[c * dim + r];
    }

    /** Calls @p f with column and block, dim*dim values row by row, of each
     * block of a row. */
    template <typename Function>
    void
    for_each_block(const unsigned int row, const Function &f) const
    {
      std::size_t       e   = row_begin(row);
      const std::size_t end = row_end(row), stored = stored_end(row);
      for (; e < stored; ++e)
        f(columns[e], block(row, e));
      double transposed[dim * dim];
      for (; e < end; ++e)
        {
          const double *image = mirror_image(row, e - stored);
          for (int r = 0; r < dim; ++r)
            for (int c = 0; c < dim; ++c)
              transposed[r * dim + c] = image[c * dim + r];
          f(columns[e], static_cast<const double *>(transposed));
        }
    }

    /** The trace of that. */
    double
    trace_of(const unsigned int row, const std::size_t position) const
    {
      const std::size_t end = stored_end(row);
      return trace<dim>(position < end ? block(row, position)
                                       : mirror_image(row, position - end));
    }

    /** The diagonal block of a row that is not empty. If the matrix is
     * symmetric, rows and columns are the same. */
    double *
    diagonal(const unsigned int row)
    {
      return block(row, row_starts[row]);
    }

    const double *
    diagonal(const unsigned int row) const
    {
      return block(row, row_starts[row]);
    }

    bool
    is_empty(const unsigned int row) const
    {
      return row_starts[row] == row_starts[row + 1];
    }

    /** The position of block (row,column), or row_end(row) if there is none. */
    std::size_t find(const unsigned int row, const unsigned int column) const;

    /** The value of row @p row of the product A x. What is stored elsewhere is
     * looked for there. */
    NodeValue<dim> row_times(const unsigned int row, const double *x) const;

    /** For RowKernels. */
    BlockRows<dim>
    rows() const
    {
      return {row_starts, stored_starts, columns, values.data(), n_rows()};
    }

    /** Room for what RowKernels add up on the left of the diagonal; all zero,
     * as each loop over all rows has to leave it. */
    double *partial_sums() const;

    /** Has the memory of rows brought closer, for use in the near future, in
     * @p n_steps steps. */
    Prefetch
    prefetch(const RowRange &rows, const unsigned int n_steps) const
    {
      return rows.first == rows.second
        ? Prefetch()
        : Prefetch(address(rows.first), address(rows.second), n_steps);
    }

    /** Whether all values are those of another matrix with this pattern. */
    bool
    has_values_of(const NodeBlockMatrix &other) const
    {
      return values == other.values;
    }

    /** y = A x. */
    void vmult(double *y, const double *x) const;

    /** The share of this process in $x^TAx$, if A is symmetric: with half of
     * its blocks, and without a vector for $Ax$. */
    double
    energy_product(const double *x) const
    {
      return RowKernels::energy<dim>(rows(), x);
    }

    /** r = b - A x, or A x, as vmult() has it, if @p b is a null pointer. */
    void residual(double *r, const double *b, const double *x) const;

    /** Memory in bytes. */
    std::size_t memory_consumption() const;

  private:
    std::shared_ptr<const NodePattern> pattern;
    const std::size_t                 *row_starts    = nullptr;
    const std::size_t                 *stored_starts = nullptr;
    const unsigned int                *columns       = nullptr;

    // And one number behind the last block, which kernels read.
    HugePageVector<double> values;

    // Only a place to work, which is made by the first kernel that needs it.
    mutable HugePageVector<double> sums;

    // The transpose of a block that is stored elsewhere, counted from
    // stored_end() on.
    const double *
    mirror_image(const unsigned int row, const std::size_t number) const
    {
      return values.data() +
        std::size_t(pattern->mirror_images[row_starts[row] -
                                           stored_starts[row] + number]) *
        (dim * dim);
    }

    // Of the first block of a row, or the end of the last one.
    const char *
    address(const unsigned int row) const
    {
      return reinterpret_cast<const char *>(values.data() +
                                            stored_starts[row] * (dim * dim));
    }
  };



  /**
   * Nodes to be relaxed, as ranges [first,second) of consecutive numbers: the
   * sweep then needs no test per node.
   */
  using NodeRanges = std::vector<RowRange>;

  /** Appends a node with a number larger than all before. */
  inline void
  append(NodeRanges &ranges, const unsigned int node)
  {
    if (!ranges.empty() && ranges.back().second == node)
      ++ranges.back().second;
    else
      ranges.emplace_back(node, node + 1);
  }
} // namespace Friction

#endif

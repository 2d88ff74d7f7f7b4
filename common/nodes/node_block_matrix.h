#ifndef friction_nodes_node_block_matrix_h
#define friction_nodes_node_block_matrix_h

#include <common/nodes/huge_pages.h>
#include <common/nodes/node_block.h>
#include <common/nodes/row_kernels.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace Friction
{
  /**
   * Which blocks a matrix has, in compressed row storage. The columns of row i
   * are in the order i, i+1, ..., and from the last one on to 0, 1, ..., i-1:
   * the diagonal comes first. A loop over the rows in ascending order, each
   * from front to back, meets last the columns of those rows that it has just
   * been to; in descending order, each from back to front, as well (but for the
   * diagonal).
   */
  struct NodePattern
  {
    std::vector<std::size_t>  starts = {0}; ///< n_rows + 1 of them
    std::vector<unsigned int> columns;

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

    std::size_t
    memory_consumption() const
    {
      return starts.capacity() * sizeof(std::size_t) +
        columns.capacity() * sizeof(unsigned int);
    }
  };



  /**
   * A sparse matrix of dense dim x dim blocks, one row of blocks per node.
   *
   * Everything the method does is nodewise: relaxation solves a dim x dim
   * problem at each node, truncation acts on the blocks of a node. Storing one
   * column index per block instead of one per entry also makes a relaxation
   * sweep read a third less memory, and memory is what a sweep waits for.
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

    unsigned int
    column(const std::size_t position) const
    {
      return columns[position];
    }

    /** The dim*dim values of the block at a position, column by column. */
    double *
    block(const std::size_t position)
    {
      return values.data() + position * (dim * dim);
    }

    const double *
    block(const std::size_t position) const
    {
      return values.data() + position * (dim * dim);
    }

    /** The position of block (row,column), or row_end(row) if there is none. */
    std::size_t find(const unsigned int row, const unsigned int column) const;

    /** The value of row @p row of the product A x; about @p backwards see
     * RowKernels::times(). */
    NodeValue<dim>
    row_times(const unsigned int row,
              const double      *x,
              const bool         backwards = false) const
    {
      return RowKernels::times<dim>(rows(), row, x, backwards);
    }

    /** For RowKernels. */
    BlockRows<dim>
    rows() const
    {
      return {row_starts, columns, values.data()};
    }

    /** Has the memory of a row brought closer, for use in the near future. */
    void
    prefetch(const unsigned int row) const
    {
      const char *begin =
        reinterpret_cast<const char *>(block(row_starts[row]));
      const char *end =
        reinterpret_cast<const char *>(block(row_starts[row + 1]));
      for (; begin < end; begin += 64)
        __builtin_prefetch(begin);
      __builtin_prefetch(columns + row_starts[row]);
    }

    /** The same for many rows, in @p n_steps steps. */
    Prefetch
    prefetch(const RowRange &rows, const unsigned int n_steps) const
    {
      return rows.first == rows.second
        ? Prefetch()
        : Prefetch(block(row_starts[rows.first]),
                   block(row_starts[rows.second]),
                   n_steps);
    }

    /** y = A x. */
    void vmult(double *y, const double *x) const;

    /** The share of this process in $x^TAx$, if A is symmetric: half the
     * work of vmult() and a scalar product. */
    double
    energy_product(const double *x) const
    {
      return RowKernels::energy<dim>(rows(), n_rows(), x);
    }

    /** r = b - A x. */
    void residual(double *r, const double *b, const double *x) const;

    /** The same for some rows only, and meanwhile has the rows @p ahead brought
     * into the cache. */
    void residual(double         *r,
                  const double   *b,
                  const double   *x,
                  const RowRange &rows,
                  const RowRange &ahead = {}) const;

    /** Memory in bytes. */
    std::size_t memory_consumption() const;

  private:
    std::shared_ptr<const NodePattern> pattern;
    const std::size_t                 *row_starts = nullptr;
    const unsigned int                *columns    = nullptr;
    HugePageVector<double>             values;
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

#ifndef friction_nodes_row_kernels_h
#define friction_nodes_row_kernels_h

#include <common/nodes/node_block.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace Friction
{
  /** Rows first, ..., second-1 of a matrix. */
  using RowRange = std::pair<unsigned int, unsigned int>;

  /** The rows of a NodeBlockMatrix, as its innermost loops see them: blocks are
   * stored row by row, and there is one number more behind the last. */
  template <int dim>
  struct BlockRows
  {
    const std::size_t  *starts;
    const std::size_t  *stored_starts;
    const unsigned int *columns;
    const double       *blocks;
    unsigned int        n_rows;
  };



  /**
   * Has memory brought into the cache before it is read, a little with each
   * step of a loop that does something else meanwhile. All at once would be
   * more than a processor can wait for at a time.
   */
  class Prefetch
  {
  public:
    Prefetch() = default;

    /** The memory from @p begin to @p end, in @p n_steps steps. */
    Prefetch(const void *begin, const void *end, const unsigned int n_steps)
      : next(static_cast<const char *>(begin))
      , end(static_cast<const char *>(end))
      , bytes_per_step(
          ((this->end - next) / (line * std::max(1u, n_steps)) + 1) * line)
    {}

    void
    step()
    {
      const char *stop = next + std::min(bytes_per_step, end - next);
      for (; next < stop; next += line)
        __builtin_prefetch(next, /*for writing*/ 0, /*not into the first*/ 2);
      next = stop;
    }

  private:
    static constexpr std::ptrdiff_t line = 64;

    const char    *next = nullptr, *end = nullptr;
    std::ptrdiff_t bytes_per_step = 0;
  };



  /**
   * Of a symmetric matrix one half will do: each row has its diagonal and what
   * is to the right of it. The rest is added up in passing. When a loop in
   * ascending order has come to a row, with or without changing the value of
   * its node, it adds its blocks, transposed, times that value to sums that
   * belong to the rows with larger numbers. When it gets there, it finds
   * complete what is to the left of the diagonal: with the new values of a
   * sweep, as Gauss-Seidel wants them. So each block is read once and used
   * twice. In descending order the old values would be wanted there, and a
   * product before the first sweep; sweeps here are in ascending order.
   *
   * In three dimensions a sweep waits for memory, and this makes it twice as
   * fast. In two, blocks are as small as the sums that they are added to: what
   * is saved in reading is spent on these, and sweeps are no faster in large
   * matrices and by a third slower in small ones. There, all blocks are stored.
   */
  template <int dim>
  constexpr bool stores_half = (dim == 3);



  /** The loops that a solution spends its time in, compiled for several sets of
   * Instructions. */
  namespace RowKernels
  {
    /** Numbers per row in the sums of the left, where there are such; the
     * fourth one means nothing. */
    constexpr unsigned int n_partial_sums = 4;

    /** What a loop does with the sums of the left of the diagonal, where half
     * of a matrix is stored. */
    struct LeftSums
    {
      double *sums;

      /// Those of a row, once they have been used, are set to zero.
      bool clear;

      /// The share of each row is added to those of others.
      bool add;
    };

    /** The rows that a kernel goes through, in ascending order, what it has
     * brought into the cache meanwhile, and what becomes of sums. */
    struct RowLoop
    {
      RowRange  rows;
      Prefetch &prefetch;
      LeftSums  left;
    };

    /** What is stored of row @p row of A, times x. */
    template <int dim>
    NodeValue<dim>
    times(const BlockRows<dim> &A, const unsigned int row, const double *x);

    /** Row @p row of A x, with the sums of its left, which are cleared if they
     * are to be. */
    template <int dim>
    NodeValue<dim> times(const BlockRows<dim> &A,
                         const unsigned int    row,
                         const double         *x,
                         const LeftSums       &left);

    /** Adds the share of rows in the sums of others, if it is to be, and
     * clears their own, if these are to be: what is to be done with rows whose
     * values do not change. */
    template <int dim>
    void pass(const BlockRows<dim> &A, const RowLoop &loop, const double *x);

    /** Adds the share of one row in the sums of others, if it is to be. */
    template <int dim>
    void add_share(const BlockRows<dim> &A,
                   const unsigned int    row,
                   const double         *x,
                   const LeftSums       &left);

    /** r = b - A x for some rows; A x, if @p b is a null pointer. */
    template <int dim>
    void residual(const BlockRows<dim> &A,
                  const RowLoop        &loop,
                  double               *r,
                  const double         *b,
                  const double         *x);

    /**
     * What the rows of a symmetric matrix have in $x^TAx$: their diagonal
     * blocks once, their couplings to rows with larger numbers twice, and those
     * to columns beyond the rows, which belong to other processes, once. Over
     * all processes this is the whole product.
     */
    template <int dim>
    double energy(const BlockRows<dim> &A, const double *x);

    /**
     * Gauss-Seidel for some rows: solves the equations of each row for the
     * values of its node.
     * @param inverses  of the diagonal blocks, for all rows of the matrix.
     */
    template <int dim>
    void relax(const BlockRows<dim> &A,
               const NodeBlock<dim> *inverses,
               const RowLoop        &loop,
               const double         *b,
               double               *x);
  } // namespace RowKernels
} // namespace Friction

#endif

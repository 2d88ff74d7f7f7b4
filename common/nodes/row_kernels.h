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

  /** The rows of a NodeBlockMatrix, as its innermost loops see them. */
  template <int dim>
  struct BlockRows
  {
    const std::size_t  *starts;
    const unsigned int *columns;
    const double       *blocks;
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



  /** The loops that a solution spends its time in, compiled for several
   * sets of Instructions. */
  namespace RowKernels
  {
    /** The rows that a kernel goes through, in which direction, and what it has
     * brought into the cache meanwhile. */
    struct RowLoop
    {
      RowRange  rows;
      bool      backwards;
      Prefetch &prefetch;
    };

    /**
     * The value of row @p row of the product A x.
     * @param backwards  whether the caller takes rows in descending order and
     *                   changes the value of each: the sum then ends with
     *                   the values that were changed last, so that the
     *                   processor can begin with it before it has them. The
     *                   two sums differ in rounding only.
     */
    template <int dim>
    NodeValue<dim> times(const BlockRows<dim> &A,
                         const unsigned int    row,
                         const double         *x,
                         const bool            backwards = false);

    /** r = b - A x for some rows, forwards in any case. */
    template <int dim>
    void residual(const BlockRows<dim> &A,
                  const RowLoop        &loop,
                  double               *r,
                  const double         *b,
                  const double         *x);

    /**
     * What the first @p n_rows rows of a symmetric matrix have in $x^TAx$:
     * their diagonal blocks once, their couplings to rows with larger numbers
     * twice, and those to columns from @p n_rows on, the rows of other
     * processes, once. Over all processes this is the whole product, and only
     * half of the matrix has been read.
     */
    template <int dim>
    double
    energy(const BlockRows<dim> &A, const unsigned int n_rows, const double *x);

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

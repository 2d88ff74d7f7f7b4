#include <common/nodes/node_block_matrix.h>

#include <algorithm>
#include <utility>

namespace Friction
{
  void
  NodePattern::append_row(std::vector<unsigned int> &row_columns)
  {
    const unsigned int row = n_rows();
    std::sort(row_columns.begin(),
              row_columns.end(),
              [row](const unsigned int a, const unsigned int b) {
                return is_before(row, a, b);
              });
    columns.insert(columns.end(), row_columns.begin(), row_columns.end());
    starts.push_back(columns.size());
  }



  template <int dim>
  NodeBlockMatrix<dim>::NodeBlockMatrix(
    std::shared_ptr<const NodePattern> pattern)
    : pattern(std::move(pattern))
    , row_starts(this->pattern->starts.data())
    , columns(this->pattern->columns.data())
    , values(this->pattern->columns.size() * (dim * dim), 0.)
  {}



  template <int dim>
  std::size_t
  NodeBlockMatrix<dim>::find(const unsigned int row,
                             const unsigned int column) const
  {
    const std::size_t begin = row_starts[row], end = row_starts[row + 1];
    const auto        last = columns + end;
    const auto        it =
      std::lower_bound(columns + begin,
                       last,
                       column,
                       [row](const unsigned int a, const unsigned int b) {
                         return NodePattern::is_before(row, a, b);
                       });
    return (it != last && *it == column) ? it - columns : end;
  }



  template <int dim>
  void
  NodeBlockMatrix<dim>::vmult(double *y, const double *x) const
  {
    for (unsigned int i = 0; i < n_rows(); ++i)
      {
        const NodeValue<dim> value = row_times(i, x);
        for (int d = 0; d < dim; ++d)
          y[dim * i + d] = value[d];
      }
  }



  template <int dim>
  void
  NodeBlockMatrix<dim>::residual(double       *r,
                                 const double *b,
                                 const double *x) const
  {
    residual(r, b, x, {0, n_rows()});
  }



  template <int dim>
  void
  NodeBlockMatrix<dim>::residual(double         *r,
                                 const double   *b,
                                 const double   *x,
                                 const RowRange &rows,
                                 const RowRange &ahead) const
  {
    Prefetch fetch = prefetch(ahead, rows.second - rows.first);
    RowKernels::residual<dim>(this->rows(), {rows, false, fetch}, r, b, x);
  }



  template <int dim>
  std::size_t
  NodeBlockMatrix<dim>::memory_consumption() const
  {
    return (pattern == nullptr ? 0 : pattern->memory_consumption()) +
      values.capacity() * sizeof(double);
  }



  template class NodeBlockMatrix<2>;
  template class NodeBlockMatrix<3>;
} // namespace Friction

#include <common/nodes/node_block_matrix.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace Friction
{
  using namespace dealii;

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



  void
  NodePattern::store_half()
  {
    Assert(stored_starts.empty(), ExcMessage("Call complete() once."));
    stored_starts.reserve(starts.size());
    stored_starts.push_back(0);
    // The next of the blocks on the left in each row that is to be found.
    std::vector<std::size_t> next(n_rows());
    std::size_t              n_left = 0;
    for (unsigned int i = 0; i < n_rows(); ++i)
      {
        const auto left = std::partition_point(
          columns.begin() + starts[i],
          columns.begin() + starts[i + 1],
          [i](const unsigned int column) { return column >= i; });
        const std::size_t end = left - columns.begin();
        stored_starts.push_back(stored_starts.back() + end - starts[i]);
        next[i] = n_left;
        n_left += starts[i + 1] - end;
      }
    Assert(stored_starts.back() <= std::numeric_limits<unsigned int>::max(),
           ExcMessage("A process has room for four thousand million blocks."));

    mirror_images.resize(n_left);
    const std::vector<std::size_t> first = next;
    for (unsigned int i = 0; i < n_rows(); ++i)
      for (std::size_t k = 1; k < stored_starts[i + 1] - stored_starts[i]; ++k)
        if (const unsigned int j = columns[starts[i] + k]; j < n_rows())
          {
            AssertThrow(next[j] < (j + 1 < n_rows() ? first[j + 1] : n_left) &&
                          columns[starts[j] + stored_starts[j + 1] -
                                  stored_starts[j] + next[j] - first[j]] == i,
                        ExcMessage("The pattern is not symmetric."));
            mirror_images[next[j]++] = stored_starts[i] + k;
          }
  }



  template <int dim>
  NodeBlockMatrix<dim>::NodeBlockMatrix(
    std::shared_ptr<const NodePattern> pattern)
    : pattern(std::move(pattern))
    , row_starts(this->pattern->starts.data())
    , stored_starts(this->pattern->stored_starts.empty()
                      ? row_starts
                      : this->pattern->stored_starts.data())
    , columns(this->pattern->columns.data())
    , values(stored_starts[this->pattern->n_rows()] * (dim * dim) + 1, 0.)
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
  NodeValue<dim>
  NodeBlockMatrix<dim>::row_times(const unsigned int row, const double *x) const
  {
    const std::size_t stored = stored_end(row), end = row_end(row);
    NodeValue<dim>    result = RowKernels::times<dim>(rows(), row, x);
    for (std::size_t e = stored; e < end; ++e)
      {
        const double *image = mirror_image(row, e - stored);
        const double *value = x + dim * static_cast<std::size_t>(columns[e]);
        for (int d = 0; d < dim; ++d)
          for (int c = 0; c < dim; ++c)
            result[d] += image[c * dim + d] * value[c];
      }
    return result;
  }



  template <int dim>
  double *
  NodeBlockMatrix<dim>::partial_sums() const
  {
    AssertThrow(n_rows() == 0 ||
                  stores_half<dim> != pattern->stored_starts.empty(),
                ExcMessage("The pattern has not what kernels need; see "
                           "NodePattern::complete()."));
    if (!stores_half<dim>)
      return nullptr;
    const std::size_t size =
      RowKernels::n_partial_sums * static_cast<std::size_t>(n_rows());
    if (sums.size() != size)
      sums = HugePageVector<double>(size, 0.);
    return sums.data();
  }



  template <int dim>
  void
  NodeBlockMatrix<dim>::vmult(double *y, const double *x) const
  {
    residual(y, nullptr, x);
  }



  template <int dim>
  void
  NodeBlockMatrix<dim>::residual(double       *r,
                                 const double *b,
                                 const double *x) const
  {
    Prefetch nothing;
    RowKernels::residual<dim>(
      rows(), {{0, n_rows()}, nothing, {partial_sums(), true, true}}, r, b, x);
  }



  template <int dim>
  std::size_t
  NodeBlockMatrix<dim>::memory_consumption() const
  {
    return (pattern == nullptr ? 0 : pattern->memory_consumption()) +
      (values.capacity() + sums.capacity()) * sizeof(double);
  }



  template class NodeBlockMatrix<2>;
  template class NodeBlockMatrix<3>;
} // namespace Friction

#include <common/multigrid/leaf_matrix.h>

#include <algorithm>

namespace Friction
{
  template <int dim>
  NodeBlockMatrix<dim>
  make_node_block_matrix(const TrilinosWrappers::SparseMatrix &matrix,
                         const DynamicSparsityPattern         &pattern,
                         const NodalConstraints<dim>          &constraints)
  {
    const auto        &partitioner = *constraints.partitioner();
    const unsigned int n_rows      = constraints.n_owned_nodes();

    std::vector<std::size_t>  starts = {0};
    std::vector<unsigned int> columns, row;
    starts.reserve(n_rows + 1);
    for (unsigned int i = 0; i < n_rows; ++i)
      {
        row.clear();
        if (!constraints.is_hanging(i))
          {
            // The rows of the components of a node have the same pattern.
            const auto dof = partitioner.local_to_global(dim * i);
            for (auto entry = pattern.begin(dof); entry != pattern.end(dof);
                 ++entry)
              {
                const unsigned int j = constraints.node_of_dof(entry->column());
                if (j != i && !constraints.is_hanging(j))
                  row.push_back(j);
              }
            std::sort(row.begin(), row.end());
            row.erase(std::unique(row.begin(), row.end()), row.end());
            columns.push_back(i);
            columns.insert(columns.end(), row.begin(), row.end());
          }
        starts.push_back(columns.size());
      }
    columns.shrink_to_fit();

    NodeBlockMatrix<dim> result(std::move(starts), std::move(columns));
    for (unsigned int i = 0; i < n_rows; ++i)
      for (std::size_t e = result.row_begin(i); e < result.row_end(i); ++e)
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int r = 0; r < dim; ++r)
            result.block(e)[c * dim + r] = matrix.el(
              partitioner.local_to_global(dim * i + r),
              partitioner.local_to_global(dim * result.column(e) + c));
    return result;
  }



  template NodeBlockMatrix<2>
  make_node_block_matrix(const TrilinosWrappers::SparseMatrix &,
                         const DynamicSparsityPattern &,
                         const NodalConstraints<2> &);
  template NodeBlockMatrix<3>
  make_node_block_matrix(const TrilinosWrappers::SparseMatrix &,
                         const DynamicSparsityPattern &,
                         const NodalConstraints<3> &);
} // namespace Friction

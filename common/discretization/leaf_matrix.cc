#include <common/compatibility.h>
#include <common/discretization/leaf_matrix.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/lac/sparsity_tools.h>

#include <algorithm>

namespace Friction
{
  template <int dim>
  void
  make_stiffness_pattern(const DoFHandler<dim>           &dof_handler,
                         const AffineConstraints<double> &hanging,
                         DynamicSparsityPattern          &pattern)
  {
    const IndexSet relevant =
      DoFTools::extract_locally_relevant_dofs(dof_handler);
    pattern.reinit(dof_handler.n_dofs(), dof_handler.n_dofs(), relevant);
    DoFTools::make_sparsity_pattern(dof_handler,
                                    pattern,
                                    hanging,
                                    /*keep constrained dofs =*/false);
    SparsityTools::distribute_sparsity_pattern(
      pattern,
      dof_handler.locally_owned_dofs(),
      Compatibility::mpi_communicator(dof_handler),
      relevant);
  }



  template <int dim>
  IndexSet
  coupled_dofs(const DoFHandler<dim>        &dof_handler,
               const DynamicSparsityPattern &pattern)
  {
    const IndexSet &owned = dof_handler.locally_owned_dofs();
    std::vector<types::global_dof_index> others;
    for (const auto row : owned)
      for (auto entry = pattern.begin(row); entry != pattern.end(row); ++entry)
        if (!owned.is_element(entry->column()))
          others.push_back(entry->column());
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());

    // All components of a node, or none.
    IndexSet coupled(owned.size());
    for (const auto dof : others)
      coupled.add_range(dof - dof % dim, dof - dof % dim + dim);
    coupled.compress();
    return coupled;
  }



  template <int dim>
  NodeBlockMatrix<dim>
  make_node_block_matrix(const TrilinosWrappers::SparseMatrix &matrix,
                         const DynamicSparsityPattern         &pattern,
                         const NodalConstraints<dim>          &constraints)
  {
    const auto        &partitioner = *constraints.partitioner();
    const unsigned int n_rows      = constraints.n_owned_nodes();

    auto                      blocks = std::make_shared<NodePattern>();
    std::vector<unsigned int> row;
    blocks->starts.reserve(n_rows + 1);
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
                if (!constraints.is_hanging(j))
                  row.push_back(j);
              }
            row.push_back(i);
            std::sort(row.begin(), row.end());
            row.erase(std::unique(row.begin(), row.end()), row.end());
          }
        blocks->append_row(row);
      }
    blocks->columns.shrink_to_fit();

    NodeBlockMatrix<dim> result(std::move(blocks));
    for (unsigned int i = 0; i < n_rows; ++i)
      for (std::size_t e = result.row_begin(i); e < result.row_end(i); ++e)
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int r = 0; r < dim; ++r)
            result.block(e)[c * dim + r] = matrix.el(
              partitioner.local_to_global(dim * i + r),
              partitioner.local_to_global(dim * result.column(e) + c));
    return result;
  }



  template void     make_stiffness_pattern(const DoFHandler<2> &,
                                           const AffineConstraints<double> &,
                                           DynamicSparsityPattern &);
  template void     make_stiffness_pattern(const DoFHandler<3> &,
                                           const AffineConstraints<double> &,
                                           DynamicSparsityPattern &);
  template IndexSet coupled_dofs(const DoFHandler<2> &,
                                 const DynamicSparsityPattern &);
  template IndexSet coupled_dofs(const DoFHandler<3> &,
                                 const DynamicSparsityPattern &);
  template NodeBlockMatrix<2>
  make_node_block_matrix(const TrilinosWrappers::SparseMatrix &,
                         const DynamicSparsityPattern &,
                         const NodalConstraints<2> &);
  template NodeBlockMatrix<3>
  make_node_block_matrix(const TrilinosWrappers::SparseMatrix &,
                         const DynamicSparsityPattern &,
                         const NodalConstraints<3> &);
} // namespace Friction

// Two function templates of deal.II's Trilinos matrices, for Clang. Their
// definitions are in deal.II's library and not in its headers, and GCC, which
// packages are compiled with, gives them other names there than Clang does in
// what it compiles here (both have a condition on types in their result). So
// under Clang they are defined once more, from functions that have the same
// name everywhere.
#if defined(__clang__)

#  include <deal.II/lac/dynamic_sparsity_pattern.h>
#  include <deal.II/lac/la_parallel_vector.h>
#  include <deal.II/lac/trilinos_sparse_matrix.h>
#  include <deal.II/lac/trilinos_sparsity_pattern.h>

#  include <Epetra_Vector.h>

#  include <vector>

DEAL_II_NAMESPACE_OPEN

namespace TrilinosWrappers
{
#  if DEAL_II_VERSION_GTE(9, 5, 0)
  using Communicator = const MPI_Comm;
#  else
  using Communicator = const MPI_Comm &;
#  endif

  template <>
  void
  SparseMatrix::reinit(const IndexSet               &rows,
                       const IndexSet               &columns,
                       const DynamicSparsityPattern &pattern,
                       Communicator                  communicator,
                       const bool /*exchange_data*/)
  {
    IndexSet held = pattern.row_index_set();
    if (held.size() == 0)
      held = complete_index_set(pattern.n_rows());
    TrilinosWrappers::SparsityPattern entries(
      rows, columns, held, communicator, pattern.max_entries_per_row());
    std::vector<dealii::types::global_dof_index> row_columns;
    for (const auto row : held)
      {
        row_columns.clear();
        for (auto entry = pattern.begin(row); entry != pattern.end(row);
             ++entry)
          row_columns.push_back(entry->column());
        entries.add_entries(row, row_columns.begin(), row_columns.end(), true);
      }
    entries.compress();
    reinit(entries);
  }



  template <>
  void
  SparseMatrix::vmult(
    LinearAlgebra::distributed::Vector<double>       &result,
    const LinearAlgebra::distributed::Vector<double> &argument) const
  {
    Epetra_Vector to(View, trilinos_matrix().RangeMap(), result.begin());
    Epetra_Vector from(View,
                       trilinos_matrix().DomainMap(),
                       const_cast<double *>(argument.begin()));
    const int     error = trilinos_matrix().Multiply(false, from, to);
    Assert(error == 0, ExcTrilinosError(error));
    (void)error;
  }
} // namespace TrilinosWrappers

DEAL_II_NAMESPACE_CLOSE

#endif

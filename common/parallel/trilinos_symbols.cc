// Two function templates of deal.II's Trilinos matrices, for Clang. Their
// definitions are in deal.II's library and not in its headers, and GCC, which
// packages are compiled with, gives them other names there than Clang does in
// what it compiles here (both have a condition on types in their result). Where
// CMake finds that a call of one of them cannot be linked, it is defined once
// more here, from functions that have the same name everywhere.
#include <common/compatibility.h>

#if defined(FRICTION_DEFINE_TRILINOS_REINIT) || \
  defined(FRICTION_DEFINE_TRILINOS_VMULT)

#  include <deal.II/lac/dynamic_sparsity_pattern.h>
#  include <deal.II/lac/la_parallel_vector.h>
#  include <deal.II/lac/trilinos_sparse_matrix.h>
#  include <deal.II/lac/trilinos_sparsity_pattern.h>

#  include <Epetra_Vector.h>

#  include <vector>

DEAL_II_NAMESPACE_OPEN

namespace TrilinosWrappers
{
#  ifdef FRICTION_DEFINE_TRILINOS_REINIT
  // Rows of other processes that the pattern has are sent to their owners, also
  // if exchange_data does not ask for it.
  template <>
  void
  SparseMatrix::reinit(
    const IndexSet                                 &rows,
    const IndexSet                                 &columns,
    const DynamicSparsityPattern                   &pattern,
    Friction::Compatibility::CommunicatorOfTrilinos communicator,
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
        row_columns.resize(pattern.row_length(row));
        for (unsigned int i = 0; i < row_columns.size(); ++i)
          row_columns[i] = pattern.column_number(row, i);
        entries.add_entries(row, row_columns.begin(), row_columns.end(), true);
      }
    entries.compress();
    reinit(entries);
  }
#  endif



#  ifdef FRICTION_DEFINE_TRILINOS_VMULT
  template <>
  void
  SparseMatrix::vmult(
    LinearAlgebra::distributed::Vector<double>       &result,
    const LinearAlgebra::distributed::Vector<double> &argument) const
  {
    const Epetra_CrsMatrix &matrix = trilinos_matrix();
    Assert(&result != &argument, ExcSourceEqualsDestination());
    Assert(matrix.Filled(), ExcMatrixNotCompressed());
    AssertDimension(
      result.locally_owned_size(),
      static_cast<unsigned int>(matrix.RangeMap().NumMyElements()));
    AssertDimension(
      argument.locally_owned_size(),
      static_cast<unsigned int>(matrix.DomainMap().NumMyElements()));
    Epetra_Vector to(View, matrix.RangeMap(), result.begin());
    Epetra_Vector from(
      View, matrix.DomainMap(), const_cast<double *>(argument.begin()));
    const int error = matrix.Multiply(false, from, to);
    Assert(error == 0, ExcTrilinosError(error));
    (void)error;
  }
#  endif
} // namespace TrilinosWrappers

DEAL_II_NAMESPACE_CLOSE

#endif

#include <common/levels/sparse_factors.h>
#include <common/parallel/reductions.h>

#include <deal.II/base/mpi.h>

#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <Eigen/SparseCholesky>

namespace Friction
{
  struct SparseFactors::Cholesky
  {
    using Matrix = Eigen::SparseMatrix<double>;

    // Another order than that of the unknowns, found at the first matrix.
    Eigen::SimplicialLLT<Matrix, Eigen::Lower> factors;
    Eigen::Index                               n_entries = 0;
  };



  namespace
  {
    // Rows are columns, the matrix being symmetric.
    Eigen::Map<const Eigen::SparseMatrix<double>>
    entries_of(const TrilinosWrappers::SparseMatrix &matrix)
    {
      int        *starts, *columns;
      double     *values;
      const auto &epetra = matrix.trilinos_matrix();
      AssertThrow(epetra.ExtractCrsDataPointers(starts, columns, values) == 0,
                  ExcMessage("Entries of the matrix are not in one piece."));
      return {epetra.NumMyRows(),
              epetra.NumMyRows(),
              epetra.NumMyNonzeros(),
              starts,
              columns,
              values};
    }
  } // namespace



  SparseFactors::SparseFactors()
    : control(1, 0.)
  {}



  SparseFactors::~SparseFactors() = default;



  bool
  SparseFactors::factorize(const TrilinosWrappers::SparseMatrix &matrix)
  {
    const MPI_Comm comm = matrix.get_mpi_communicator();
    if (Utilities::MPI::n_mpi_processes(comm) > 1)
      {
        bool is_bad = false;
        by_trilinos = std::make_unique<TrilinosWrappers::SolverDirect>(control);
        try
          {
            by_trilinos->initialize(matrix);
          }
        catch (const ExceptionBase &)
          {
            is_bad = true;
          }
        return !true_on_any_process(is_bad, comm);
      }

    if (!cholesky)
      cholesky = std::make_unique<Cholesky>();
    const Cholesky::Matrix A = entries_of(matrix);
    if (cholesky->n_entries == 0)
      {
        cholesky->factors.analyzePattern(A);
        cholesky->n_entries = A.nonZeros();
      }
    Assert(cholesky->n_entries == A.nonZeros(),
           ExcMessage("The matrix has another pattern than the first one."));
    cholesky->factors.factorize(A);
    if (cholesky->factors.info() != Eigen::Success)
      return false;
    // Pivots that are smaller than this are rounding errors.
    constexpr double      rounding = 1e-14;
    const Eigen::VectorXd pivots =
      cholesky->factors.matrixL().nestedExpression().diagonal();
    const Eigen::VectorXd diagonal =
      cholesky->factors.permutationP() * Eigen::VectorXd(A.diagonal());
    return (pivots.array().square() >= rounding * diagonal.array()).all();
  }



  void
  SparseFactors::solve(VectorType &x, const VectorType &b) const
  {
    if (by_trilinos)
      {
        by_trilinos->solve(x, b);
        return;
      }
    const unsigned int n = b.locally_owned_size();
    Eigen::Map<Eigen::VectorXd>(x.begin(), n) =
      cholesky->factors.solve(Eigen::Map<const Eigen::VectorXd>(b.begin(), n));
  }
} // namespace Friction

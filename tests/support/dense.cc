#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <tests/support/dense.h>

namespace Tests
{
  Eigen::MatrixXd
  congruence(const Eigen::MatrixXd &Z, const Eigen::MatrixXd &A)
  {
    using Sparse   = Eigen::SparseMatrix<double>;
    const Sparse S = Z.sparseView(), B = A.sparseView();
    return Sparse(Sparse(S.transpose()) * B * S);
  }



  Eigen::MatrixXd
  product(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B)
  {
    return A * B;
  }



  Eigen::MatrixXd
  inverse(const Eigen::MatrixXd &A)
  {
    return A.inverse();
  }



  Eigen::MatrixXd
  solve(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B)
  {
    return A.lu().solve(B);
  }



  Eigen::MatrixXd
  solve_singular(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B)
  {
    return A.fullPivLu().solve(B);
  }



  Eigen::MatrixXd
  least_squares(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B)
  {
    return A.completeOrthogonalDecomposition().solve(B);
  }



  Eigen::MatrixXd
  cholesky_factor(const Eigen::MatrixXd &A)
  {
    return Eigen::LLT<Eigen::MatrixXd>(A).matrixL();
  }



  Eigen::VectorXd
  eigenvalues(const Eigen::MatrixXd &A)
  {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
             A, Eigen::EigenvaluesOnly)
      .eigenvalues();
  }



  Eigen::MatrixXd
  eigenvectors_above(const Eigen::MatrixXd &A, const double eigenvalue)
  {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
    const auto n = (eigen.eigenvalues().array() > eigenvalue).count();
    return eigen.eigenvectors().rightCols(n);
  }



  Eigen::MatrixXd
  orthogonal_factor(const Eigen::MatrixXd &A)
  {
    return A.householderQr().householderQ();
  }
} // namespace Tests

#include <common/dense_algebra.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace Friction
{
  Eigenpairs
  eigenpairs(const Eigen::MatrixXd &matrix)
  {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
    return {solver.eigenvalues(), solver.eigenvectors()};
  }



  // Products of such small matrices are lazy, here and below: for large ones
  // Eigen has others, which are more to compile than the rest of this.
  Eigen::MatrixXd
  left_absolute_value(const Eigen::MatrixXd &A)
  {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullU);
    Eigen::MatrixXd                         U = svd.matrixU();
    for (Eigen::Index i = 0; i < U.cols(); ++i)
      U.col(i) *= svd.singularValues()[i];
    return U.lazyProduct(svd.matrixU().transpose());
  }



  Eigen::VectorXd
  least_squares(const Eigen::MatrixXd &A, const Eigen::VectorXd &b)
  {
    return A.colPivHouseholderQr().solve(b);
  }



  Eigen::MatrixXd
  pseudo_inverse(const Eigen::MatrixXd &A)
  {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(
      A, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const auto      n = svd.rank();
    Eigen::MatrixXd V = svd.matrixV().leftCols(n);
    for (Eigen::Index i = 0; i < n; ++i)
      V.col(i) /= svd.singularValues()[i];
    return V.lazyProduct(svd.matrixU().leftCols(n).transpose());
  }



  Eigen::MatrixXd
  inverse(const Eigen::MatrixXd &A)
  {
    return A.inverse();
  }
} // namespace Friction

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



  Eigen::MatrixXd
  left_absolute_value(const Eigen::MatrixXd &A)
  {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullU);
    return svd.matrixU() * svd.singularValues().asDiagonal() *
      svd.matrixU().transpose();
  }



  Eigen::VectorXd
  least_squares(const Eigen::MatrixXd &A, const Eigen::VectorXd &b)
  {
    return A.colPivHouseholderQr().solve(b);
  }



  Eigen::MatrixXd
  inverse(const Eigen::MatrixXd &A)
  {
    return A.inverse();
  }
} // namespace Friction

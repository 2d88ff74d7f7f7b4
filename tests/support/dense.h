#ifndef tests_support_dense_h
#define tests_support_dense_h

#include <Eigen/Core>

// Algebra of dense matrices for tests, by Eigen: products and decompositions
// that take the compiler seconds each, wherever they are instantiated. All
// matrices are those of any size.
namespace Tests
{
  /// $Z^TAZ$; the zeros of both matrices are made use of.
  Eigen::MatrixXd congruence(const Eigen::MatrixXd &Z,
                             const Eigen::MatrixXd &A);

  Eigen::MatrixXd product(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B);

  Eigen::MatrixXd inverse(const Eigen::MatrixXd &A);

  /// $A^{-1}B$.
  Eigen::MatrixXd solve(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B);

  /// The same where A may be singular: of many solutions the one whose
  /// undetermined unknowns are zero.
  Eigen::MatrixXd solve_singular(const Eigen::MatrixXd &A,
                                 const Eigen::MatrixXd &B);

  /// The X that makes $AX-B$ smallest.
  Eigen::MatrixXd least_squares(const Eigen::MatrixXd &A,
                                const Eigen::MatrixXd &B);

  /// The lower triangle L of $A=LL^T$.
  Eigen::MatrixXd cholesky_factor(const Eigen::MatrixXd &A);

  /// Those of a symmetric matrix, the smallest first.
  Eigen::VectorXd eigenvalues(const Eigen::MatrixXd &A);

  /// An orthonormal basis of the eigenvectors whose eigenvalues are larger.
  Eigen::MatrixXd eigenvectors_above(const Eigen::MatrixXd &A,
                                     const double           eigenvalue);

  /// The orthogonal factor of A = QR.
  Eigen::MatrixXd orthogonal_factor(const Eigen::MatrixXd &A);
} // namespace Tests

#endif

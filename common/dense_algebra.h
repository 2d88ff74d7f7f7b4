#ifndef friction_dense_algebra_h
#define friction_dense_algebra_h

#include <Eigen/Core>

namespace Friction
{
  // Decompositions of small matrices, by Eigen. For each size that is known
  // when it compiles, a compiler takes seconds for each of them; so here they
  // are those of any size, compiled once. All matrices are stored by columns.

  /** Those of a symmetric matrix with n rows. */
  struct Eigenpairs
  {
    Eigen::VectorXd values;  ///< n of them, the smallest first
    Eigen::MatrixXd vectors; ///< n by n: a column for each, orthonormal
  };

  /** @param matrix  symmetric; only its lower triangle is read. */
  Eigenpairs eigenpairs(const Eigen::MatrixXd &matrix);

  /** $(AA^T)^{1/2}$ of a square matrix, by its singular values. */
  Eigen::MatrixXd left_absolute_value(const Eigen::MatrixXd &A);

  /**
   * The x that makes $|Ax-b|$ smallest, by a factorisation QR with pivoting.
   * Columns of A that are sums of others, up to rounding, get a zero.
   */
  Eigen::VectorXd least_squares(const Eigen::MatrixXd &A,
                                const Eigen::VectorXd &b);

  /** The inverse of Moore and Penrose of a square matrix, by its singular
   * values; those that are but rounding errors of the largest count as zero. */
  Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd &A);

  /** Of a matrix that has one. */
  Eigen::MatrixXd inverse(const Eigen::MatrixXd &A);
} // namespace Friction

#endif

// Decompositions of small matrices, by what defines them: eigenpairs, the
// absolute value of a matrix that is not symmetric, combinations of columns
// some of which depend on others, the inverse, and that of Moore and Penrose.

#include <common/dense_algebra.h>
#include <common/iteration/best_combination.h>

#include <algorithm>
#include <iostream>
#include <vector>

#include <tests/support/check.h>
#include <tests/support/random.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_dense_algebra
{
  Eigen::MatrixXd
  random_matrix(const unsigned int m, const unsigned int n, Random &random)
  {
    Eigen::MatrixXd A(m, n);
    for (unsigned int i = 0; i < m * n; ++i)
      A(i) = random(-1., 1.);
    return A;
  }

  double
  difference(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B)
  {
    return (A - B).norm() / B.norm();
  }
} // namespace test_dense_algebra



TEST(dense_algebra)
{
  Random random(1);
  for (const unsigned int n : {1, 2, 3, 6})
    {
      std::cout << n << " rows" << std::endl;
      const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
      const Eigen::MatrixXd A = random_matrix(n, n, random);
      const Eigen::MatrixXd S = A + A.transpose();

      const Friction::Eigenpairs pairs = Friction::eigenpairs(S);
      check_below(difference(S * pairs.vectors,
                             pairs.vectors * pairs.values.asDiagonal()),
                  1e-13,
                  "eigenpairs");
      check_below(difference(pairs.vectors.transpose() * pairs.vectors, I),
                  1e-13,
                  "are orthonormal");
      check(std::is_sorted(pairs.values.data(), pairs.values.data() + n),
            "the smallest first");
      Eigen::MatrixXd lower = S;
      lower.triangularView<Eigen::StrictlyUpper>().setZero();
      check_below(difference(Friction::eigenpairs(lower).values, pairs.values),
                  1e-13,
                  "only the lower triangle is read");

      const Eigen::MatrixXd absolute = Friction::left_absolute_value(A);
      check_below(difference(absolute * absolute, A * A.transpose()),
                  1e-13,
                  "the square of the absolute value");
      check(Friction::eigenpairs(absolute).values[0] >= -1e-14,
            "which is positive semidefinite");

      check_below(difference(A * Friction::inverse(A), I), 1e-11, "inverse");

      // Of the second one, the last column depends on the others.
      Eigen::MatrixXd B = A;
      B.col(n - 1).setZero();
      if (n > 2)
        B.col(n - 1) = A.col(0) + 2. * A.col(1);
      for (const Eigen::MatrixXd &any : {A, n > 1 ? B : A})
        {
          const Eigen::MatrixXd X = Friction::pseudo_inverse(any);
          check_below(
            difference(any * X * any, any), 1e-11, "a pseudo-inverse");
          check_below(difference(X * any * X, X) / (1. + X.norm()),
                      1e-11,
                      "of which the matrix is one");
          check_below(difference(any * X, (any * X).transpose()) +
                        difference(X * any, (X * any).transpose()),
                      1e-10,
                      "and both products are symmetric");
        }
    }

  check(Friction::pseudo_inverse(Eigen::MatrixXd::Zero(2, 2)).isZero(0.),
        "the pseudo-inverse of zero is zero");

  std::cout << "least squares" << std::endl;
  Eigen::MatrixXd       A = random_matrix(7, 4, random);
  const Eigen::VectorXd b = random_matrix(7, 1, random);
  Eigen::VectorXd       x = Friction::least_squares(A, b);
  check_below((A.transpose() * (A * x - b)).norm(),
              1e-13,
              "what is left is orthogonal to all columns");
  const double rest = (A * x - b).norm();
  A.conservativeResize(7, 6);
  A.col(4) = A.col(0) + 2. * A.col(1);
  A.col(5).setZero();
  x = Friction::least_squares(A, b);
  check_below((A * x - b).norm() / rest - 1.,
              1e-12,
              "as small with columns that depend on others");
  check((x.array() == 0.).count() == 2, "two of which get a zero");

  // The same by the scalar products of five vectors, the last of them zero.
  std::vector<double> products;
  A.col(4) = A.col(5);
  for (unsigned int i = 0; i < 5; ++i)
    {
      products.push_back(A.col(i).dot(b));
      for (unsigned int j = 0; j <= i; ++j)
        products.push_back(A.col(i).dot(A.col(j)));
    }
  const std::vector<double> c       = Friction::best_combination(products, 5);
  const Eigen::VectorXd     of_four = Friction::least_squares(A.leftCols(4), b);
  check_below((Eigen::Map<const Eigen::VectorXd>(c.data(), 4) - of_four).norm(),
              1e-12,
              "from scalar products alone");
  check(c[4] == 0., "nothing of a vector that is zero");
}

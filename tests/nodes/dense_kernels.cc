// Factorisations of dense matrices, with the instructions of each kind that
// this processor has: their factors multiplied out, entry by entry, are the
// matrix again; of a symmetric one nothing above the diagonal is read or
// written, and an indefinite one is noticed. Sizes are those of one block of
// the algorithm, less and more.

#include <common/nodes/dense_kernels.h>
#include <common/nodes/instructions.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_dense_kernels
{
  constexpr unsigned int sizes[] = {1, 2, 7, 40, 131, 300};

  // Entries by columns.
  using Matrix = std::vector<double>;



  // M^T M and a part of the identity, nothing above the diagonal.
  Matrix
  symmetric(const unsigned int n, Random &random)
  {
    Matrix M(n * n), A(n * n, std::numeric_limits<double>::quiet_NaN());
    for (double &entry : M)
      entry = random(-1., 1.);
    for (unsigned int c = 0; c < n; ++c)
      for (unsigned int r = c; r < n; ++r)
        {
          double sum = (r == c ? .1 : 0.);
          for (unsigned int k = 0; k < n; ++k)
            sum += M[c * n + k] * M[r * n + k];
          A[c * n + r] = sum;
        }
    return A;
  }



  // (L 0; X 1) (1 0; 0 S) (L^T X^T; 0 1), the lower triangle.
  double
  multiplied_out(const Matrix      &F,
                 const unsigned int n,
                 const unsigned int n_eliminated,
                 const unsigned int r,
                 const unsigned int c)
  {
    double sum = (c >= n_eliminated ? F[c * n + r] : 0.);
    for (unsigned int k = 0; k < std::min(n_eliminated, c + 1); ++k)
      sum += F[k * n + r] * F[k * n + c];
    return sum;
  }



  void
  test_eliminate()
  {
    Random random(1);
    bool   succeeds = true, is_exact = true, leaves = true, notices = true;
    for (const Instructions instructions : available_instructions())
      for (const unsigned int n : sizes)
        for (const unsigned int n_eliminated : {n, (n + 1) / 2, n / 3, 0u})
          {
            instructions_in_use = instructions;
            const Matrix A      = symmetric(n, random);
            Matrix       F      = A;
            succeeds =
              succeeds && DenseKernels::eliminate(F.data(), n, n_eliminated);
            for (unsigned int c = 0; c < n; ++c)
              for (unsigned int r = 0; r < n; ++r)
                if (r < c)
                  leaves = leaves && std::isnan(F[c * n + r]);
                else
                  is_exact = is_exact &&
                    std::abs(multiplied_out(F, n, n_eliminated, r, c) -
                             A[c * n + r]) < 1e-12 * n;
            // Negative is the last one of those that are eliminated.
            if (n_eliminated > 0)
              {
                F = A;
                F[(n + 1) * (n_eliminated - 1)] *= -1;
                notices = notices &&
                  !DenseKernels::eliminate(F.data(), n, n_eliminated);
              }
          }
    check(succeeds && is_exact, "eliminated as far as is wanted");
    check(leaves, "of a symmetric matrix one triangle is enough");
    check(notices, "an indefinite matrix is noticed");
  }



  void
  test_solve()
  {
    Random random(2);
    bool   solves = true;
    for (const Instructions instructions : available_instructions())
      for (const unsigned int n : sizes)
        {
          instructions_in_use = instructions;
          Matrix A(n * n), F;
          for (double &entry : A)
            entry = random(-1., 1.);
          // Not without pivoting.
          A[0] = (n == 1 ? 2. : 0.);
          std::vector<double> b(n), x;
          for (double &entry : b)
            entry = random(-1., 1.);
          F = A;
          x = b;
          DenseKernels::solve(F.data(), x.data(), n);
          // What is on the diagonal then is that of U.
          if (n == 2)
            solves = solves &&
              std::abs(std::abs(F[0] * F[3]) - std::abs(A[1] * A[2])) < 1e-14;
          double largest = 0;
          for (const double entry : x)
            largest = std::max(largest, std::abs(entry));
          for (unsigned int r = 0; r < n; ++r)
            {
              double residual = b[r];
              for (unsigned int c = 0; c < n; ++c)
                residual -= A[c * n + r] * x[c];
              solves = solves && std::abs(residual) < 1e-13 * n * (1 + largest);
            }
        }
    check(solves, "linear equations are solved");
  }
} // namespace test_dense_kernels

TEST(dense_kernels)
{
  test_eliminate();
  test_solve();
}

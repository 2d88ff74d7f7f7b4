// What DenseKernels does, for the file that includes this: it has said for
// which instructions, and in which namespace.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>

namespace Friction
{
  namespace DenseKernels
  {
    namespace FRICTION_INSTRUCTIONS
    {
      using Matrix = Eigen::Map<Eigen::MatrixXd>;

      bool
      eliminate(double            *matrix,
                const unsigned int n,
                const unsigned int n_eliminated)
      {
        if (n_eliminated == 0)
          return true;
        Matrix     A(matrix, n, n);
        const auto n_left = n - n_eliminated;
        auto       own    = A.topLeftCorner(n_eliminated, n_eliminated);
        const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(own);
        if (cholesky.info() != Eigen::Success)
          return false;
        if (n_left == 0)
          return true;
        auto below = A.bottomLeftCorner(n_left, n_eliminated);
        own.transpose()
          .template triangularView<Eigen::Upper>()
          .template solveInPlace<Eigen::OnTheRight>(below);
        A.bottomRightCorner(n_left, n_left)
          .template selfadjointView<Eigen::Lower>()
          .rankUpdate(below, -1.);
        return true;
      }



      void
      solve(double *matrix, double *x, const unsigned int n)
      {
        Matrix                                                 A(matrix, n, n);
        Eigen::Map<Eigen::VectorXd>                            b(x, n);
        const Eigen::PartialPivLU<Eigen::Ref<Eigen::MatrixXd>> factors(A);
        b = factors.solve(b).eval();
      }
    } // namespace FRICTION_INSTRUCTIONS
  }   // namespace DenseKernels
} // namespace Friction

#undef FRICTION_INSTRUCTIONS

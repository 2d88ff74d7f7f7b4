#include <common/multigrid/node_block.h>

#include <Eigen/Eigenvalues>

namespace Friction
{
  template <int dim>
  NodeBlock<dim>
  pseudo_inverse(const NodeBlock<dim> &A,
                 const double          cut,
                 NodeBlock<dim>       *null_space)
  {
    using Matrix = Eigen::Matrix<double, dim, dim>;
    const Eigen::Map<const Matrix>              matrix(A.data());
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(matrix);

    Matrix inverse = Matrix::Zero(), null = Matrix::Zero();
    for (int d = 0; d < dim; ++d)
      {
        const auto v = eigen.eigenvectors().col(d);
        if (eigen.eigenvalues()(d) > cut)
          inverse += v * v.transpose() / eigen.eigenvalues()(d);
        else
          null += v * v.transpose();
      }

    NodeBlock<dim> result;
    Eigen::Map<Matrix>(result.data()) = inverse;
    if (null_space != nullptr)
      Eigen::Map<Matrix>(null_space->data()) = null;
    return result;
  }

  template NodeBlock<2>
  pseudo_inverse<2>(const NodeBlock<2> &, const double, NodeBlock<2> *);
  template NodeBlock<3>
  pseudo_inverse<3>(const NodeBlock<3> &, const double, NodeBlock<3> *);
} // namespace Friction

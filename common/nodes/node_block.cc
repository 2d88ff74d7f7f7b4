#include <common/dense_algebra.h>
#include <common/nodes/node_block.h>

#include <Eigen/LU>

#include <algorithm>

namespace Friction
{
  template <int dim>
  NodeBlock<dim>
  pseudo_inverse(const NodeBlock<dim> &A,
                 const double          cut,
                 NodeBlock<dim>       *null_space)
  {
    using Matrix = Eigen::Matrix<double, dim, dim>;
    const Eigen::Map<const Matrix> matrix(A.data());
    NodeBlock<dim>                 result;

    // Hardly any block is singular, or nearly so. The smallest eigenvalue is at
    // least the determinant over the product of bounds of the others.
    const double trace = matrix.trace();
    double       bound = matrix.determinant();
    for (int d = 1; d < dim; ++d)
      bound /= trace;
    if (trace > 0 && bound > std::max(cut, 1e-4 * trace))
      {
        const Matrix inverse = matrix.inverse();
        Eigen::Map<Matrix>(result.data()) =
          .5 * (inverse + inverse.transpose());
        if (null_space != nullptr)
          Eigen::Map<Matrix>(null_space->data()) = Matrix::Zero();
        return result;
      }

    const Eigenpairs eigen   = eigenpairs(matrix);
    Matrix           inverse = Matrix::Zero(), null = Matrix::Zero();
    for (int d = 0; d < dim; ++d)
      {
        const Eigen::Matrix<double, dim, 1> v = eigen.vectors.col(d);
        if (eigen.values[d] > cut)
          inverse += v * v.transpose() / eigen.values[d];
        else
          null += v * v.transpose();
      }

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

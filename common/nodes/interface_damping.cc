#include <common/dense_algebra.h>
#include <common/nodes/interface_damping.h>

namespace Friction
{
  namespace
  {
    // How much of the decrease that the diagonal gives is to remain.
    constexpr double remains = .25;

    template <int dim>
    using Matrix = Eigen::Matrix<double, dim, dim>;

    template <int dim>
    bool
    couples_to_ghosts(const NodeBlockMatrix<dim> &A, const unsigned int row)
    {
      for (std::size_t e = A.row_begin(row); e < A.row_end(row); ++e)
        if (A.column(e) >= A.n_rows())
          return true;
      return false;
    }

    template <int dim>
    NodeBlock<dim>
    symmetric_block(const Matrix<dim> &matrix)
    {
      NodeBlock<dim> result;
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int r = 0; r < dim; ++r)
          result[c * dim + r] = .5 * (matrix(r, c) + matrix(c, r));
      return result;
    }
  } // namespace



  template <int dim>
  NodeBlock<dim>
  interface_majorant(const NodeBlockMatrix<dim> &A, const unsigned int row)
  {
    if (!couples_to_ghosts(A, row))
      return zero_block<dim>();

    Matrix<dim> majorant = Matrix<dim>::Zero();
    for (std::size_t e = A.row_begin(row); e < A.row_end(row); ++e)
      if (A.column(e) >= A.n_rows())
        majorant += left_absolute_value(
          Eigen::Map<const Matrix<dim>>(A.value(row, e).data()));
    return symmetric_block<dim>(majorant);
  }



  template <int dim>
  NodeBlock<dim>
  interface_damping(const NodeBlockMatrix<dim> &A, const unsigned int row)
  {
    if (!couples_to_ghosts(A, row))
      return zero_block<dim>();

    const NodeBlock<dim> majorant = interface_majorant(A, row);
    const Matrix<dim> lacking = Eigen::Map<const Matrix<dim>>(majorant.data()) -
      (1. - remains) * Eigen::Map<const Matrix<dim>>(A.diagonal(row));
    const Eigenpairs eigen = eigenpairs(.5 * (lacking + lacking.transpose()));
    Matrix<dim>      positive = Matrix<dim>::Zero();
    for (int d = 0; d < dim; ++d)
      if (eigen.values[d] > 0.)
        {
          const Eigen::Matrix<double, dim, 1> v = eigen.vectors.col(d);
          positive += .5 * eigen.values[d] * v * v.transpose();
        }
    return symmetric_block<dim>(positive);
  }



  template NodeBlock<2> interface_majorant(const NodeBlockMatrix<2> &,
                                           const unsigned int);
  template NodeBlock<3> interface_majorant(const NodeBlockMatrix<3> &,
                                           const unsigned int);
  template NodeBlock<2> interface_damping(const NodeBlockMatrix<2> &,
                                          const unsigned int);
  template NodeBlock<3> interface_damping(const NodeBlockMatrix<3> &,
                                          const unsigned int);
} // namespace Friction

#include <common/iteration/dense_correction.h>
#include <common/nodes/dense_kernels.h>
#include <common/parallel/run_clock.h>

#include <Eigen/Core>

#include <algorithm>

namespace Friction
{
  template <int dim>
  DenseCorrection<dim>::DenseCorrection(const DiscreteProblem<dim> &problem)
    : problem(problem)
    , current(problem.constraints)
  {}



  // The matrix may be singular, as that of a body which slides and is held by
  // nothing else: residuals have no part in the direction that is lost, and it
  // gets a little stiffness.
  template <int dim>
  void
  DenseCorrection<dim>::update(const Linearization<dim> &linearization,
                               const Iterate &)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    if (is_factorised &&
        current.differences(linearization.truncation()).empty())
      return;
    current       = linearization.truncation();
    is_factorised = true;
    for (const double shift : {0., 1e-10})
      {
        fill(shift);
        const unsigned int n = dim * problem.stiffness.blocks().n_rows();
        const Eigen::Map<const Eigen::MatrixXd> A(factor.data(), n, n);
        const Eigen::VectorXd                   diagonal = A.diagonal();
        if (DenseKernels::eliminate(factor.data(), n, n) &&
            (A.diagonal().array().square() > 1e-14 * diagonal.array()).all())
          return;
      }
  }



  // T (A + omega'') T, and something positive on the diagonal for directions
  // that are taken out.
  template <int dim>
  void
  DenseCorrection<dim>::fill(const double shift)
  {
    const NodeBlockMatrix<dim> &A = problem.stiffness.blocks();
    const unsigned int          n = dim * A.n_rows();
    factor.assign(std::size_t(n) * n, 0.);
    double scale = 0;
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      scale = std::max(scale, trace<dim>(A.diagonal(i)) / dim);
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
        {
          const unsigned int   j = A.column(e);
          const NodeBlock<dim> block =
            current.linearized_block(i, A.value(i, e).data(), j);
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int r = 0; r < dim; ++r)
              {
                double &entry =
                  factor[std::size_t(dim * j + c) * n + dim * i + r];
                entry = block[c * dim + r];
                if (i == j)
                  entry += scale *
                    ((r == c ? 1. + shift : 0.) -
                     current.projector(i)[c * dim + r]);
              }
        }
  }



  template <int dim>
  void
  DenseCorrection<dim>::apply(VectorType &v, const VectorType &r)
  {
    const PhaseScope   phase(problem.communicator(), SolverPhase::coarsest);
    const unsigned int n = dim * problem.stiffness.blocks().n_rows();
    const Eigen::Map<Eigen::MatrixXd> L(factor.data(), n, n);
    Eigen::Map<Eigen::VectorXd>       x(v.begin(), n);
    x = Eigen::Map<const Eigen::VectorXd>(r.begin(), n);
    L.template triangularView<Eigen::Lower>().solveInPlace(x);
    L.transpose().template triangularView<Eigen::Upper>().solveInPlace(x);
    current.apply(v.begin());
  }



  template class DenseCorrection<2>;
  template class DenseCorrection<3>;
} // namespace Friction

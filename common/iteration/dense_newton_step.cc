#include <common/iteration/dense_newton_step.h>
#include <common/nodes/dense_kernels.h>
#include <common/parallel/run_clock.h>

#include <Eigen/Core>

#include <algorithm>

namespace Friction
{
  template <int dim>
  void
  DenseNewtonStep<dim>::update(const NewtonEquations<dim> &the_equations)
  {
    equations = &the_equations;
    find_directions();
  }



  // Held components are those along axes, and at contact nodes along vectors of
  // the frame. Hanging nodes have no row.
  template <int dim>
  void
  DenseNewtonStep<dim>::find_directions()
  {
    const DiscreteProblem<dim> &problem = equations->discrete_problem();
    const NodeBlockMatrix<dim> &A       = problem.stiffness.blocks();
    const unsigned int          n       = A.n_rows();
    std::vector<const ContactNode<dim> *> contact(n, nullptr);
    for (const ContactNode<dim> &node : problem.contact)
      contact[node.node] = &node;
    directions.clear();
    first.assign(1, 0);
    for (unsigned int i = 0; i < n; ++i)
      {
        for (unsigned int e = 0; e < dim && !A.is_empty(i); ++e)
          {
            NodeValue<dim> direction{};
            for (unsigned int d = 0; d < dim; ++d)
              direction[d] = contact[i] ? contact[i]->frame[e][d] : (d == e);
            const NodeValue<dim> free = times<dim>(
              equations->truncation().projector(i).data(), direction.data());
            if (dot<dim>(free.data(), free.data()) > .5)
              directions.push_back(direction);
          }
        first.push_back(directions.size());
      }
  }



  template <int dim>
  void
  DenseNewtonStep<dim>::fill(const double shift)
  {
    const DiscreteProblem<dim> &problem = equations->discrete_problem();
    const Truncation<dim>      &current = equations->truncation();
    const NodeBlockMatrix<dim> &A       = problem.stiffness.blocks();
    const unsigned int          n       = directions.size();

    std::vector<const ContactNode<dim> *> slider(A.n_rows(), nullptr);
    std::vector<NodeValue<dim>>           slope(A.n_rows());
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      if (equations->slopes()[p] != NodeValue<dim>{})
        {
          const ContactNode<dim> &node = problem.contact[p];
          slider[node.node]            = &node;
          slope[node.node]             = equations->slopes()[p];
        }

    matrix.assign(std::size_t(n) * n, 0.);
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      if (first[i] < first[i + 1])
        for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
          {
            const unsigned int   j      = A.column(e);
            const NodeBlock<dim> column = A.value(i, e);
            NodeBlock<dim>       block =
              current.linearized_block(i, column.data(), j);
            if (slider[i] != nullptr)
              {
                subtract_change_of_bound<dim>(
                  block,
                  slope[i],
                  *slider[i],
                  times<dim>(column, current.projector(j)));
              }
            for (unsigned int c = first[j]; c < first[j + 1]; ++c)
              {
                const NodeValue<dim> image =
                  times<dim>(block.data(), directions[c].data());
                for (unsigned int r = first[i]; r < first[i + 1]; ++r)
                  matrix[std::size_t(c) * n + r] =
                    dot<dim>(directions[r].data(), image.data());
              }
            if (i == j)
              for (unsigned int r = first[i]; r < first[i + 1]; ++r)
                matrix[std::size_t(r) * n + r] +=
                  shift * trace<dim>(column.data()) / dim;
          }
  }



  // The matrix may be singular, as that of a body which slides and is held by
  // nothing else, or where more friction than there is would hold a node. The
  // direction that is lost gets a little stiffness.
  template <int dim>
  typename NewtonStep<dim>::Outcome
  DenseNewtonStep<dim>::solve(VectorType       &v,
                              const VectorType &r,
                              const double,
                              const unsigned int)
  {
    const MPI_Comm     comm = equations->discrete_problem().communicator();
    const PhaseScope   phase(comm, SolverPhase::coarsest);
    const unsigned int n = directions.size();
    typename NewtonStep<dim>::Outcome outcome;
    v = 0.;
    if (n == 0)
      return outcome;

    Eigen::VectorXd b(n), x(n);
    for (unsigned int i = 0; i + 1 < first.size(); ++i)
      for (unsigned int k = first[i]; k < first[i + 1]; ++k)
        b(k) = dot<dim>(directions[k].data(), r.begin() + dim * i);
    for (const double shift : {0., 1e-10})
      {
        fill(shift);
        const Eigen::Map<const Eigen::MatrixXd> A(matrix.data(), n, n);
        const Eigen::ArrayXd                    largest =
          A.cwiseAbs().colwise().maxCoeff().transpose();
        x = b;
        DenseKernels::solve(matrix.data(), x.data(), n);
        if ((A.diagonal().array().abs() > 1e-13 * largest).all())
          break;
      }
    for (unsigned int i = 0; i + 1 < first.size(); ++i)
      for (unsigned int k = first[i]; k < first[i + 1]; ++k)
        for (unsigned int d = 0; d < dim; ++d)
          v.local_element(dim * i + d) += x(k) * directions[k][d];

    // What has been lost for want of a unique solution. In other directions
    // there are but rounding errors.
    VectorType image(r);
    equations->vmult(image, v);
    Eigen::VectorXd left(b);
    for (unsigned int i = 0; i + 1 < first.size(); ++i)
      for (unsigned int k = first[i]; k < first[i + 1]; ++k)
        left(k) -= dot<dim>(directions[k].data(), image.begin() + dim * i);
    outcome.iterations = 1;
    outcome.accuracy   = b.norm() == 0. ? 0. : left.norm() / b.norm();
    return outcome;
  }



  template class DenseNewtonStep<2>;
  template class DenseNewtonStep<3>;
} // namespace Friction

#include <tests/benchmarks/baselines/rotated_problem.h>

namespace Benchmark
{
  template <int dim>
  RotatedProblem<dim>::RotatedProblem(const DiscreteProblem<dim> &problem)
    : problem(problem)
    , fixed(dim * problem.constraints.n_owned_nodes(), 0)
    , contact_numbers(problem.constraints.n_owned_nodes(),
                      numbers::invalid_unsigned_int)
  {
    AssertThrow(Utilities::MPI::n_mpi_processes(problem.communicator()) == 1,
                ExcMessage("The solvers to compare with run on one process."));
    const NodalConstraints<dim> &constraints = problem.constraints;
    for (unsigned int node = 0; node < constraints.n_owned_nodes(); ++node)
      for (unsigned int d = 0; d < dim; ++d)
        fixed[dim * node + d] =
          constraints.is_hanging(node) || constraints.is_prescribed(node, d);
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      {
        const ContactNode<dim> &node = problem.contact[p];
        contact_numbers[node.node]   = p;
        for (unsigned int e = 0; e < dim; ++e)
          fixed[dim * node.node + e] = (e > node.n_free_tangents);
      }
  }



  template <int dim>
  void
  RotatedProblem<dim>::to_frames(VectorType &v) const
  {
    for (const ContactNode<dim> &node : problem.contact)
      {
        double        *values = v.begin() + dim * node.node;
        Tensor<1, dim> old;
        for (unsigned int d = 0; d < dim; ++d)
          old[d] = values[d];
        for (unsigned int e = 0; e < dim; ++e)
          values[e] = node.frame[e] * old;
      }
  }



  template <int dim>
  void
  RotatedProblem<dim>::from_frames(VectorType &v) const
  {
    for (const ContactNode<dim> &node : problem.contact)
      {
        double        *values = v.begin() + dim * node.node;
        Tensor<1, dim> sum;
        for (unsigned int e = 0; e < dim; ++e)
          sum += values[e] * node.frame[e];
        for (unsigned int d = 0; d < dim; ++d)
          values[d] = sum[d];
      }
  }



  template <int dim>
  NodeBlock<dim>
  RotatedProblem<dim>::block(const unsigned int row,
                             const std::size_t  position) const
  {
    NodeBlock<dim> B    = problem.stiffness.blocks().value(row, position);
    const auto     turn = [&](const unsigned int p, const bool rows) {
      NodeBlock<dim> C{};
      for (unsigned int e = 0; e < dim; ++e)
        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int o = 0; o < dim; ++o)
            if (rows)
              C[o * dim + e] += problem.contact[p].frame[e][d] * B[o * dim + d];
            else
              C[e * dim + o] += B[d * dim + o] * problem.contact[p].frame[e][d];
      B = C;
    };
    const unsigned int column = problem.stiffness.blocks().column(position);
    if (contact_numbers[row] != numbers::invalid_unsigned_int)
      turn(contact_numbers[row], true);
    if (contact_numbers[column] != numbers::invalid_unsigned_int)
      turn(contact_numbers[column], false);
    return B;
  }



  template <int dim>
  void
  RotatedProblem<dim>::vmult(VectorType &y, const VectorType &x) const
  {
    along_axes = x;
    from_frames(along_axes);
    problem.stiffness.vmult(y, along_axes);
    to_frames(y);
  }



  template <int dim>
  VectorType
  RotatedProblem<dim>::residual(const VectorType &u) const
  {
    VectorType r(u);
    problem.stiffness.residual(r, problem.forces, u);
    to_frames(r);
    return r;
  }



  template class RotatedProblem<2>;
  template class RotatedProblem<3>;
} // namespace Benchmark

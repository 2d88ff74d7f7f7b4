#include <common/nodes/gauss_seidel.h>

namespace Friction
{
  template <int dim>
  GaussSeidel<dim>::GaussSeidel(
    const NodeBlockMatrix<dim>        &A,
    const std::vector<NodeBlock<dim>> &inverse_diagonals,
    const NodeRanges                  &nodes,
    const unsigned int                 chunk_size)
    : A(&A)
    , inverse_diagonals(&inverse_diagonals)
    , sweep_schedule(A, nodes, chunk_size)
  {}



  template <int dim>
  void
  GaussSeidel<dim>::run(const Sweeps  &sweeps,
                        const double  *b,
                        double        *x,
                        GhostExchange &ghosts,
                        double        *residual) const
  {
    sweep_schedule.run(
      sweeps,
      residual != nullptr,
      [&](const unsigned int stage, const unsigned int chunk) {
        if (stage == sweeps.number)
          A->residual(residual,
                      b,
                      x,
                      sweep_schedule.chunk(chunk).first,
                      sweep_schedule.chunk(chunk).second);
        else
          relax_chunk(chunk, b, x, sweeps.backwards);
      },
      ghosts,
      x);
  }



  template <int dim>
  void
  GaussSeidel<dim>::relax_chunk(const unsigned int chunk,
                                const double      *b,
                                double            *x,
                                const bool         backwards) const
  {
    const NodeBlockMatrix<dim> &matrix  = *A;
    const NodeBlock<dim>       *inverse = inverse_diagonals->data();
    // A call for each node would cost more than its arithmetic.
    const auto relax =
      [ =, &matrix ](const unsigned int i) __attribute__((always_inline))
    {
      const NodeValue<dim> product = matrix.row_times(i, x);
      NodeValue<dim>       defect;
      for (int d = 0; d < dim; ++d)
        defect[d] = b[dim * i + d] - product[d];
      const NodeValue<dim> correction =
        times<dim>(inverse[i].data(), defect.data());
      for (int d = 0; d < dim; ++d)
        x[dim * i + d] += correction[d];
    };

    const NodeRanges &nodes = sweep_schedule.nodes(chunk);
    if (!backwards)
      for (unsigned int range = 0; range < nodes.size(); ++range)
        for (unsigned int i = nodes[range].first; i < nodes[range].second; ++i)
          relax(i);
    else
      for (unsigned int range = nodes.size(); range-- > 0;)
        for (unsigned int i = nodes[range].second; i-- > nodes[range].first;)
          relax(i);
  }



  template class GaussSeidel<2>;
  template class GaussSeidel<3>;
} // namespace Friction

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
      [&](const unsigned int stage,
          const unsigned int chunk,
          const RowRange    &ahead) {
        if (stage == sweeps.number)
          A->residual(residual, b, x, sweep_schedule.chunk(chunk), ahead);
        else
          {
            const RowRange all   = sweep_schedule.chunk(chunk);
            Prefetch       fetch = A->prefetch(ahead, all.second - all.first);
            relax_chunk(chunk, b, x, sweeps.backwards, fetch);
          }
      },
      ghosts,
      x);
  }



  template <int dim>
  void
  GaussSeidel<dim>::relax_chunk(const unsigned int chunk,
                                const double      *b,
                                double            *x,
                                const bool         backwards,
                                Prefetch          &fetch) const
  {
    const BlockRows<dim>  rows    = A->rows();
    const NodeBlock<dim> *inverse = inverse_diagonals->data();
    const NodeRanges     &nodes   = sweep_schedule.nodes(chunk);
    for (unsigned int k = 0; k < nodes.size(); ++k)
      RowKernels::relax<dim>(
        rows,
        inverse,
        {nodes[backwards ? nodes.size() - 1 - k : k], backwards, fetch},
        b,
        x);
  }



  template class GaussSeidel<2>;
  template class GaussSeidel<3>;
} // namespace Friction

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
  GaussSeidel<dim>::run(const unsigned int n_sweeps,
                        const double      *b,
                        double            *x,
                        GhostExchange     &ghosts,
                        double            *residual) const
  {
    const BlockRows<dim> rows = A->rows();
    const auto           pass = [&](const RowKernels::RowLoop &loop) {
      RowKernels::pass<dim>(rows, loop, x);
    };
    sweep_schedule.run(
      n_sweeps,
      residual != nullptr,
      [&](const Stage &stage, const RowRange &ahead) {
        if (sweep_schedule.is_empty())
          return;
        const RowRange      all   = sweep_schedule.chunk(stage.chunk);
        Prefetch            fetch = A->prefetch(ahead, all.second - all.first);
        RowKernels::RowLoop loop{all, fetch, left_sums(stage)};
        if (stage.computes_residual)
          RowKernels::residual<dim>(rows, loop, residual, b, x);
        else
          relax_chunk(stage, loop, b, x, pass);
      },
      ghosts,
      x);
    // Where nothing is relaxed no sums need be passed on.
    if (sweep_schedule.is_empty() && residual != nullptr)
      A->residual(residual, b, x);
  }



  template class GaussSeidel<2>;
  template class GaussSeidel<3>;
} // namespace Friction

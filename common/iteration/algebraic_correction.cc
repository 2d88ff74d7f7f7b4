#include <common/iteration/algebraic_correction.h>
#include <common/parallel/reductions.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <algorithm>

namespace Friction
{
  template <int dim>
  AlgebraicCorrection<dim>::AlgebraicCorrection(
    const DiscreteProblem<dim> &problem, const CoarsestMethod method)
    : problem(problem)
    , current(problem.constraints)
    , solver(method, dim)
  {
    const NodeBlockMatrix<dim> &leaf_matrix = problem.stiffness.blocks();
    const auto    &partitioner = *problem.constraints.partitioner();
    const IndexSet owned       = partitioner.locally_owned_range();
    const MPI_Comm comm        = problem.communicator();
    rhs.reinit(owned, comm);
    solution.reinit(rhs);

    DynamicSparsityPattern pattern(owned.size(), owned.size(), owned);
    for (unsigned int i = 0; i < leaf_matrix.n_rows(); ++i)
      for (unsigned int r = 0; r < dim; ++r)
        {
          const auto row = partitioner.local_to_global(dim * i + r);
          for (unsigned int c = 0; c < dim; ++c)
            pattern.add(row, partitioner.local_to_global(dim * i + c));
          for (std::size_t e = leaf_matrix.row_begin(i);
               e < leaf_matrix.row_end(i);
               ++e)
            for (unsigned int c = 0; c < dim; ++c)
              pattern.add(
                row,
                partitioner.local_to_global(dim * leaf_matrix.column(e) + c));
        }
    matrix = std::make_unique<TrilinosWrappers::SparseMatrix>();
    matrix->reinit(owned, owned, pattern, comm);

    for (unsigned int i = 0; i < leaf_matrix.n_rows(); ++i)
      if (!leaf_matrix.is_empty(i))
        scale = std::max(scale, trace<dim>(leaf_matrix.diagonal(i)));
    scale = max_over_processes(scale, comm);
    if (scale == 0)
      scale = 1.;
  }



  template <int dim>
  AlgebraicCorrection<dim>::~AlgebraicCorrection() = default;



  template <int dim>
  void
  AlgebraicCorrection<dim>::update(const Linearization<dim> &linearization,
                                   const Iterate &)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    const Truncation<dim> &truncation = linearization.truncation();
    const bool changed = !is_filled || !current.differences(truncation).empty();
    if (!true_on_any_process(changed, problem.communicator()))
      return;
    current = truncation;
    fill();
  }



  // T (A + omega'') T, and a multiple of I - T on the diagonal to have the
  // matrix positive definite; hanging nodes have no rows, and get the multiple
  // of the identity.
  template <int dim>
  void
  AlgebraicCorrection<dim>::fill()
  {
    const NodeBlockMatrix<dim> &leaf_matrix = problem.stiffness.blocks();
    const auto &partitioner = *problem.constraints.partitioner();
    const auto  dof = [&](const unsigned int node, const unsigned int d) {
      return partitioner.local_to_global(dim * node + d);
    };
    for (unsigned int i = 0; i < leaf_matrix.n_rows(); ++i)
      {
        const bool empty = leaf_matrix.is_empty(i);
        if (empty)
          for (unsigned int d = 0; d < dim; ++d)
            matrix->set(dof(i, d), dof(i, d), scale);
        for (std::size_t e = leaf_matrix.row_begin(i);
             e < leaf_matrix.row_end(i);
             ++e)
          {
            const unsigned int j = leaf_matrix.column(e);
            NodeBlock<dim>     block =
              current.linearized_block(i, leaf_matrix.value(i, e).data(), j);
            if (i == j)
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int r = 0; r < dim; ++r)
                  block[c * dim + r] += scale *
                    ((r == c ? 1. : 0.) - current.projector(i)[c * dim + r]);
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int r = 0; r < dim; ++r)
                matrix->set(dof(i, r), dof(j, c), block[c * dim + r]);
          }
      }
    matrix->compress(VectorOperation::insert);
    solver.initialize(*matrix);
    is_filled = true;
  }



  template <int dim>
  void
  AlgebraicCorrection<dim>::apply(VectorType &v, const VectorType &r)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::coarsest);
    std::copy_n(r.begin(), rhs.locally_owned_size(), rhs.begin());
    solver.solve(solution, rhs);
    std::copy_n(solution.begin(), solution.locally_owned_size(), v.begin());
    current.apply(v.begin());
  }



  template <int dim>
  std::size_t
  AlgebraicCorrection<dim>::memory_consumption() const
  {
    return matrix->memory_consumption();
  }



  template class AlgebraicCorrection<2>;
  template class AlgebraicCorrection<3>;
} // namespace Friction

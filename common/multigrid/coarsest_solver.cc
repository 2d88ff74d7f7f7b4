#include <common/compatibility.h>
#include <common/multigrid/coarsest_solver.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <algorithm>

namespace Friction
{
  template <int dim>
  CoarsestSolver<dim>::CoarsestSolver(const DoFHandler<dim>    &dof_handler,
                                      const LevelMatrices<dim> &level_matrices,
                                      const CoarsestMethod      method)
    : level_matrices(level_matrices)
    , solver(method, dim)
  {
    const NodeBlockMatrix<dim> &B     = level_matrices.matrix(0);
    const IndexSet             &owned = dof_handler.locally_owned_mg_dofs(0);
    rhs.reinit(owned, Compatibility::mpi_communicator(dof_handler));

    DynamicSparsityPattern pattern(owned.size(), owned.size(), owned);
    for (unsigned int i = 0; i < B.n_rows(); ++i)
      for (unsigned int r = 0; r < dim; ++r)
        {
          pattern.add(dim * i + r, dim * i + r);
          for (std::size_t e = B.row_begin(i); e < B.row_end(i); ++e)
            for (unsigned int c = 0; c < dim; ++c)
              pattern.add(dim * i + r, dim * B.column(e) + c);
        }
    matrix.reinit(
      owned, owned, pattern, Compatibility::mpi_communicator(dof_handler));
    set_up();
  }



  template <int dim>
  void
  CoarsestSolver<dim>::set_up()
  {
    const NodeBlockMatrix<dim> &B     = level_matrices.matrix(0);
    const auto                 &nulls = level_matrices.coarsest_null_spaces();

    double scale = 0;
    for (unsigned int i = 0; i < B.n_rows(); ++i)
      if (B.row_begin(i) != B.row_end(i))
        scale = std::max(scale, trace<dim>(B.block(B.row_begin(i))));
    if (scale == 0)
      scale = 1.;

    // M_i B_ij M_j with M = I - N, and a multiple of N on the diagonal.
    const auto complement = [&](const unsigned int i) {
      NodeBlock<dim> M = identity_block<dim>();
      for (unsigned int d = 0; d < dim * dim; ++d)
        M[d] -= nulls[i][d];
      return M;
    };
    for (unsigned int i = 0; i < B.n_rows(); ++i)
      {
        const NodeBlock<dim> Mi        = complement(i);
        bool                 empty_row = true;
        for (std::size_t e = B.row_begin(i); e < B.row_end(i); ++e)
          {
            empty_row            = false;
            const unsigned int j = B.column(e);
            NodeBlock<dim>     block;
            std::copy_n(B.block(e), dim * dim, block.begin());
            block = times<dim>(times<dim>(Mi, block), complement(j));
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int r = 0; r < dim; ++r)
                matrix.set(dim * i + r,
                           dim * j + c,
                           block[c * dim + r] +
                             (i == j ? scale * nulls[i][c * dim + r] : 0.));
          }
        if (empty_row)
          for (unsigned int r = 0; r < dim; ++r)
            matrix.set(dim * i + r, dim * i + r, scale);
      }
    matrix.compress(VectorOperation::insert);

    solver.initialize(matrix);
    version = level_matrices.coarsest_version();
  }



  template <int dim>
  void
  CoarsestSolver<dim>::project(VectorType &v) const
  {
    const auto &nulls = level_matrices.coarsest_null_spaces();
    for (unsigned int i = 0; i < nulls.size(); ++i)
      {
        const NodeValue<dim> part =
          times<dim>(nulls[i].data(), v.begin() + dim * i);
        for (unsigned int d = 0; d < dim; ++d)
          v.local_element(dim * i + d) -= part[d];
      }
  }



  template <int dim>
  void
  CoarsestSolver<dim>::solve(VectorType &c, const VectorType &r)
  {
    if (version != level_matrices.coarsest_version())
      set_up();
    rhs = r;
    project(rhs);
    solver.solve(c, rhs);
    project(c);
  }



  template <int dim>
  void
  CoarsestSolver<dim>::solve_on_face(VectorType              &c,
                                     const VectorType        &r,
                                     const std::vector<char> &is_fixed)
  {
    if (version != level_matrices.coarsest_version())
      set_up();
    const auto &nulls = level_matrices.coarsest_null_spaces();
    solver.solve_in_subspace(c, r, [&](VectorType &v) {
      for (unsigned int i = 0; i < nulls.size(); ++i)
        {
          unsigned int n_fixed = 0;
          for (unsigned int d = 0; d < dim; ++d)
            n_fixed += is_fixed[dim * i + d];
          if (n_fixed == 0)
            continue;
          const bool all = (trace<dim>(nulls[i].data()) > 0.5);
          for (unsigned int d = 0; d < dim; ++d)
            if (all || is_fixed[dim * i + d])
              v.local_element(dim * i + d) = 0.;
        }
      project(v);
    });
  }



  template class CoarsestSolver<2>;
  template class CoarsestSolver<3>;
} // namespace Friction

#include <common/levels/coarsest_solver.h>
#include <common/parallel/reductions.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <algorithm>
#include <array>
#include <vector>

namespace Friction
{
  template <int dim>
  CoarsestSolver<dim>::CoarsestSolver(const LevelHierarchy<dim> &hierarchy,
                                      const LevelMatrices<dim>  &level_matrices,
                                      const CoarsestMethod       method)
    : hierarchy(hierarchy)
    , level_matrices(level_matrices)
    , solver(method, dim)
    , ghosts(hierarchy.level(0).numbering(),
             hierarchy.level(0).coupled_ghosts())
  {
    const NodeBlockMatrix<dim> &B = level_matrices.matrix(0);
    const NodeDistribution     &nodes =
      hierarchy.level(0).numbering().distribution();
    IndexSet owned(dim * nodes.n_global());
    owned.add_range(dim * nodes.global(0), dim * nodes.global(nodes.n_owned()));
    rhs.reinit(owned, nodes.communicator());
    solution.reinit(rhs);

    DynamicSparsityPattern pattern(owned.size(), owned.size(), owned);
    for (unsigned int i = 0; i < B.n_rows(); ++i)
      for (unsigned int r = 0; r < dim; ++r)
        {
          pattern.add(dof(i, r), dof(i, r));
          for (std::size_t e = B.row_begin(i); e < B.row_end(i); ++e)
            for (unsigned int c = 0; c < dim; ++c)
              pattern.add(dof(i, r), dof(B.column(e), c));
        }
    matrix = std::make_unique<TrilinosWrappers::SparseMatrix>();
    matrix->reinit(owned, owned, pattern, nodes.communicator());
    set_up();
  }



  template <int dim>
  CoarsestSolver<dim>::~CoarsestSolver() = default;



  template <int dim>
  types::global_dof_index
  CoarsestSolver<dim>::dof(const unsigned int node,
                           const unsigned int component) const
  {
    return dim * hierarchy.level(0).numbering().global(node) + component;
  }



  template <int dim>
  void
  CoarsestSolver<dim>::set_up()
  {
    const NodeBlockMatrix<dim> &B     = level_matrices.matrix(0);
    const auto                 &nulls = level_matrices.coarsest_null_spaces();

    double scale = 0;
    for (unsigned int i = 0; i < B.n_rows(); ++i)
      if (!B.is_empty(i))
        scale = std::max(scale, trace<dim>(B.diagonal(i)));
    scale = max_over_processes(scale, rhs.get_mpi_communicator());
    if (scale == 0)
      scale = 1.;

    // M_i B_ij M_j with M = I - N, and a multiple of N on the diagonal; at the
    // ghosts their owners know N.
    const auto                 &level = hierarchy.level(0);
    std::vector<NodeBlock<dim>> complements(level.n_local_nodes(),
                                            identity_block<dim>());
    for (unsigned int i = 0; i < B.n_rows(); ++i)
      for (unsigned int d = 0; d < dim * dim; ++d)
        complements[i][d] -= nulls[i][d];
    ghosts.update(reinterpret_cast<double *>(complements.data()), dim * dim);

    // A call for each row: one for each entry takes longer than finding its
    // place in the row.
    std::vector<types::global_dof_index> columns;
    std::array<std::vector<double>, dim> rows;
    for (unsigned int i = 0; i < B.n_rows(); ++i)
      {
        columns.clear();
        for (std::vector<double> &row : rows)
          row.clear();
        for (std::size_t e = B.row_begin(i); e < B.row_end(i); ++e)
          {
            const unsigned int   j     = B.column(e);
            const NodeBlock<dim> block = times<dim>(
              times<dim>(complements[i], B.value(i, e)), complements[j]);
            for (unsigned int c = 0; c < dim; ++c)
              {
                columns.push_back(dof(j, c));
                for (unsigned int r = 0; r < dim; ++r)
                  rows[r].push_back(
                    block[c * dim + r] +
                    (i == j ? scale * nulls[i][c * dim + r] : 0.));
              }
          }
        for (unsigned int r = 0; r < dim; ++r)
          if (columns.empty())
            matrix->set(dof(i, r), dof(i, r), scale);
          else
            matrix->set(dof(i, r), columns, rows[r]);
      }
    matrix->compress(VectorOperation::insert);

    solver.initialize(*matrix);
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
  CoarsestSolver<dim>::solve(double *c, const double *r)
  {
    if (version != level_matrices.coarsest_version())
      set_up();
    std::copy_n(r, rhs.locally_owned_size(), rhs.begin());
    project(rhs);
    solver.solve(solution, rhs);
    project(solution);
    std::copy_n(solution.begin(), solution.locally_owned_size(), c);
  }



  template <int dim>
  void
  CoarsestSolver<dim>::solve_on_face(double                  *c,
                                     const double            *r,
                                     const std::vector<char> &is_fixed)
  {
    if (version != level_matrices.coarsest_version())
      set_up();
    const auto &nulls = level_matrices.coarsest_null_spaces();
    std::copy_n(r, rhs.locally_owned_size(), rhs.begin());
    solver.solve_in_subspace(solution, rhs, [&](VectorType &v) {
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
    std::copy_n(solution.begin(), solution.locally_owned_size(), c);
  }



  template class CoarsestSolver<2>;
  template class CoarsestSolver<3>;
} // namespace Friction

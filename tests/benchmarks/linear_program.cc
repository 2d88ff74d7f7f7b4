// A plain program for linear elasticity in the manner of step-40, as an
// opponent for whole runs: the mesh of a scene, refined at once to the level
// that is asked for, the contact boundary held, prescribed displacements as in
// the scene, which must not have loads, one matrix of Trilinos, and conjugate
// gradients with algebraic multigrid (ML), which gets the rigid motions, to a
// residual of 1e-9. No output, no estimate, no levels before the last.
//
// It uses the library for the scene file and its coarse mesh, and nothing of it
// for the discrete problem.
//
// Usage: benchmark-linear_program 2|3 scene.prm refinements
//
// and after that, if need be, Section/Entry=value.
//
// Prints degrees of freedom, iterations, and seconds by parts.

#include <common/compatibility.h>
#include <common/scene/scene.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <deal.II/numerics/vector_tools.h>

#include <Teuchos_ParameterList.hpp>
#include <ml_MultiLevelPreconditioner.h>

#include <tests/benchmarks/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <string>

namespace benchmark_linear_program
{
  using namespace dealii;
  using namespace Friction;

  using Vector = TrilinosWrappers::MPI::Vector;

  template <int dim>
  void
  run(const Parameters &parameters, const unsigned int refinements)
  {
    const Scene<dim> scene(parameters);
    const MPI_Comm   comm = MPI_COMM_WORLD;
    if (scene.body_force() != nullptr || !scene.traction_conditions().empty() ||
        !scene.pinned_points().empty())
      throw InputError("this program knows prescribed displacements only.");
    Timer      timer;
    const auto lap = [&]() {
      const double seconds = timer.wall_time();
      timer.restart();
      return seconds;
    };

    parallel::distributed::Triangulation<dim> mesh(comm);
    scene.make_coarse_mesh(mesh);
    mesh.refine_global(refinements);
    const MappingQ<dim> mapping(1);
    FESystem<dim>       fe(FE_Q<dim>(1), dim);
    DoFHandler<dim>     dofs(mesh);
    dofs.distribute_dofs(fe);
    const IndexSet &owned    = dofs.locally_owned_dofs();
    const IndexSet  relevant = DoFTools::extract_locally_relevant_dofs(dofs);
    AffineConstraints<double> constraints =
      Compatibility::make_constraints(owned, relevant);
    DoFTools::make_hanging_node_constraints(dofs, constraints);
    for (const auto &condition : scene.dirichlet_conditions())
      VectorTools::interpolate_boundary_values(mapping,
                                               dofs,
                                               condition.boundary_id,
                                               *condition.displacement,
                                               constraints,
                                               condition.components);
    VectorTools::interpolate_boundary_values(
      mapping,
      dofs,
      scene.contact_conditions()[0].boundary_id,
      Functions::ZeroFunction<dim>(dim),
      constraints);
    constraints.close();
    const double mesh_seconds = lap();

    DynamicSparsityPattern pattern(relevant);
    DoFTools::make_sparsity_pattern(dofs, pattern, constraints, false);
    SparsityTools::distribute_sparsity_pattern(pattern, owned, comm, relevant);
    TrilinosWrappers::SparseMatrix matrix;
    matrix.reinit(owned, owned, pattern, comm);
    Vector       rhs(owned, comm), solution(owned, comm);
    const double pattern_seconds = lap();

    const QGauss<dim> quadrature(2);
    FEValues<dim>     fe_values(
      mapping, fe, quadrature, update_gradients | update_JxW_values);
    const unsigned int                   n = fe.n_dofs_per_cell();
    FullMatrix<double>                   cell_matrix(n, n);
    dealii::Vector<double>               cell_rhs(n);
    std::vector<types::global_dof_index> indices(n);
    const double lambda = scene.materials().base().lambda(),
                 mu     = scene.materials().base().mu();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell_matrix = 0.;
          fe_values.reinit(cell);
          for (const unsigned int q : fe_values.quadrature_point_indices())
            for (unsigned int i = 0; i < n; ++i)
              {
                const unsigned int   c = fe.system_to_component_index(i).first;
                const Tensor<1, dim> g_i = fe_values.shape_grad(i, q);
                for (unsigned int j = 0; j < n; ++j)
                  {
                    const unsigned int d =
                      fe.system_to_component_index(j).first;
                    const Tensor<1, dim> g_j = fe_values.shape_grad(j, q);
                    cell_matrix(i, j) +=
                      (lambda * g_i[c] * g_j[d] + mu * g_i[d] * g_j[c] +
                       (c == d ? mu * (g_i * g_j) : 0.)) *
                      fe_values.JxW(q);
                  }
              }
          cell->get_dof_indices(indices);
          constraints.distribute_local_to_global(
            cell_matrix, cell_rhs, indices, matrix, rhs);
        }
    matrix.compress(VectorOperation::add);
    rhs.compress(VectorOperation::add);
    const double assembly_seconds = lap();

    // Translations, and rotations about the axes.
    constexpr unsigned int n_modes = dim * (dim + 1) / 2;
    const std::size_t      n_local = owned.n_elements();
    std::vector<double>    modes(n_modes * n_local, 0.);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int v : cell->vertex_indices())
          {
            const Point<dim> &p = cell->vertex(v);
            std::size_t       at[dim];
            bool              is_owned = true;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const auto dof = cell->vertex_dof_index(v, d);
                is_owned       = is_owned && owned.is_element(dof);
                if (is_owned)
                  at[d] = owned.index_within_set(dof);
              }
            if (!is_owned)
              continue;
            for (unsigned int d = 0; d < dim; ++d)
              modes[d * n_local + at[d]] = 1.;
            unsigned int mode = dim;
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int e = d + 1; e < dim; ++e, ++mode)
                {
                  modes[mode * n_local + at[d]] = -p[e];
                  modes[mode * n_local + at[e]] = p[d];
                }
          }
    Teuchos::ParameterList list;
    ML_Epetra::SetDefaults("SA", list);
    list.set("smoother: type", "Chebyshev");
    list.set("smoother: sweeps", 2);
    list.set("aggregation: type", "Uncoupled");
    list.set("aggregation: threshold", 1e-4);
    list.set("coarse: max size", 2000);
    list.set("null space: type", "pre-computed");
    list.set("null space: dimension", static_cast<int>(n_modes));
    list.set("null space: vectors", modes.data());
    list.set("null space: add default vectors", false);
    list.set("PDE equations", dim);
    list.set("ML output", 0);
    TrilinosWrappers::PreconditionAMG preconditioner;
    preconditioner.initialize(matrix, list);
    const double ml_seconds = lap();

    // In vectors of deal.II, which hold their values themselves: the product of
    // the matrix with one of them is what common/parallel/trilinos_symbols.cc
    // has for Clang, too.
    using OwnVector = LinearAlgebra::distributed::Vector<double>;
    SolverControl       control(1000, 1e-9 * rhs.l2_norm());
    OwnVector           b(owned, comm), x(owned, comm);
    SolverCG<OwnVector> cg(control);
    std::copy(rhs.begin(), rhs.end(), b.begin());
    cg.solve(matrix, x, b, preconditioner);
    std::copy(x.begin(), x.end(), solution.begin());
    constraints.distribute(solution);
    const double cg_seconds = lap();

    if (Utilities::MPI::this_mpi_process(comm) == 0)
      std::printf(
        "%10u dofs  %4u iterations  mesh and dofs %.2f  pattern %.2f  "
        "assembly %.2f  ML %.2f  CG %.2f s\n",
        static_cast<unsigned int>(dofs.n_dofs()),
        control.last_step(),
        mesh_seconds,
        pattern_seconds,
        assembly_seconds,
        ml_seconds,
        cg_seconds);
  }
} // namespace benchmark_linear_program

BENCHMARK(linear_program)
{
  using namespace dealii;
  if (argc < 4)
    {
      std::cerr << "Usage: benchmark-linear_program 2|3 scene.prm refinements "
                   "[Section/Entry=value ...]\n";
      return 2;
    }
  try
    {
      const Friction::Parameters parameters =
        Friction::read_parameters(argv[2], {argv + 4, argv + argc});
      if (std::string(argv[1]) == "2")
        run<2>(parameters, std::stoi(argv[3]));
      else
        run<3>(parameters, std::stoi(argv[3]));
    }
  catch (const Friction::InputError &error)
    {
      std::cerr << error.what() << std::endl;
      return 2;
    }
  return 0;
}

// The solver of the coarsest level by itself, with matrices of elasticity whose
// rows are distributed over all processes there are: one, two or four. A half
// disc and a half ball, held at the top, loaded by a force in all of its
// volume. The number of unknowns is small enough for a factorisation to compare
// with.
//
// - both methods solve, in the whole space and in a subspace,
// - the hierarchy survives small changes of the matrix and not large ones,
// - a matrix with a direction without energy is solved, whichever the method,
// - processes may own no row.

#include <common/compatibility.h>
#include <common/levels/algebraic_solver.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>

#include <deal.II/grid/grid_generator.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <deal.II/numerics/vector_tools.h>

#include <fstream>
#include <string>

#include <tests/support/check.h>
#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;

namespace test_algebraic_solver
{
  // To a file, because algebraic multigrid has things to say about processes
  // without rows.
  std::ofstream output;



  void
  check(const bool good, const std::string &what)
  {
    Tests::check_everywhere(good, what, output);
  }



  template <int dim>
  struct Elasticity
  {
    parallel::distributed::Triangulation<dim> mesh;
    FESystem<dim>                             fe;
    DoFHandler<dim>                           dof_handler;
    TrilinosWrappers::SparseMatrix            matrix;
    VectorType                                rhs;

    Elasticity(const unsigned int n_cells, const bool is_held)
      : mesh(MPI_COMM_WORLD)
      , fe(FE_Q<dim>(1), dim)
      , dof_handler(mesh)
    {
      Point<dim> corner;
      for (unsigned int d = 0; d < dim; ++d)
        corner[d] = 1. + d;
      GridGenerator::subdivided_hyper_rectangle(
        mesh,
        std::vector<unsigned int>(dim, n_cells),
        Point<dim>(),
        corner,
        true);
      dof_handler.distribute_dofs(fe);
      const IndexSet relevant =
        DoFTools::extract_locally_relevant_dofs(dof_handler);
      AffineConstraints<double> constraints = Compatibility::make_constraints(
        dof_handler.locally_owned_dofs(), relevant);
      if (is_held)
        VectorTools::interpolate_boundary_values(
          MappingQ<dim>(1),
          dof_handler,
          1,
          Functions::ZeroFunction<dim>(dim),
          constraints);
      constraints.close();
      DynamicSparsityPattern pattern(relevant);
      DoFTools::make_sparsity_pattern(dof_handler, pattern, constraints);
      matrix.reinit(dof_handler.locally_owned_dofs(),
                    dof_handler.locally_owned_dofs(),
                    pattern,
                    MPI_COMM_WORLD);
      rhs.reinit(dof_handler.locally_owned_dofs(), relevant, MPI_COMM_WORLD);

      const QGauss<dim>                    quadrature(2);
      FEValues<dim>                        fe_values(fe,
                              quadrature,
                              update_values | update_gradients |
                                update_quadrature_points | update_JxW_values);
      const unsigned int                   n = fe.n_dofs_per_cell();
      FullMatrix<double>                   cell_matrix(n, n);
      Vector<double>                       cell_rhs(n);
      std::vector<types::global_dof_index> indices(n);
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell_matrix = 0.;
            cell_rhs    = 0.;
            fe_values.reinit(cell);
            for (const unsigned int q : fe_values.quadrature_point_indices())
              for (unsigned int i = 0; i < n; ++i)
                {
                  const unsigned int ci = fe.system_to_component_index(i).first;
                  const Tensor<1, dim> gi = fe_values.shape_grad(i, q);
                  if (ci == 0)
                    cell_rhs(i) +=
                      std::cos(3. * fe_values.quadrature_point(q)[0]) *
                      fe_values.shape_value(i, q) * fe_values.JxW(q);
                  for (unsigned int j = 0; j < n; ++j)
                    {
                      const unsigned int cj =
                        fe.system_to_component_index(j).first;
                      const Tensor<1, dim> gj = fe_values.shape_grad(j, q);
                      cell_matrix(i, j) +=
                        (gi[ci] * gj[cj] + .5 * gi[cj] * gj[ci] +
                         (ci == cj ? .5 * (gi * gj) : 0.)) *
                        fe_values.JxW(q);
                    }
                }
            cell->get_dof_indices(indices);
            constraints.distribute_local_to_global(
              cell_matrix, cell_rhs, indices, matrix, rhs);
          }
      matrix.compress(VectorOperation::add);
      rhs.compress(VectorOperation::add);
    }
  };



  // The energy norm of A^{-1} b - x relative to that of A^{-1} b.
  double
  error(const TrilinosWrappers::SparseMatrix &matrix,
        const VectorType                     &x,
        const VectorType                     &exact)
  {
    VectorType e(exact), image(exact);
    matrix.vmult(image, exact);
    const double norm = exact * image;
    e -= x;
    matrix.vmult(image, e);
    return std::sqrt((e * image) / norm);
  }



  // Stiffens the fraction of rows by the factor, as if nodes were held.
  void
  stiffen(TrilinosWrappers::SparseMatrix &matrix,
          const unsigned int              one_in,
          const double                    factor)
  {
    for (const auto i : matrix.locally_owned_range_indices())
      if ((i / 2) % one_in == 0)
        matrix.add(i, i, factor * matrix.diag_element(i));
    matrix.compress(VectorOperation::add);
  }



  template <int dim>
  void
  solve(const unsigned int n_cells)
  {
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      output << dim << "D" << std::endl;
    Elasticity<dim> problem(n_cells, true);
    VectorType      exact(problem.rhs), x(problem.rhs);
    VectorType rhs(problem.dof_handler.locally_owned_dofs(), MPI_COMM_WORLD);
    rhs = problem.rhs;
    exact.reinit(rhs);
    x.reinit(rhs);

    AlgebraicSolver direct(CoarsestMethod::direct, dim);
    AlgebraicSolver iterative(CoarsestMethod::algebraic_multigrid, dim);
    direct.initialize(problem.matrix);
    direct.solve(exact, rhs);
    VectorType defect(rhs);
    problem.matrix.vmult(defect, exact);
    defect -= rhs;
    check(defect.l2_norm() < 1e-10 * rhs.l2_norm(), "factorisation");

    iterative.initialize(problem.matrix);
    iterative.solve(x, rhs);
    check(!iterative.is_direct() &&
            error(problem.matrix, x, exact) < 3. * AlgebraicSolver::tolerance,
          "algebraic multigrid");
    check(iterative.n_iterations() > 1 && iterative.n_iterations() < 20,
          "few iterations");

    // A subspace without every 50th unknown.
    const auto project = [&](VectorType &v) {
      unsigned int l = 0;
      for (const auto i : v.locally_owned_elements())
        {
          if (i % 50 == 0)
            v.local_element(l) = 0.;
          ++l;
        }
    };
    for (AlgebraicSolver *solver : {&direct, &iterative})
      {
        solver->solve_in_subspace(x, rhs, project);
        problem.matrix.vmult(defect, x);
        defect -= rhs;
        project(defect);
        VectorType outside(x);
        project(outside);
        outside -= x;
        check(outside.linfty_norm() == 0. &&
                defect.l2_norm() < 3e-2 * rhs.l2_norm(),
              "in a subspace");
      }

    // A few nodes are held, and released again.
    TrilinosWrappers::SparseMatrix changed;
    changed.copy_from(problem.matrix);
    stiffen(changed, 500, 2.);
    const auto solve_changed = [&]() {
      iterative.initialize(changed);
      iterative.solve(x, rhs);
      AlgebraicSolver reference(CoarsestMethod::direct, dim);
      reference.initialize(changed);
      reference.solve(exact, rhs);
      check(error(changed, x, exact) < 3. * AlgebraicSolver::tolerance,
            "a changed matrix");
    };
    solve_changed();
    check(iterative.n_setups() == 1, "hierarchy kept");
    // All of them are, by orders of magnitude: this hierarchy is worn out.
    stiffen(changed, 2, 1e6);
    solve_changed();
    solve_changed();
    check(iterative.n_setups() >= 2, "hierarchy renewed");
    check(iterative.n_iterations() < 20, "few iterations");

    // Nothing at all to do.
    rhs = 0.;
    iterative.solve(x, rhs);
    check(x.linfty_norm() == 0., "zero");
  }



  template <int dim>
  void
  singular(const unsigned int n_cells)
  {
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      output << dim << "D, not held" << std::endl;
    Elasticity<dim> problem(n_cells, false);
    VectorType rhs(problem.dof_handler.locally_owned_dofs(), MPI_COMM_WORLD);
    rhs = problem.rhs;
    // A right hand side without part in the rigid motions: an image.
    VectorType x(rhs), defect(rhs);
    problem.matrix.vmult(x, rhs);
    rhs = x;
    for (const CoarsestMethod method :
         {CoarsestMethod::direct, CoarsestMethod::algebraic_multigrid})
      {
        AlgebraicSolver solver(method, dim);
        solver.initialize(problem.matrix);
        solver.solve(x, rhs);
        problem.matrix.vmult(defect, x);
        defect -= rhs;
        check(defect.l2_norm() < 3e-2 * rhs.l2_norm(),
              method == CoarsestMethod::direct ? "factorisation"
                                               : "algebraic multigrid");
      }
  }



  // Differences of neighbours in a row of nodes: no rounding makes its last
  // pivot anything but zero.
  void
  zero_pivot()
  {
    const MPI_Comm     comm  = MPI_COMM_WORLD;
    const unsigned int n_per = 4,
                       n     = n_per * Utilities::MPI::n_mpi_processes(comm),
                       first = n_per * Utilities::MPI::this_mpi_process(comm);
    IndexSet owned(n);
    owned.add_range(first, first + n_per);
    DynamicSparsityPattern pattern(n, n, owned);
    for (const auto i : owned)
      for (unsigned int j = (i == 0 ? 0 : i - 1);
           j < std::min<unsigned int>(n, i + 2);
           ++j)
        pattern.add(i, j);
    TrilinosWrappers::SparseMatrix matrix;
    matrix.reinit(owned, owned, pattern, comm);
    for (const auto i : owned)
      {
        matrix.set(i, i, i == 0 || i + 1 == n ? 1. : 2.);
        if (i > 0)
          matrix.set(i, i - 1, -1.);
        if (i + 1 < n)
          matrix.set(i, i + 1, -1.);
      }
    matrix.compress(VectorOperation::insert);
    VectorType x(owned, comm), rhs(x), defect(x);
    for (const auto i : owned)
      rhs(i) = i + 1 == n ? 1. - n : 1.;
    if (Utilities::MPI::this_mpi_process(comm) == 0)
      output << "a pivot that is zero" << std::endl;
    AlgebraicSolver solver(CoarsestMethod::direct, 2);
    solver.initialize(matrix);
    for (unsigned int k = 0; k < 2; ++k)
      {
        solver.solve(x, rhs);
        matrix.vmult(defect, x);
        defect -= rhs;
        check(defect.l2_norm() < 1e-4 * rhs.l2_norm(), "solved all the same");
      }
  }



  // One process has all the rows, of a matrix that couples nothing.
  void
  empty_processes()
  {
    const unsigned int n = 3000;
    IndexSet           owned(n);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      owned.add_range(0, n);
    DynamicSparsityPattern pattern(n, n, owned);
    for (const auto i : owned)
      for (unsigned int j = (i < 2 ? i : i - 2);
           j <= std::min<unsigned int>(n - 1, i + 2);
           j += 2)
        pattern.add(i, j);
    TrilinosWrappers::SparseMatrix matrix;
    matrix.reinit(owned, owned, pattern, MPI_COMM_WORLD);
    for (const auto i : owned)
      {
        matrix.set(i, i, 2.);
        if (i >= 2)
          matrix.set(i, i - 2, -1.);
        if (i + 2 < n)
          matrix.set(i, i + 2, -1.);
      }
    matrix.compress(VectorOperation::insert);
    VectorType x(owned, MPI_COMM_WORLD), rhs(x), exact(x);
    rhs = 1.;
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      output << "processes without rows" << std::endl;
    AlgebraicSolver direct(CoarsestMethod::direct, 2);
    AlgebraicSolver iterative(CoarsestMethod::algebraic_multigrid, 2);
    direct.initialize(matrix);
    direct.solve(exact, rhs);
    iterative.initialize(matrix);
    iterative.solve(x, rhs);
    check(error(matrix, x, exact) < 3. * AlgebraicSolver::tolerance,
          "both methods agree");
  }
} // namespace test_algebraic_solver



TEST(algebraic_solver)
{
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    output.open("output");
  solve<2>(50);
  solve<3>(9);
  singular<2>(50);
  singular<3>(9);
  zero_pivot();
  empty_processes();
}

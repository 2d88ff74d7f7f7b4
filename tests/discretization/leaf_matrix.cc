// The assembly by node blocks against the way of step-40: a matrix of Trilinos,
// AffineConstraints::distribute_local_to_global(), and degrees of freedom
// instead of nodes. The matrices of the cells are random, not symmetric between
// the components of two vertices, and so are the forces; many nodes hang.
// Compared are products with a random vector, forces, the diagonal blocks and
// which blocks there are. With several processes contributions cross
// interfaces, and rows of masters of hanging nodes reach nodes that are known
// to no cell of the process.

#include <common/compatibility.h>
#include <common/discretization/discretization.h>
#include <common/discretization/leaf_matrix.h>
#include <common/nodes/leaf_operator.h>

#include <deal.II/base/conditional_ostream.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>

#include <deal.II/grid/grid_generator.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <iostream>
#include <random>

#include <tests/support/check.h>
#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;
using namespace Tests;

namespace test_leaf_matrix
{
  // The same numbers for the same cell, whichever process owns it.
  template <typename Cell>
  std::mt19937
  generator(const Cell &cell)
  {
    std::mt19937 engine(12345);
    for (const unsigned char child :
         cell->id()
           .template to_binary<std::decay_t<decltype(*cell)>::dimension>())
      engine.seed(engine() + 7919u * child);
    return engine;
  }



  template <typename Cell, int dim>
  void
  make_contributions(const Cell                              &cell,
                     CellBlocks<dim>                         &blocks,
                     typename LeafAssembler<dim>::CellForces &forces)
  {
    std::mt19937                           engine = generator(cell);
    std::uniform_real_distribution<double> random(-1., 1.);
    blocks.set_zero();
    for (unsigned int a = 0; a < CellBlocks<dim>::n_vertices; ++a)
      {
        for (unsigned int b = 0; b <= a; ++b)
          for (unsigned int r = 0; r < dim; ++r)
            for (unsigned int c = 0; c < dim; ++c)
              blocks(a, b)[r][c] = random(engine);
        for (unsigned int r = 0; r < dim; ++r)
          {
            for (unsigned int c = 0; c < r; ++c)
              blocks(a, a)[c][r] = blocks(a, a)[r][c];
            forces[a][r] = random(engine);
          }
      }
  }



  template <int dim>
  void
  test(const MPI_Comm comm)
  {
    const bool first = Utilities::MPI::this_mpi_process(comm) == 0;
    const auto mesh  = make_triangulation<dim>(comm);
    GridGenerator::hyper_cube(*mesh);
    mesh->refine_global(dim == 2 ? 3 : 2);
    for (unsigned int step = 0; step < 2; ++step)
      {
        for (const auto &cell : mesh->active_cell_iterators())
          if (cell->is_locally_owned() && generator(cell)() % 4 == 0)
            cell->set_refine_flag();
        mesh->execute_coarsening_and_refinement();
      }

    const FESystem<dim> fe(FE_Q<dim>(1), dim);
    DoFHandler<dim>     dofs(*mesh);
    dofs.distribute_dofs(fe);
    const IndexSet &owned    = dofs.locally_owned_dofs();
    const IndexSet  relevant = DoFTools::extract_locally_relevant_dofs(dofs);
    AffineConstraints<double> hanging =
      Compatibility::make_constraints(owned, relevant);
    DoFTools::make_hanging_node_constraints(dofs, hanging);
    hanging.close();
    const AffineConstraints<double> nothing =
      Compatibility::make_constraints(owned, relevant);

    LeafAssembler<dim>          assembler(dofs, hanging);
    const NodalConstraints<dim> constraints(
      dofs, hanging, nothing, assembler.coupled_dofs());
    VectorType forces(constraints.partitioner());
    assembler.begin(constraints);

    DynamicSparsityPattern pattern(dofs.n_dofs(), dofs.n_dofs(), relevant);
    DoFTools::make_sparsity_pattern(dofs, pattern, hanging, false);
    SparsityTools::distribute_sparsity_pattern(pattern, owned, comm, relevant);
    TrilinosWrappers::SparseMatrix expected;
    expected.reinit(owned, owned, pattern, comm);
    VectorType expected_forces(owned, relevant, comm);

    CellBlocks<dim>                         blocks;
    typename LeafAssembler<dim>::CellForces cell_forces;
    const unsigned int                      n = fe.n_dofs_per_cell();
    FullMatrix<double>                      cell_matrix(n, n);
    Vector<double>                          cell_vector(n);
    std::vector<types::global_dof_index>    indices(n);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          make_contributions(cell, blocks, cell_forces);
          assembler.add(blocks, cell_forces, forces);
          for (unsigned int i = 0; i < n; ++i)
            {
              const auto [c, a] = fe.system_to_component_index(i);
              cell_vector(i)    = cell_forces[a][c];
              for (unsigned int j = 0; j < n; ++j)
                {
                  const auto [d, b] = fe.system_to_component_index(j);
                  cell_matrix(i, j) =
                    a >= b ? blocks(a, b)[c][d] : blocks(b, a)[d][c];
                }
            }
          cell->get_dof_indices(indices);
          hanging.distribute_local_to_global(
            cell_matrix, cell_vector, indices, expected, expected_forces);
        }
    assembler.finish(forces);
    expected.compress(VectorOperation::add);
    expected_forces.compress(VectorOperation::add);
    const LeafOperator<dim> A(std::move(assembler.matrix()), constraints);

    VectorType v(constraints.partitioner()), Av(v);
    VectorType w(owned, comm), Aw(owned, comm);
    for (const auto dof : owned)
      w(dof) = v(dof) =
        hanging.is_constrained(dof) ? 0. : std::sin(1. + 3. * dof);
    A.vmult(Av, v);
    expected.vmult(Aw, w);

    double difference = 0, force_difference = 0, diagonal = 0, largest = 0;
    bool   same_blocks = true;
    unsigned int far   = 0;
    for (const auto dof : owned)
      {
        const unsigned int node = constraints.node_of_dof(dof);
        largest                 = std::max(largest, std::abs(Aw(dof)));
        if (hanging.is_constrained(dof))
          {
            same_blocks = same_blocks &&
              A.blocks().row_begin(node) == A.blocks().row_end(node);
            continue;
          }
        difference       = std::max(difference, std::abs(Av(dof) - Aw(dof)));
        force_difference = std::max(
          force_difference, std::abs(forces(dof) - expected_forces(dof)));
        for (unsigned int c = 0; c < dim; ++c)
          diagonal =
            std::max(diagonal,
                     std::abs(A.diagonal_block(node)[c * dim + dof % dim] -
                              expected.el(dof, dof - dof % dim + c)));
        std::size_t n_columns = 0;
        for (auto entry = pattern.begin(dof); entry != pattern.end(dof);
             ++entry)
          if (entry->column() % dim == 0)
            {
              const auto column = entry->column();
              ++n_columns;
              far += !relevant.is_element(column);
              same_blocks = same_blocks &&
                A.blocks().find(node, constraints.node_of_dof(column)) !=
                  A.blocks().row_end(node);
            }
        same_blocks = same_blocks &&
          n_columns == A.blocks().row_end(node) - A.blocks().row_begin(node);
      }
    // Empty without hanging nodes, or with one process.
    const unsigned int all_far = Utilities::MPI::sum(far, comm);
    largest                    = Utilities::MPI::max(largest, comm);
    if (first)
      std::cout << dim << "D, " << dofs.n_dofs() / dim << " nodes, "
                << (all_far > 0 ? "some" : "no")
                << " couplings reach beyond the cells a process knows"
                << std::endl;
    check_everywhere(hanging.n_constraints() > 0, "nodes hang");
    check_everywhere(difference <= 1e-14 * largest, "products");
    check_everywhere(force_difference <= 1e-14 * largest, "forces");
    check_everywhere(diagonal <= 1e-14 * largest, "diagonal blocks");
    check_everywhere(same_blocks, "the same blocks");
  }
} // namespace test_leaf_matrix

TEST(leaf_matrix)
{
  test<2>(MPI_COMM_WORLD);
  test<3>(MPI_COMM_WORLD);
}

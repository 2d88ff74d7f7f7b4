#include <common/compatibility.h>
#include <common/discretization/discretization.h>
#include <common/discretization/held_body.h>
#include <common/discretization/leaf_matrix.h>
#include <common/discretization/node_numbering.h>
#include <common/parallel/collective_error.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <deal.II/numerics/vector_tools.h>

#include <vector>

namespace Friction
{
  template <int dim>
  std::unique_ptr<parallel::distributed::Triangulation<dim>>
  make_triangulation(const MPI_Comm communicator)
  {
    return std::make_unique<parallel::distributed::Triangulation<dim>>(
      communicator,
      Triangulation<dim>::limit_level_difference_at_vertices,
      parallel::distributed::Triangulation<dim>::construct_multigrid_hierarchy);
  }



  // The element is fixed to Q1, and this is not for convenience: that a
  // correction stays admissible on finer levels needs interpolation weights
  // between zero and one, which higher degrees do not have.
  template <int dim>
  Discretization<dim>::Discretization(const Scene<dim>         &scene,
                                      const Triangulation<dim> &mesh)
    : the_scene(scene)
    , mesh(mesh)
    , the_mapping(1)
    , fe(FE_Q<dim>(1), dim)
    , dofs(mesh)
  {}



  // distribute_dofs() numbers the degrees of freedom of the leaf mesh,
  // distribute_mg_dofs() those of each level. With FESystem(FE_Q(1), dim) those
  // of a vertex get consecutive numbers in either case, and that is all that is
  // needed to speak of nodes. renumber_nodes() then makes nodes that are
  // neighbours neighbours in memory, too.
  template <int dim>
  void
  Discretization<dim>::set_up()
  {
    Timer timer;
    dofs.distribute_dofs(fe);
    dofs.distribute_mg_dofs();
    renumber_nodes(dofs);
    find_constraints();
    contact_boundary = std::make_unique<ContactBoundary<dim>>(
      the_mapping, dofs, hanging, *nodal_constraints, the_scene);
    const FrictionLaw law = the_scene.friction_law();
    discrete_problem =
      std::make_unique<DiscreteProblem<dim>>(DiscreteProblem<dim>{
        leaf_operator,
        forces,
        *nodal_constraints,
        *contact_boundary,
        law,
        law == FrictionLaw::tresca ? 1. : the_scene.friction_coefficient()});
    seconds_of_set_up = timer.wall_time();
  }



  template <int dim>
  void
  Discretization<dim>::find_constraints()
  {
    const IndexSet &owned    = dofs.locally_owned_dofs();
    const IndexSet  relevant = DoFTools::extract_locally_relevant_dofs(dofs);
    hanging                  = Compatibility::make_constraints(owned, relevant);
    DoFTools::make_hanging_node_constraints(dofs, hanging);
    hanging.close();

    // Prescribed displacements are collected by an object of the same class,
    // because interpolate_boundary_values() wants one; it is never used for
    // eliminating anything.
    AffineConstraints<double> prescribed =
      Compatibility::make_constraints(owned, relevant);
    on_all_processes(Compatibility::mpi_communicator(dofs), [&]() {
      for (const auto &condition : the_scene.dirichlet_conditions())
        VectorTools::interpolate_boundary_values(the_mapping,
                                                 dofs,
                                                 condition.boundary_id,
                                                 *condition.displacement,
                                                 prescribed,
                                                 condition.components);
    });

    // Single vertices may be pinned, to keep a body that is only pushed from
    // drifting away: contact can hold it from one side only, and friction does
    // so only where it sticks. Where a boundary condition prescribes the same
    // component already, it takes precedence.
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        the_scene.for_each_pin(
          cell, [&](const PinnedPoint<dim> &pin, const unsigned int v) {
            const auto dof = cell->vertex_dof_index(v, pin.component);
            if (!prescribed.is_constrained(dof))
              {
                prescribed.add_line(dof);
                prescribed.set_inhomogeneity(dof, pin.value);
              }
          });
    prescribed.close();

    // The sparsity pattern knows about hanging nodes but not about prescribed
    // displacements, whose rows and columns are kept. It comes before there is
    // a matrix, because with several processes it says whose displacements a
    // process has to know: all that the rows of its nodes couple to. Usually
    // these are the nodes of its own cells and of their neighbours, the locally
    // relevant ones of step-40. But a row to which a hanging node has been
    // condensed reaches all cells around that node, and one of them may be
    // farther away.
    make_stiffness_pattern(dofs, hanging, pattern);
    nodal_constraints = std::make_unique<NodalConstraints<dim>>(
      dofs, hanging, prescribed, coupled_dofs(dofs, pattern));
  }



  template <int dim>
  void
  Discretization<dim>::assemble(const CellForm<dim> &bilinear_form)
  {
    Timer                          timer;
    TrilinosWrappers::SparseMatrix matrix;
    matrix.reinit(dofs.locally_owned_dofs(),
                  dofs.locally_owned_dofs(),
                  pattern,
                  Compatibility::mpi_communicator(dofs));
    forces.reinit(nodal_constraints->partitioner());

    // For the stiffness, two quadrature points per direction are enough. Given
    // tractions are arbitrary expressions from a scene file and get some more.
    const QGauss<dim>     quadrature(fe.degree + 1);
    const QGauss<dim - 1> face_quadrature(fe.degree + 3);
    FEValues<dim>         fe_values(the_mapping,
                            fe,
                            quadrature,
                            update_values | update_gradients |
                              update_quadrature_points | update_JxW_values);
    FEFaceValues<dim>     face_values(the_mapping,
                                  fe,
                                  face_quadrature,
                                  update_values | update_quadrature_points |
                                    update_JxW_values);

    const unsigned int                   dofs_per_cell = fe.n_dofs_per_cell();
    FullMatrix<double>                   cell_matrix(dofs_per_cell);
    Vector<double>                       cell_forces(dofs_per_cell), load(dim);
    std::vector<types::global_dof_index> indices(dofs_per_cell);
    std::vector<unsigned int>            component(dofs_per_cell);
    for (unsigned int i = 0; i < dofs_per_cell; ++i)
      component[i] = fe.system_to_component_index(i).first;

    // The integral of a load over a cell or a face.
    const auto add_load = [&](const Function<dim>     &function,
                              const FEValuesBase<dim> &values) {
      for (const unsigned int q : values.quadrature_point_indices())
        {
          function.vector_value(values.quadrature_point(q), load);
          for (unsigned int i = 0; i < dofs_per_cell; ++i)
            cell_forces(i) +=
              load[component[i]] * values.shape_value(i, q) * values.JxW(q);
        }
    };

    // A load that is no finite number somewhere is an error of all processes.
    on_all_processes(Compatibility::mpi_communicator(dofs), [&]() {
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell_matrix = 0.;
            cell_forces = 0.;
            fe_values.reinit(cell);
            bilinear_form(fe_values, cell_matrix);
            if (the_scene.body_force() != nullptr)
              add_load(*the_scene.body_force(), fe_values);

            // What the obstacle exerts is not among the loads. It is a
            // reaction, and will be found in Au - f.
            for (const unsigned int f : cell->face_indices())
              if (cell->face(f)->at_boundary())
                for (const auto &condition : the_scene.traction_conditions())
                  if (cell->face(f)->boundary_id() == condition.boundary_id)
                    {
                      face_values.reinit(cell, f);
                      add_load(*condition.traction, face_values);
                    }

            // Hanging nodes are condensed in the matrix and in the loads alike.
            // If prescribed displacements were passed on as well, as in
            // step-40, their rows would now be gone, and with them the
            // reactions at the nodes that are held.
            cell->get_dof_indices(indices);
            hanging.distribute_local_to_global(
              cell_matrix, cell_forces, indices, matrix, forces);
          }
    });
    matrix.compress(VectorOperation::add);
    forces.compress(VectorOperation::add);

    // Trilinos has gathered the contributions of all processes, and has done
    // its part.
    leaf_operator = LeafOperator<dim>(
      make_node_block_matrix<dim>(matrix, pattern, *nodal_constraints),
      *nodal_constraints);
    pattern.reinit(0, 0);
    check_that_body_is_held(*this);
    seconds_of_assembly = timer.wall_time();
  }



  template <int dim>
  void
  Discretization<dim>::interpolate_hanging_nodes(VectorType &v) const
  {
    hanging.distribute(v);
    v.update_ghost_values();
  }



  template std::unique_ptr<parallel::distributed::Triangulation<2>>
  make_triangulation(const MPI_Comm);
  template std::unique_ptr<parallel::distributed::Triangulation<3>>
  make_triangulation(const MPI_Comm);
  template class Discretization<2>;
  template class Discretization<3>;
} // namespace Friction

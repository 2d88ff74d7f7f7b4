#include <common/compatibility.h>
#include <common/discretization/discretization.h>
#include <common/discretization/held_body.h>
#include <common/discretization/leaf_matrix.h>
#include <common/discretization/node_numbering.h>
#include <common/parallel/collective_error.h>
#include <common/parallel/reductions.h>
#include <common/parallel/run_clock.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace Friction
{
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
    Timer          timer;
    const RunScope part(Compatibility::mpi_communicator(mesh), RunPart::dofs);
    previous_displacement.reset();
    dofs.distribute_dofs(fe);
    dofs.distribute_mg_dofs();
    renumber_nodes(dofs, [&](const types::boundary_id id) {
      return the_scene.contact_on(id) != nullptr;
    });
    find_constraints();
    const RunScope part_of_contact(Compatibility::mpi_communicator(mesh),
                                   RunPart::contact);
    contact_boundary = std::make_unique<ContactBoundary<dim>>(
      the_mapping, dofs, hanging, *nodal_constraints, the_scene);
    measure_faces();
    const FrictionLaw law = contact_boundary->friction_law();
    discrete_problem =
      std::make_unique<DiscreteProblem<dim>>(DiscreteProblem<dim>{
        leaf_operator,
        forces,
        *nodal_constraints,
        *contact_boundary,
        face_measures,
        law,
        law == FrictionLaw::tresca ? 1.
                                   : contact_boundary->largest_coefficient()});
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
    // A copy is as large as it has to be: a list that has grown line by line
    // has room for up to twice as many.
    hanging = AffineConstraints<double>(hanging);

    const RunScope                  part(Compatibility::mpi_communicator(mesh),
                        RunPart::contact);
    const AffineConstraints<double> prescribed = find_prescribed_values();

    // What the rows of the matrix couple to, hanging nodes condensed. It comes
    // before there is a matrix, because with several processes it says whose
    // displacements a process has to know.
    {
      const RunScope part_of_assembly(Compatibility::mpi_communicator(mesh),
                                      RunPart::assembly);
      assembler = std::make_unique<LeafAssembler<dim>>(dofs, hanging);
    }
    nodal_constraints = std::make_unique<NodalConstraints<dim>>(
      dofs, hanging, prescribed, assembler->coupled_dofs());
  }



  // Prescribed displacements are collected by an object of the class for
  // constraints, which is never used for eliminating anything. A node that
  // several conditions prescribe has the value of the first one, and the others
  // are not asked. VectorTools::interpolate_boundary_values() would do it for
  // any element, and look for faces again for each condition: in debug mode a
  // fifth of a run in 3D. Where degrees of freedom are values at vertices, once
  // is enough.
  template <int dim>
  AffineConstraints<double>
  Discretization<dim>::find_prescribed_values() const
  {
    AffineConstraints<double> prescribed = Compatibility::make_constraints(
      dofs.locally_owned_dofs(), DoFTools::extract_locally_relevant_dofs(dofs));
    std::vector<typename DoFHandler<dim>::face_iterator> faces;
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial() && cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            faces.push_back(cell->face(f));
    const auto add = [&](const types::global_dof_index dof,
                         const double                  value) {
      prescribed.add_line(dof);
      prescribed.set_inhomogeneity(dof, value);
    };
    const auto prescribe = [&](const DirichletCondition<dim> &condition,
                               const auto                    &face,
                               const unsigned int             v) {
      Vector<double> value(0);
      for (unsigned int d = 0; d < dim; ++d)
        {
          const auto dof = face->vertex_dof_index(v, d);
          if (!condition.components[d] || prescribed.is_constrained(dof))
            continue;
          if (value.size() == 0)
            {
              value.reinit(dim);
              condition.displacement->vector_value(face->vertex(v), value);
            }
          add(dof, value[d]);
        }
    };
    on_all_processes(Compatibility::mpi_communicator(dofs), [&]() {
      for (const auto &condition : the_scene.dirichlet_conditions())
        for (const auto &face : faces)
          if (face->boundary_id() == condition.boundary_id)
            for (unsigned int v = 0; v < face->n_vertices(); ++v)
              prescribe(condition, face, v);
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
              add(dof, pin.value);
          });
    prescribed.close();
    return prescribed;
  }



  template <int dim>
  void
  Discretization<dim>::update_prescribed_values()
  {
    const RunScope part(Compatibility::mpi_communicator(mesh),
                        RunPart::contact);
    nodal_constraints->update_values(find_prescribed_values());
  }



  template <int dim>
  void
  Discretization<dim>::set_slip_origin(const VectorType &displacement)
  {
    auto origin = std::make_unique<VectorType>(vector());
    origin->copy_locally_owned_data_from(displacement);
    interpolate_hanging_nodes(*origin);
    contact_boundary->set_slip_origin(*origin);
    previous_displacement                   = std::move(origin);
    discrete_problem->previous_displacement = previous_displacement.get();
  }



  // A process knows all cells around its own nodes.
  template <int dim>
  void
  Discretization<dim>::measure_faces()
  {
    face_measures.assign(nodal_constraints->n_owned_nodes(), 0.);
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        {
          const double measure =
            std::pow(cell->measure(), double(dim - 1) / dim);
          for (const unsigned int v : cell->vertex_indices())
            {
              const unsigned int node =
                nodal_constraints->node_of_dof(cell->vertex_dof_index(v, 0));
              if (node < face_measures.size())
                face_measures[node] = std::max(face_measures[node], measure);
            }
        }
  }



  // The components of a displacement have the same shape functions, those of
  // the scalar element, and all integrals are by pairs of vertices. That is a
  // good deal less than what FESystem would compute.
  template <int dim>
  void
  Discretization<dim>::assemble(const CellForm<dim> &bilinear_form)
  {
    Assert(assembler != nullptr, ExcMessage("Call set_up() first."));
    Timer          timer;
    const RunScope part(Compatibility::mpi_communicator(mesh),
                        RunPart::assembly);
    forces.reinit(nodal_constraints->partitioner());
    assembler->begin(*nodal_constraints);

    // For the stiffness, two quadrature points per direction are enough. Given
    // tractions are arbitrary expressions from a scene file and get some more.
    const FE_Q<dim>       scalar(1);
    const QGauss<dim>     quadrature(fe.degree + 1);
    const QGauss<dim - 1> face_quadrature(fe.degree + 3);
    FEValues<dim>         fe_values(
      the_mapping,
      scalar,
      quadrature,
      update_gradients | update_quadrature_points | update_JxW_values |
        (the_scene.body_force() != nullptr ? update_values : update_default));
    FEFaceValues<dim> face_values(the_mapping,
                                  scalar,
                                  face_quadrature,
                                  update_values | update_quadrature_points |
                                    update_JxW_values);

    CellBlocks<dim>                         cell_blocks;
    typename LeafAssembler<dim>::CellForces cell_forces;
    Vector<double>                          load(dim);

    // The integral of a load over a cell or a face.
    const auto add_load = [&](const Function<dim>     &function,
                              const FEValuesBase<dim> &values) {
      for (const unsigned int q : values.quadrature_point_indices())
        {
          function.vector_value(values.quadrature_point(q), load);
          for (unsigned int a = 0; a < cell_forces.size(); ++a)
            for (unsigned int c = 0; c < dim; ++c)
              cell_forces[a][c] +=
                load[c] * values.shape_value(a, q) * values.JxW(q);
        }
    };

    // A load that is no finite number somewhere is an error of all processes.
    on_all_processes(Compatibility::mpi_communicator(dofs), [&]() {
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell_blocks.set_zero();
            cell_forces.fill(Tensor<1, dim>());
            fe_values.reinit(cell);
            bilinear_form(fe_values, cell_blocks);
            if (the_scene.body_force() != nullptr)
              add_load(*the_scene.body_force(), fe_values);

            // What the obstacle exerts is not among the loads. It is a
            // reaction, and will be found in Au - f.
            if (cell->at_boundary())
              for (const unsigned int f : cell->face_indices())
                if (cell->at_boundary(f))
                  for (const auto &condition : the_scene.traction_conditions())
                    if (cell->face(f)->boundary_id() == condition.boundary_id)
                      {
                        face_values.reinit(cell, f);
                        add_load(*condition.traction, face_values);
                      }

            // Hanging nodes are condensed in the matrix and in the loads alike.
            // If prescribed displacements were eliminated as well, as in
            // step-40, their rows would now be gone, and with them the
            // reactions at the nodes that are held.
            assembler->add(cell_blocks, cell_forces, forces);
          }
    });
    assembler->finish(forces);
    leaf_operator =
      LeafOperator<dim>(std::move(assembler->matrix()), *nodal_constraints);
    assembler.reset();
    check_that_body_is_held(*this);
    seconds_of_assembly = timer.wall_time();
  }



  template <int dim>
  double
  Discretization<dim>::body_size() const
  {
    std::vector<double> box(2 * dim, -std::numeric_limits<double>::max());
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const unsigned int v : cell->vertex_indices())
          for (unsigned int d = 0; d < dim; ++d)
            {
              box[d]       = std::max(box[d], cell->vertex(v)[d]);
              box[dim + d] = std::max(box[dim + d], -cell->vertex(v)[d]);
            }
    max_over_processes(box, nodal_constraints->communicator());
    double square = 0;
    for (unsigned int d = 0; d < dim; ++d)
      square += std::pow(box[d] + box[dim + d], 2);
    return std::sqrt(square);
  }



  template <int dim>
  double
  Discretization<dim>::largest_stiffness() const
  {
    double largest = 0.;
    for (unsigned int node = 0; node < nodal_constraints->n_owned_nodes();
         ++node)
      if (!nodal_constraints->is_hanging(node))
        largest =
          std::max(largest, trace<dim>(leaf_operator.diagonal_block(node)));
    return max_over_processes(largest, nodal_constraints->communicator());
  }



  template <int dim>
  void
  Discretization<dim>::interpolate_hanging_nodes(VectorType &v) const
  {
    hanging.distribute(v);
    v.update_ghost_values();
  }



  template class Discretization<2>;
  template class Discretization<3>;
} // namespace Friction

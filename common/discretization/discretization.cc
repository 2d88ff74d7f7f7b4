#include <common/compatibility.h>
#include <common/discretization/discretization.h>
#include <common/discretization/volumetric_strain.h>
#include <common/discretization/leaf_matrix.h>
#include <common/discretization/node_numbering.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <deal.II/numerics/vector_tools.h>

#include <algorithm>
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



  template <int dim>
  Discretization<dim>::Discretization(const Scene<dim>         &scene,
                                      const Triangulation<dim> &mesh,
                                      const Stiffening         &stiffening)
    : dof_handler(mesh)
    , mapping(1)
    , fe(FE_Q<dim>(1), dim)
  {
    dof_handler.distribute_dofs(fe);
    dof_handler.distribute_mg_dofs();
    renumber_nodes(dof_handler);
    const IndexSet relevant =
      DoFTools::extract_locally_relevant_dofs(dof_handler);

    hanging = Compatibility::make_constraints(dof_handler.locally_owned_dofs(),
                                              relevant);
    DoFTools::make_hanging_node_constraints(dof_handler, hanging);
    hanging.close();
    AffineConstraints<double> dirichlet = Compatibility::make_constraints(
      dof_handler.locally_owned_dofs(), relevant);
    for (const auto &condition : scene.dirichlet_conditions())
      VectorTools::interpolate_boundary_values(mapping,
                                               dof_handler,
                                               condition.boundary_id,
                                               *condition.displacement,
                                               dirichlet,
                                               condition.components);
    for (const auto &pinned : scene.pinned_points())
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int v : cell->vertex_indices())
            if (cell->vertex(v).distance(pinned.point) <
                1e-8 * cell->diameter())
              {
                const auto dof = cell->vertex_dof_index(v, pinned.component);
                if (!dirichlet.is_constrained(dof))
                  {
                    dirichlet.add_line(dof);
                    dirichlet.set_inhomogeneity(dof, pinned.value);
                  }
              }
    dirichlet.close();

    make_stiffness_pattern(dof_handler, hanging, pattern);
    constraints = std::make_unique<NodalConstraints<dim>>(
      dof_handler, hanging, dirichlet, coupled_dofs(dof_handler, pattern));
    assemble(scene, stiffening);
    contact = std::make_unique<ContactBoundary<dim>>(
      mapping,
      dof_handler,
      hanging,
      *constraints,
      scene.contact_boundary_id(),
      scene.obstacle(),
      scene.contact_normal(),
      scene.ignores_prescribed_penetration());
    hierarchy =
      std::make_unique<LevelHierarchy<dim>>(dof_handler, *constraints, matrix);
    friction_law         = scene.friction_law();
    friction_coefficient = scene.friction_coefficient();
  }



  template <int dim>
  DiscreteProblem<dim>
  Discretization<dim>::problem() const
  {
    return {matrix,
            forces,
            *constraints,
            *contact,
            friction_law,
            friction_coefficient};
  }



  template <int dim>
  VectorType
  Discretization<dim>::admissible_start() const
  {
    VectorType u(constraints->partitioner());
    constraints->impose(u);
    for (const ContactNode<dim> &node : *contact)
      {
        const double excess = normal_component(node, u) - node.gap;
        if (excess > 0)
          for (unsigned int d = 0; d < dim; ++d)
            u.local_element(dim * node.node + d) -= excess * node.normal()[d];
      }
    return u;
  }



  template <int dim>
  ContactState
  Discretization<dim>::no_friction_yet() const
  {
    return ContactState(contact->size(), problem().has_friction());
  }



  template <int dim>
  void
  Discretization<dim>::assemble(const Scene<dim> &scene,
                                const Stiffening &stiffening)
  {
    TrilinosWrappers::SparseMatrix stiffness;
    stiffness.reinit(dof_handler.locally_owned_dofs(),
                     dof_handler.locally_owned_dofs(),
                     pattern,
                     Compatibility::mpi_communicator(dof_handler));
    forces.reinit(constraints->partitioner());

    const QGauss<dim>                    quadrature(2);
    const QGauss<dim - 1>                face_quadrature(4);
    FEValues<dim>                        fe_values(mapping,
                            fe,
                            quadrature,
                            update_gradients | update_values |
                              update_quadrature_points | update_JxW_values);
    FEFaceValues<dim>                    face_values(mapping,
                                  fe,
                                  face_quadrature,
                                  update_values | update_quadrature_points |
                                    update_JxW_values);
    const unsigned int                   n_dofs = fe.n_dofs_per_cell();
    FullMatrix<double>                   cell_matrix(n_dofs, n_dofs);
    Vector<double>                       cell_rhs(n_dofs), value(dim);
    Table<2, double>                     theta;
    std::vector<types::global_dof_index> indices(n_dofs);

    // A shape function at a quadrature point.
    struct Shape
    {
      unsigned int   component;
      Tensor<1, dim> gradient;
      double         theta;
    };
    std::vector<Shape> shapes(n_dofs);
    for (unsigned int i = 0; i < n_dofs; ++i)
      shapes[i].component = fe.system_to_component_index(i).first;
    std::vector<double> sums(n_dofs * n_dofs);

    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          std::fill(sums.begin(), sums.end(), 0.);
          cell_rhs = 0.;
          fe_values.reinit(cell);
          const double factor = stiffening ? stiffening(cell->center()) : 1.;
          const double lambda = factor * scene.material().lambda();
          const double mu     = factor * scene.material().mu();
          shape_volumetric_strains(fe_values, scene.material(), theta);
          for (const unsigned int q : fe_values.quadrature_point_indices())
            {
              // What belongs to one shape function is asked for once, and not
              // for each pair.
              for (unsigned int i = 0; i < n_dofs; ++i)
                {
                  shapes[i].gradient = fe_values.shape_grad(i, q);
                  shapes[i].theta    = theta(i, q);
                }
              const double JxW   = fe_values.JxW(q);
              double      *entry = sums.data();
              for (const Shape &i : shapes)
                for (const Shape &j : shapes)
                  *entry++ +=
                    (lambda * i.theta * j.theta +
                     mu * i.gradient[j.component] * j.gradient[i.component] +
                     (i.component == j.component
                        ? mu * (i.gradient * j.gradient)
                        : 0.)) *
                    JxW;
              if (scene.body_force() != nullptr)
                {
                  scene.body_force()->vector_value(
                    fe_values.quadrature_point(q), value);
                  for (unsigned int i = 0; i < n_dofs; ++i)
                    cell_rhs(i) +=
                      value[fe.system_to_component_index(i).first] *
                      fe_values.shape_value(i, q) * fe_values.JxW(q);
                }
            }
          for (unsigned int i = 0; i < n_dofs; ++i)
            for (unsigned int j = 0; j < n_dofs; ++j)
              cell_matrix(i, j) = sums[i * n_dofs + j];
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary())
              for (const auto &condition : scene.traction_conditions())
                if (condition.boundary_id == cell->face(f)->boundary_id())
                  {
                    face_values.reinit(cell, f);
                    for (const unsigned int q :
                         face_values.quadrature_point_indices())
                      {
                        condition.traction->vector_value(
                          face_values.quadrature_point(q), value);
                        for (unsigned int i = 0; i < n_dofs; ++i)
                          cell_rhs(i) +=
                            value[fe.system_to_component_index(i).first] *
                            face_values.shape_value(i, q) * face_values.JxW(q);
                      }
                  }
          cell->get_dof_indices(indices);
          hanging.distribute_local_to_global(
            cell_matrix, cell_rhs, indices, stiffness, forces);
        }
    stiffness.compress(VectorOperation::add);
    forces.compress(VectorOperation::add);
    matrix = make_node_block_matrix<dim>(stiffness, pattern, *constraints);
  }



  template std::unique_ptr<parallel::distributed::Triangulation<2>>
  make_triangulation(const MPI_Comm);
  template std::unique_ptr<parallel::distributed::Triangulation<3>>
  make_triangulation(const MPI_Comm);
  template class Discretization<2>;
  template class Discretization<3>;
} // namespace Friction

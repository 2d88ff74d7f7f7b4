#include <common/compatibility.h>
#include <common/estimate/contact_estimate.h>

#include <deal.II/base/mpi.h>

namespace Friction
{
  template <int dim>
  ErrorEstimate
  estimate_contact_error(const Scene<dim>                &scene,
                         const Mapping<dim>              &mapping,
                         const DoFHandler<dim>           &dof_handler,
                         const AffineConstraints<double> &hanging,
                         const NodalConstraints<dim>     &constraints,
                         const ContactBoundary<dim>      &contact_boundary,
                         const VectorType                &displacement,
                         const VectorType                &tractions)
  {
    EstimatorProblem<dim> problem;
    problem.lambda               = scene.material().lambda();
    problem.mu                   = scene.material().mu();
    problem.volumetric_strain    = scene.material().volumetric_strain();
    problem.body_force           = scene.body_force().get();
    problem.contact_boundary     = scene.contact_boundary_id();
    problem.friction_coefficient = scene.friction_coefficient();
    for (const auto &condition : scene.traction_conditions())
      problem.tractions[condition.boundary_id] = condition.traction.get();
    for (const auto &condition : scene.dirichlet_conditions())
      problem.dirichlet[condition.boundary_id] = condition.components;

    VectorType normal(constraints.partitioner());
    VectorType gap_vector(constraints.partitioner());
    for (const ContactNode<dim> &node : contact_boundary)
      for (unsigned int d = 0; d < dim; ++d)
        {
          normal.local_element(dim * node.node + d) = node.normal()[d];
          gap_vector.local_element(dim * node.node + d) =
            node.gap * node.normal()[d];
        }
    for (VectorType *vector : {&normal, &gap_vector})
      {
        hanging.distribute(*vector);
        vector->update_ghost_values();
      }

    EstimatorContact contact;
    contact.traction   = &tractions;
    contact.normal     = &normal;
    contact.gap_vector = &gap_vector;
    return estimate_error(mapping, dof_handler, problem, displacement, contact);
  }



  template <int dim>
  bool
  mark_contact_zone(const DoFHandler<dim>       &dof_handler,
                    const NodalConstraints<dim> &constraints,
                    const ContactBoundary<dim>  &contact_boundary,
                    const ContactState          &state)
  {
    // Each process knows what its own nodes do, but its cells have vertices
    // that belong to others.
    VectorType touches(constraints.partitioner());
    for (unsigned int p = 0; p < contact_boundary.size(); ++p)
      touches.local_element(dim * contact_boundary[p].node) =
        state.in_contact(p) ? 1. : 0.;
    touches.update_ghost_values();

    bool any_marked = false;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const unsigned int v : cell->vertex_indices())
          if (touches(cell->vertex_dof_index(v, 0)) > 0.)
            {
              cell->set_refine_flag();
              any_marked = true;
            }
    return Utilities::MPI::max(any_marked ? 1 : 0,
                               Compatibility::mpi_communicator(dof_handler)) >
      0;
  }


  template ErrorEstimate
                estimate_contact_error(const Scene<2> &,
                                       const Mapping<2> &,
                                       const DoFHandler<2> &,
                                       const AffineConstraints<double> &,
                                       const NodalConstraints<2> &,
                                       const ContactBoundary<2> &,
                                       const VectorType &,
                                       const VectorType &);
  template bool mark_contact_zone(const DoFHandler<2> &,
                                  const NodalConstraints<2> &,
                                  const ContactBoundary<2> &,
                                  const ContactState &);
  template ErrorEstimate
                estimate_contact_error(const Scene<3> &,
                                       const Mapping<3> &,
                                       const DoFHandler<3> &,
                                       const AffineConstraints<double> &,
                                       const NodalConstraints<3> &,
                                       const ContactBoundary<3> &,
                                       const VectorType &,
                                       const VectorType &);
  template bool mark_contact_zone(const DoFHandler<3> &,
                                  const NodalConstraints<3> &,
                                  const ContactBoundary<3> &,
                                  const ContactState &);
} // namespace Friction

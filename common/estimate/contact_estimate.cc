#include <common/estimate/contact_estimate.h>
#include <common/parallel/run_clock.h>

namespace Friction
{
  template <int dim>
  ErrorEstimate
  estimate_contact_error(const Discretization<dim> &discretization,
                         const VectorType          &displacement,
                         const VectorType          &tractions)
  {
    const RunScope        part(discretization.constraints().communicator(),
                        RunPart::estimate);
    const Scene<dim>     &scene = discretization.scene();
    EstimatorProblem<dim> problem(scene.materials());
    problem.body_force = scene.body_force().get();
    for (const ContactCondition<dim> &condition : scene.contact_conditions())
      if (condition.has_boundary())
        problem.contact[condition.boundary_id] = {
          condition.friction_coefficient, condition.varying_coefficient.get()};
    for (const auto &condition : scene.traction_conditions())
      problem.tractions[condition.boundary_id] = condition.traction.get();
    for (const auto &condition : scene.dirichlet_conditions())
      problem.dirichlet[condition.boundary_id] = condition.components;

    VectorType normal(discretization.vector()), gap_vector(normal);
    for (const ContactNode<dim> &node : discretization.contact())
      for (unsigned int d = 0; d < dim; ++d)
        {
          normal.local_element(dim * node.node + d) = node.normal()[d];
          gap_vector.local_element(dim * node.node + d) =
            node.gap * node.normal()[d];
        }
    for (VectorType *vector : {&normal, &gap_vector})
      discretization.interpolate_hanging_nodes(*vector);

    EstimatorContact contact;
    contact.traction    = &tractions;
    contact.normal      = &normal;
    contact.gap_vector  = &gap_vector;
    contact.slip_origin = discretization.slip_origin();
    return estimate_error(discretization.mapping(),
                          discretization.dof_handler(),
                          problem,
                          displacement,
                          contact);
  }



  template ErrorEstimate estimate_contact_error(const Discretization<2> &,
                                                const VectorType &,
                                                const VectorType &);
  template ErrorEstimate estimate_contact_error(const Discretization<3> &,
                                                const VectorType &,
                                                const VectorType &);
} // namespace Friction

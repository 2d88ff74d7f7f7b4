#ifndef friction_contact_contact_forces_h
#define friction_contact_contact_forces_h

#include <common/contact/contact_state.h>
#include <common/discretization/contact_boundary.h>

namespace Friction
{
  /**
   * The force of the obstacle on the body at a contact node, from the residual
   * f - A u. In a direction in which the displacement is prescribed the
   * residual is the reaction of whatever holds the node there, and no contact
   * force.
   */
  template <int dim>
  Tensor<1, dim> contact_force(const ContactNode<dim> &p,
                               const VectorType       &residual);

  /** What is left of a force on the body at a contact node without its part
   * along the normal: friction. */
  template <int dim>
  Tensor<1, dim>
  tangential_part(const ContactNode<dim> &p, const Tensor<1, dim> &force)
  {
    return force - (force * p.normal()) * p.normal();
  }

  /** Sets the normal forces of the friction bounds to those of the displacement
   * with this residual f - A u, at nodes in contact, and to zero elsewhere; but
   * not where a bound is given. */
  template <int dim>
  void set_normal_forces(const ContactBoundary<dim> &contact,
                         const VectorType           &residual,
                         ContactState               &state);

  /**
   * Nodal contact forces turned into a field of stresses on the contact
   * boundary, for interpolation to another mesh, for the error estimator and
   * for output: force on the body over nodal measure at the nodes that are in
   * contact and, where the bound of friction is given, at open nodes with a
   * positive one, zero at all others.
   *
   * @param residual  f - A u, in whose layout the result is.
   */
  template <int dim>
  VectorType contact_tractions(const ContactBoundary<dim> &contact,
                               const VectorType           &residual,
                               const ContactState         &state);
} // namespace Friction

#endif

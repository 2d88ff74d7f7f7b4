#ifndef friction_algorithms_initial_guess_h
#define friction_algorithms_initial_guess_h

#include <common/discretization/contact_boundary.h>
#include <common/contact/contact_state.h>

namespace Friction
{
  /**
   * Nodal contact forces turned into a field of stresses on the contact
   * boundary, for interpolation to another mesh, for the error estimator and
   * for output: force on the body over nodal measure at the nodes that are in
   * contact, zero at all other nodes.
   *
   * @param residual  f - A u.
   */
  template <int dim>
  VectorType contact_tractions(const VectorType            &residual,
                               const NodalConstraints<dim> &constraints,
                               const ContactBoundary<dim>  &contact,
                               const ContactState          &state);

  /**
   * Adds a constant of at least twice the largest value to @p v and returns it.
   * In debug mode SolutionTransfer demands that neighbouring cells interpolate
   * the same values, relative to these; where values are nothing but rounding,
   * as those that vanish by symmetry are, they do not. The constant is a power
   * of two, so that it can be taken off again without leaving a trace: zeros
   * stay zeros.
   */
  double lift_above_rounding(VectorType &v);

  /**
   * Makes an initial guess out of a displacement and tractions interpolated
   * from a coarser mesh (or of zeros): imposes prescribed values, moves nodes
   * out of the obstacle, and turns normal tractions back into nodal normal
   * forces.
   *
   * Stresses, not forces, are what can be interpolated: forces shrink with the
   * size of the cells.
   */
  template <int dim>
  ContactState make_initial_guess(VectorType                  &u,
                                  const VectorType            &tractions,
                                  const NodalConstraints<dim> &constraints,
                                  const ContactBoundary<dim>  &contact,
                                  const bool                   with_friction);
} // namespace Friction

#endif

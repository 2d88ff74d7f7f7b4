#ifndef friction_contact_certificate_h
#define friction_contact_certificate_h

#include <common/discretization/contact_boundary.h>
#include <common/contact/contact_state.h>

#include <string>

namespace Friction
{
  /**
   * By how much a displacement violates the discrete law of contact and
   * friction, node by node. Forces are divided by the largest nodal force
   * anywhere, lengths by the largest displacement or gap at a contact node; all
   * numbers are zero for an exact solution.
   *
   * The size of an increment says little about the error when a method stalls;
   * this does.
   */
  struct Certificate
  {
    double equilibrium     = 0; ///< force at nodes and in directions left free
    double penetration     = 0; ///< $(u_n-g)_+$
    double tension         = 0; ///< $(R_n)_+$, a force that pulls
    double complementarity = 0; ///< force at a distance, $\min(-R_n, g-u_n)$
    double cone            = 0; ///< $(|R_T|-F\tau)_+$
    double slip            = 0; ///< $|R_T+F\tau u_T/|u_T||$, where it slides

    /** The largest of all. */
    double largest() const;

    /** All values with their names, for a message. */
    std::string describe() const;
  };

  /**
   * Evaluates the certificate from scratch: of the state, only the normal
   * forces given for Tresca friction are used.
   *
   * @param residual  f - A u, at all nodes.
   * @param coulomb   the bound is F times the normal force of @p u itself;
   *                  otherwise F times that of the state.
   * @param force_of_rounding  forces are not divided by less than this, so that
   *                  a body that merely moves, without any force but those of
   *                  rounding, is in equilibrium.
   */
  template <int dim>
  Certificate make_certificate(const VectorType            &u,
                               const VectorType            &residual,
                               const NodalConstraints<dim> &constraints,
                               const ContactBoundary<dim>  &contact,
                               const ContactState          &state,
                               const double friction_coefficient,
                               const bool   coulomb,
                               const double force_of_rounding = 0.);
} // namespace Friction

#endif

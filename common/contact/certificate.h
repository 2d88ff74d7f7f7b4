#ifndef friction_contact_certificate_h
#define friction_contact_certificate_h

#include <common/discretization/discrete_problem.h>
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
   * Evaluates the certificate from scratch: with Coulomb's law the bound is F
   * times the normal force of @p u itself, and nothing of the state is used;
   * otherwise it is F times the given normal force of the state.
   *
   * Forces are divided by no less than force_of_rounding(), so that a body that
   * merely moves, without any force but those of rounding, is in equilibrium.
   * Collective.
   *
   * @param residual  f - A u, at all nodes.
   */
  template <int dim>
  Certificate make_certificate(const DiscreteProblem<dim> &problem,
                               const VectorType           &u,
                               const VectorType           &residual,
                               const ContactState         &state);

  /**
   * The largest force that the displacement of a single node would cause,
   * reduced to what is left of it where rounding errors are all there is.
   * Collective.
   */
  template <int dim>
  double force_of_rounding(const DiscreteProblem<dim> &problem,
                           const VectorType           &u);
} // namespace Friction

#endif

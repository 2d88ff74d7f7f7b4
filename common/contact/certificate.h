#ifndef friction_contact_certificate_h
#define friction_contact_certificate_h

#include <common/contact/contact_state.h>
#include <common/discretization/discrete_problem.h>

#include <string>

namespace Friction
{
  /**
   * By how much a displacement violates the discrete law of contact and
   * friction, node by node. All numbers are zero for an exact solution. The
   * size of an increment says little about the error when a method stalls; this
   * does.
   *
   * A force at a node is divided by that of the peak contact pressure there,
   * $m_p\,p_{\max}$, see PeakPressure, so that 1e-6 means a millionth of the
   * peak pressure on whatever mesh, in whatever units, and however large forces
   * are at the other end of the body. At nodes off the contact boundary a face
   * of the size of the cells takes the place of $m_p$, and where the body bears
   * more than that pressure the stress there takes its place.
   *
   * A length that takes part in an alternative, a distance from the obstacle
   * or a slip, counts as the force that the node itself needs for it,
   * $e^Ta(p)\,e$ times the length, with the diagonal block $a(p)$ of the
   * stiffness and the direction $e$ of the length. So the smaller one of a
   * force and a length is the force that is wrong, as relaxation of this node
   * would find it. A length alone, a depth, or the slip of a node that is said
   * to stick, is a matter of all of the contact zone, which for its size is
   * less stiff than a node: by a factor $(m_p/m_C)^{1/(d-1)}$, with the measure
   * $m_C$ of all nodes in contact. So it is by how much pressures are wrong if
   * all nodes are as deep.
   */
  struct Certificate
  {
    double equilibrium     = 0; ///< force at nodes and in directions left free
    double penetration     = 0; ///< $(u_n-g)_+$
    double tension         = 0; ///< $(R_n)_+$, a force that pulls
    double complementarity = 0; ///< force at a distance, $\min(-R_n, g-u_n)$
    double cone            = 0; ///< $(|R_T|-F\tau)_+$
    double slip            = 0; ///< $\min(|R_T+F\tau u_T/|u_T||, |u_T|)$

    /// What is not as the state of a node says: force where it is open,
    /// distance where it touches, slip where it sticks, and less friction than
    /// there can be where it slides.
    double state = 0;

    /** The largest of all. */
    double largest() const;

    /** All values with their names, for a message. */
    std::string describe() const;
  };

  /**
   * Evaluates the certificate from scratch: with Coulomb's law the bound is F
   * times the normal force of @p u itself, otherwise F times the given normal
   * force of the state. Collective.
   *
   * @param residual  f - A u, at all nodes.
   */
  template <int dim>
  Certificate make_certificate(const DiscreteProblem<dim> &problem,
                               const VectorType           &u,
                               const VectorType           &residual,
                               const ContactState         &state);
} // namespace Friction

#endif

#ifndef friction_contact_semismooth_law_h
#define friction_contact_semismooth_law_h

#include <common/contact/contact_state.h>
#include <common/discretization/discrete_problem.h>

#include <array>
#include <vector>

namespace Friction
{
  /**
   * The law of contact and friction at a node as equations that have a
   * derivative nearly everywhere (Alart and Curnier 1991). With the force of
   * the body on the obstacle $r=(f-Au)(p)$, the slip $v_T=u_T-s$ and any
   * stiffness $c>0$ they are
   * @f[ r_n=\hat\tau,\quad \hat\tau=\max(0,\,r_n+c(u_n-g)), @f]
   * @f[ r_T=\Pi_{F\hat\tau}(z),\quad z=r_T+c\,v_T, @f]
   * where $\Pi_b$ projects onto the ball of radius b. The bound of friction
   * $F\hat\tau$ is not one that is given, or was right a step ago, as it is in
   * Linearization: these equations know how it changes with the displacement.
   *
   * Linearised, with $w=A\,\delta u$, they say of the step $\delta u$
   * - where $\hat\tau=0$: $w=r$, in all directions;
   * - in contact: $\delta u_n=g-u_n$;
   * - where $|z|\le F\hat\tau$, sticking: $\delta u_T=-v_T$;
   * - otherwise, sliding in the direction $e=z/|z|$, with $P=I-ee^T$ and
   *   $\omega=c\,F\hat\tau/(|z|-F\hat\tau)$:
   *   $w_T-F\,e\,w_n+\omega P\,\delta u_T=b$ with
   *   $b=r_T-F\,e\,r_n+\omega P\,r_T/c$.
   *
   * The term with $w_n$ is the only one that is not symmetric. In two
   * dimensions P vanishes, so that a step is exact once phases and directions
   * are. Where a bound is given (Tresca), the term vanishes, and friction does
   * not ask whether there is contact.
   *
   * A step with all these terms is one of the semismooth* Newton method
   * (Gfrerer and others 2023), see doc/method.md, section 8.
   *
   * All components are those in the frame of the node, tangential ones only as
   * far as they are free.
   */
  template <int dim>
  struct SemismoothLaw
  {
    enum class Tangent
    {
      free, ///< no friction
      sticks,
      slides
    };

    bool    in_contact = false;
    Tangent tangent    = Tangent::free;

    /// By how much the law is violated, as forces: $r_n-\hat\tau$ and
    /// $r_T-\Pi_{F\hat\tau}(z)$.
    std::array<double, dim> violation{};

    /// The part of the step that is known: normal where it touches, tangential
    /// where it sticks.
    std::array<double, dim> known_step{};

    /// Where it slides: e; $F\,e$, zero if the bound is given; $\omega P$, by
    /// columns; and the right hand side.
    std::array<double, dim - 1>               direction{};
    std::array<double, dim - 1>               slope{};
    std::array<double, (dim - 1) * (dim - 1)> curvature{};
    std::array<double, dim - 1>               rhs{};
  };



  /** What the law at a node has as its own. */
  struct LawAtNode
  {
    double stiffness;          ///< c, a force over a length
    double given_normal_force; ///< where the bound is given
  };

  /** Linearises the law at a node. */
  template <int dim>
  SemismoothLaw<dim> linearize_law(const DiscreteProblem<dim> &problem,
                                   const ContactNode<dim>     &node,
                                   const LawAtNode            &at_node,
                                   const VectorType           &u,
                                   const VectorType           &residual);

  /**
   * The same for an initial guess, the residual of which means nothing: an
   * interpolated displacement is not smooth between the nodes of the coarser
   * mesh. Phases, normal forces and directions are those that the guess has.
   */
  template <int dim>
  SemismoothLaw<dim> linearize_law_of_guess(const DiscreteProblem<dim> &problem,
                                            const unsigned int          p,
                                            const ContactState         &state,
                                            const VectorType           &u,
                                            const VectorType &residual);

  /**
   * Stiffnesses c for all contact nodes of this process: three times that
   * against a motion of all nodes in contact together, per node. With the
   * diagonal of the matrix, the stiffness against the motion of one node alone,
   * which is as much larger as the zone is wider than a cell, nodes at the
   * border of the sticking zone keep changing from slip one way to slip the
   * other way. Collective.
   */
  template <int dim>
  std::vector<double> stiffnesses_of_zone(const DiscreteProblem<dim> &problem,
                                          const ContactState         &state);
} // namespace Friction

#endif

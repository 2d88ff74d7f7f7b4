#ifndef friction_tests_benchmarks_coulomb_law_h
#define friction_tests_benchmarks_coulomb_law_h

#include <common/contact/contact_state.h>

#include <tests/benchmarks/baselines/rotated_problem.h>

#include <array>

namespace Benchmark
{
  using namespace Friction;

  enum class Phase
  {
    open,
    stick,
    slip
  };

  /**
   * The law of contact and Coulomb friction at a node as an equation that is
   * not smooth but semismooth (Alart and Curnier 1991): with the force of the
   * body on the obstacle r = f - A u and any stiffness c > 0,
   * @f[ r_n = \max(0, r_n + c(u_n-g)), \qquad
   *     r_T = P_{F\hat\tau}(r_T + c\,u_T), \quad
   *     \hat\tau = \max(0, r_n + c(u_n-g)), @f]
   * where $P_s$ projects onto the ball of radius s. What is kept here is one
   * linearisation of it. With z = r_T + c u_T it is, for the increment v of the
   * displacement and w = A v,
   * - open ($\hat\tau=0$): w = r, in all directions;
   * - contact: $v_n = g - u_n$;
   * - stick ($|z|\le F\hat\tau$): $v_T = -u_T$;
   * - slip, with $\hat z=z/|z|$ and $P = I - \hat z\hat z^T$, after division by
   *   the derivative with respect to the force,
   *   @f[ w_T - F \hat z\,w_n + \omega P v_T = r_T - F\hat z\, r_n
   *       + \omega P r_T / c,
   *       \qquad \omega = \frac{F\hat\tau}{|z|-F\hat\tau}\, c. @f]
   *
   * The bound is not lagged: it is the term with $w_n$, the only one that is
   * not symmetric. In two dimensions P vanishes, and the solution is exact as
   * soon as the phases and directions are.
   */
  template <int dim>
  struct LinearizedLaw
  {
    Phase phase = Phase::open;

    /// v_n where in contact.
    double normal_step = 0;

    /// v_T where it sticks.
    std::array<double, dim - 1> tangential_step{};

    /// $F\hat z$, $\omega P$ row by row, and the right hand side, where it
    /// slips; without friction just the latter.
    std::array<double, dim - 1>               slope{};
    std::array<double, (dim - 1) * (dim - 1)> second{};
    std::array<double, dim - 1>               rhs{};

    /// How far the law is from being fulfilled, as a force.
    double violation = 0;
  };

  /**
   * Linearises at a node with displacement @p u and force @p r = f - A u, both
   * in its frame.
   * @param F  coefficient of friction.
   * @param given_bound  if not negative, the bound of friction is lagged after
   *           all: it is this, and the linearisation is symmetric.
   */
  template <int dim>
  LinearizedLaw<dim> linearize(const ContactNode<dim> &node,
                               const double            F,
                               const double            stiffness,
                               const double           *u,
                               const double           *r,
                               const double            given_bound = -1.);

  /**
   * The same from an initial guess, the residual of which knows nothing: an
   * interpolated displacement is not smooth between the nodes of the coarser
   * mesh. Phases and bounds are those of the guess.
   */
  template <int dim>
  LinearizedLaw<dim> linearize_guess(const ContactNode<dim> &node,
                                     const double            F,
                                     const bool              in_contact,
                                     const double            normal_force,
                                     const double           *u,
                                     const double           *r);

  /**
   * Stiffnesses c for the linearisation, one per contact node: what resists a
   * motion of the contact zone as a whole, per node. That is far less than the
   * diagonal of the matrix, the stiffness against the motion of one node alone,
   * with which nodes at the border of the sticking zone keep changing from
   * slip one way to slip the other way, and Newton's method takes a step per
   * node. If h is the distance of nodes and L the size of the zone, a smooth
   * motion has h/L times the stiffness of a rough one. Three times that is
   * about the best in all scenes; a tenth of it costs a few steps more, and ten
   * times as much, the diagonal again.
   * @param in_zone  which contact nodes make up the zone.
   */
  template <int dim>
  std::vector<double> contact_stiffness(const RotatedProblem<dim> &rotated,
                                        const std::vector<char>   &in_zone);

  /** Sets the flags and normal forces of a state from the phases and the normal
   * components of f - A u at the contact nodes. */
  template <int dim>
  void set_state(ContactState                          &state,
                 const std::vector<LinearizedLaw<dim>> &laws,
                 const std::vector<double>             &normal_forces);
} // namespace Benchmark

#endif

#ifndef friction_iteration_tresca_functional_h
#define friction_iteration_tresca_functional_h

#include <common/contact/contact_state.h>
#include <common/discretization/discrete_problem.h>
#include <common/iteration/iterate.h>

namespace Friction
{
  /**
   * The energy of the contact problem with given friction bounds (6.8).
   * @f[ \hat J(u) = \tfrac12 u^T A u - f^T u + \sum_p F\tau(p)\,|u_T(p)| @f]
   * over $u_n(p)\le g(p)$, and its exact minimisation along a line. All parts
   * of the solver that speak of energy mean this one, evaluated here.
   */
  template <int dim>
  class TrescaFunctional
  {
  public:
    /** @p problem is kept by reference. */
    explicit TrescaFunctional(const DiscreteProblem<dim> &problem);
    TrescaFunctional(DiscreteProblem<dim> &&) = delete;

    const DiscreteProblem<dim> &
    discrete_problem() const
    {
      return problem;
    }

    /** The energy. Costs a product with the stiffness matrix. Collective. */
    double energy(const VectorType &u, const ContactState &state) const;

    /** The energy, given the residual r = f - A u. Collective. */
    double energy(const VectorType   &u,
                  const VectorType   &r,
                  const ContactState &state) const;

    /** This process' share of it. */
    double energy_share(const VectorType   &u,
                        const VectorType   &r,
                        const ContactState &state) const;

    /** The largest $u_n - g$ over all contact nodes; admissible if not
     * positive. Collective. */
    double largest_penetration(const VectorType &u) const;

    /**
     * Changes @p v such that u + length v does not penetrate the obstacle.
     * Returns the number of this process' nodes where it had to.
     */
    unsigned int
    project(VectorType &v, const VectorType &u, const double length) const;

    /**
     * The contact nodes of this process that slide, and which v would have slip
     * back beyond the line through $u_T=0$ perpendicular to their slip:
     * $(u+v)_T\cdot u_T<0$.
     */
    std::vector<unsigned int> reversing_nodes(const VectorType   &v,
                                              const VectorType   &u,
                                              const ContactState &state) const;

    /** Changes @p v such that contact nodes, which would reverse their slip,
     * come to rest on that line. Prescribed components stay as they are. */
    void stop(VectorType                      &v,
              const VectorType                &u,
              const std::vector<unsigned int> &contact_nodes) const;

    /** Does so with all nodes that would, and returns how many of this process
     * they are. */
    unsigned int keep_slip(VectorType         &v,
                           const VectorType   &u,
                           const ContactState &state) const;

    /**
     * The exact minimiser of $\hat J(u+\alpha v)$, u the iterate @p x, over
     * $0\le\alpha\le$ @p largest, the obstacle being disregarded. The energy is
     * convex along the line and smooth but for the points where a node comes to
     * rest, so that regula falsi on the derivative, safeguarded by bisection,
     * finds it. Several points are tried at a time, since with several
     * processes each trial is a reduction. Collective.
     *
     * @param slope      $(f - A u)\cdot v$, the decrease of the quadratic part.
     * @param curvature  $v^T A v$.
     */
    double minimize_along(const VectorType &v,
                          const Iterate    &x,
                          const double      slope,
                          const double      curvature,
                          const double      largest) const;

    /** The largest factor, at most @p largest, by which @p v may be scaled so
     * that u + v does not penetrate; @p largest if nothing up to it does.
     * Collective. */
    double admissible_length(const VectorType &v,
                             const VectorType &u,
                             const double      largest) const;

  private:
    const DiscreteProblem<dim> &problem;
  };
} // namespace Friction

#endif

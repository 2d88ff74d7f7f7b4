#ifndef friction_iteration_linearization_h
#define friction_iteration_linearization_h

#include <common/discretization/discrete_problem.h>
#include <common/iteration/contact_truncation.h>
#include <common/iteration/iterate.h>
#include <common/parameters/solver_settings.h>

namespace Friction
{
  /**
   * The constrained Newton linearisation at a smoothed iterate: the phases of
   * the contact nodes turned into free subspaces $T_p$, and the derivatives of
   * friction on them.
   *
   * <table>
   * <tr><th>phase</th><th>free subspace</th></tr>
   * <tr><td>open</td><td>everything</td></tr>
   * <tr><td>open, but held tangentially by given friction</td>
   *     <td>normal direction</td></tr>
   * <tr><td>sliding in contact</td><td>tangential plane</td></tr>
   * <tr><td>sticking in contact</td><td>nothing</td></tr>
   * </table>
   * With TruncationVariant::contact nothing is free at any node in contact.
   *
   * In two dimensions $\omega''=0$, since the length of the slip $z$ is
   * piecewise linear. In three the boundary of the friction cone is curved:
   * turning the direction of slip costs energy, and
   * @f[ \omega''_p = \frac{F\tau(p)}{|z|}
   *     \left(I - \frac{z z^T}{|z|^2}\right) @f]
   * is a matrix of rank one, whose only direction is the tangent perpendicular
   * to the slip. It grows without bound as the slip goes to zero and is cut off
   * where it exceeds the stiffness of the node, the mean diagonal entry of its
   * block, by eight orders of magnitude; nothing turns there any more, and
   * larger numbers would only cost digits.
   *
   * Level matrices have to be computed anew wherever $\omega''_p$ changes, and
   * in principle it changes always and everywhere. So it is kept for as long as
   * it is right within 10 % of itself and of the stiffness that it is added to:
   * the line search works with the true energy anyway.
   */
  template <int dim>
  class Linearization
  {
  public:
    /** @p problem is kept by reference. Collective. */
    Linearization(const DiscreteProblem<dim> &problem,
                  const TruncationVariant     variant);
    Linearization(DiscreteProblem<dim> &&, const TruncationVariant) = delete;

    /** Determines the phases of an iterate and, in three dimensions,
     * $\omega''$; and has the neighbouring processes know them. Collective. */
    void update(const Iterate &x);

    const Truncation<dim> &
    truncation() const
    {
      return current.truncation();
    }

    /** Has contact nodes of this process, which slide, stick in the linearised
     * problem, until the next update(). Collective. */
    void hold(const std::vector<unsigned int> &contact_nodes, const Iterate &x);

    /** The truncated residual of the linearised problem,
     * r := T (f - A u - omega'(u)). */
    void linearize_residual(VectorType &r, const Iterate &x) const;

    /** What is left of it after a correction,
     * defect := T (r - (A + omega'') v). Collective. */
    void linearized_defect(VectorType       &defect,
                           const VectorType &r,
                           const VectorType &v) const;

    /**
     * Cartesian bounds within which a correction of the iterate is admissible
     * and causes no change of phase, (6.12). A half space $n\cdot v\le b$ is
     * replaced by the largest box of equal sides inside it that contains zero.
     * A sliding node may not move back beyond the line through $u_T=0$ that is
     * perpendicular to its slip; in two dimensions this is to say that $u_T$
     * keeps its sign.
     */
    void bounds(VectorType &lower, VectorType &upper, const Iterate &x) const;

  private:
    const DiscreteProblem<dim> &problem;
    const TruncationVariant     variant;
    ContactTruncation<dim>      current;
  };
} // namespace Friction

#endif

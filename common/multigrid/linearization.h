#ifndef friction_multigrid_linearization_h
#define friction_multigrid_linearization_h

#include <common/contact/contact_boundary.h>
#include <common/contact/contact_state.h>
#include <common/multigrid/truncation.h>
#include <common/scene/solver_settings.h>

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
   * In two dimensions $\omega''=0$, since $|u_T|$ is piecewise linear.
   */
  template <int dim>
  class Linearization
  {
  public:
    /** @p contact is kept by reference. */
    Linearization(const NodalConstraints<dim> &constraints,
                  const ContactBoundary<dim>  &contact,
                  const double                 friction_coefficient,
                  const TruncationVariant      variant);

    /** Determines the phases. */
    void update(const VectorType &u, const ContactState &state);

    const Truncation<dim> &
    truncation() const
    {
      return current;
    }

    /** r := T (r - omega'(u)), from the residual r = f - A u. */
    void linearize_residual(VectorType         &r,
                            const VectorType   &u,
                            const ContactState &state) const;

    /**
     * Cartesian bounds within which a correction of @p u is admissible and
     * causes no change of phase, (6.12). A half space $n\cdot v\le b$ is
     * replaced by the largest box of equal sides inside it that contains zero.
     */
    void bounds(VectorType         &lower,
                VectorType         &upper,
                const VectorType   &u,
                const ContactState &state) const;

  private:
    const ContactBoundary<dim> &contact;
    const double                friction_coefficient;
    const TruncationVariant     variant;
    Truncation<dim>             current;
  };
} // namespace Friction

#endif

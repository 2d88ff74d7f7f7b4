#ifndef friction_iteration_iterate_h
#define friction_iteration_iterate_h

#include <common/contact/contact_state.h>
#include <common/nodes/nodal_constraints.h>
#include <common/parallel/owned_values.h>

namespace Friction
{
  /**
   * What the five parts of a step work on.
   */
  struct Iterate
  {
    Iterate(VectorType   &u,
            ContactState &state,
            const bool    updates_normal_forces = false)
      : u(u)
      , state(state)
      , updates_normal_forces(updates_normal_forces)
    {}

    /// The displacement: admissible, and with its prescribed values.
    VectorType &u;

    /// Phases of the contact nodes, and the normal forces in their friction
    /// bounds.
    ContactState &state;

    /// Whether the normal forces are those of the displacement itself, as in
    /// Algorithm 3; otherwise they are given (Tresca).
    bool updates_normal_forces;

    /// f - A u, once the leading relaxation has been there.
    VectorType residual;

    /// The last step of the iteration, the difference of two smoothed iterates,
    /// and A times it, that of their residuals. Empty before the first step.
    VectorType step, step_image;

    bool
    has_step() const
    {
      return step.size() > 0;
    }

    /** Forgets the last step. */
    void
    forget_step()
    {
      step.reinit(0);
      step_image.reinit(0);
    }

    /** To be called before the displacement changes, and when the last step is
     * no longer needed: where it has been the new one begins. */
    void
    begin_step()
    {
      step       = u;
      step_image = residual;
    }

    /** To be called after it, when the residual is that of the displacement. */
    void
    end_step()
    {
      combine_owned(step, -1., 1., u);
      combine_owned(step_image, 1., -1., residual);
    }
  };
} // namespace Friction

#endif

#ifndef friction_iteration_iterate_h
#define friction_iteration_iterate_h

#include <common/contact/contact_state.h>
#include <common/nodes/nodal_constraints.h>

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
  };
} // namespace Friction

#endif

#ifndef friction_discretization_held_body_h
#define friction_discretization_held_body_h

#include <common/discretization/discretization.h>

namespace Friction
{
  /**
   * Throws InputError if a part of the body can be moved as a rigid one, and
   * contact does not stop it: see FreePart and held_by_contact(). Loads are
   * those of the discrete problem, and contact nodes, normals and gaps are, so
   * that what is judged is what will be solved; without friction. Names the
   * part, the motion and what would hold it. Collective, and for nothing if
   * displacements hold all parts, as they usually do.
   *
   * @param discretization  which has been assembled.
   */
  template <int dim>
  void check_that_body_is_held(const Discretization<dim> &discretization);
} // namespace Friction

#endif

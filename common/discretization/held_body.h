#ifndef friction_discretization_held_body_h
#define friction_discretization_held_body_h

#include <common/discretization/discretization.h>

namespace Friction
{
  /**
   * Throws InputError if a part of the body can be moved as a rigid one, and
   * contact does not stop it: see FreePart and held_by_contact(). Loads are
   * those of the discrete problem, and contact nodes and normals are, so that
   * what is judged is what will be solved; without friction. Names the part,
   * the motion and what would hold it. Collective, and for nothing if
   * displacements hold all parts, as they usually do.
   *
   * Where the body touches the obstacle, both have the same normal. Far from
   * it, the normals of the one are oblique to those of the other, and seem to
   * hold what nothing holds: the nodes of a straight edge, whose normals are
   * those of a disc beneath it, keep it from sliding over the disc, and those
   * of a disc with its own normals keep it from sliding over a plane. So
   * pressures in the normals of the problem have to hold the body, and
   * pressures in the normals of the other surface, too.
   *
   * It is not noticed that a round body may roll, if normals are those of the
   * obstacle: its faces are taken to be straight. Nor does it matter how far
   * the body has to move until it is stopped; displacements that are large
   * against it are warned of in the end.
   *
   * @param discretization  which has been assembled.
   */
  template <int dim>
  void check_that_body_is_held(const Discretization<dim> &discretization);
} // namespace Friction

#endif

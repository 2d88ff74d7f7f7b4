#ifndef friction_scene_seams_h
#define friction_scene_seams_h

#include <deal.II/base/point.h>

#include <deal.II/grid/tria.h>

namespace Friction
{
  using namespace dealii;

  /**
   * Places where cells of a coarse mesh lie side by side and are not joined, so
   * that the body is cut. Most often nodes should have been merged, or parts
   * have been meshed each for itself.
   */
  template <int dim>
  struct Seam
  {
    unsigned int n = 0;
    Point<dim>   where; ///< one of them
  };

  /** Pairs of boundary faces that lie on each other. */
  template <int dim>
  Seam<dim> faces_on_each_other(const Triangulation<dim> &mesh);

  /** Nodes of the boundary that lie on a boundary face of other nodes, and not
   * in one of its corners. Coarse cells that fit have none. */
  template <int dim>
  Seam<dim> nodes_on_faces(const Triangulation<dim> &mesh);
} // namespace Friction

#endif

#ifndef friction_output_mesh_warnings_h
#define friction_output_mesh_warnings_h

#include <common/scene/scene.h>

#include <string>
#include <vector>

namespace Friction
{
  /*
   * What is no error of a coarse mesh, but hardly what its user wanted. The
   * coarse mesh is known to all processes, which find the same sentences.
   */

  /** Where the body is cut, see Seam; otherwise the parts that it consists of,
   * if there are several. */
  template <int dim>
  std::vector<std::string> warnings_about_cuts(const Triangulation<dim> &mesh);

  /** Edges of the contact boundary that are too flat to be corners of the body,
   * and stay however fine the mesh. */
  template <int dim>
  std::vector<std::string> warnings_about_edges(const Triangulation<dim> &mesh,
                                                const Scene<dim> &scene);
} // namespace Friction

#endif

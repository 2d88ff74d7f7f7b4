#ifndef friction_output_mesh_warnings_h
#define friction_output_mesh_warnings_h

#include <common/scene/scene.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace Friction
{
  /** The angle between two directions of length one, in degrees. */
  template <int dim>
  double
  angle_between(const Tensor<1, dim> &a, const Tensor<1, dim> &b)
  {
    return std::acos(std::max(-1., std::min(1., a * b))) * 180. / numbers::PI;
  }

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

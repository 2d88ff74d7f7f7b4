#ifndef friction_scene_geometries_h
#define friction_scene_geometries_h

#include <common/parameters/parameters.h>

#include <deal.II/grid/tria.h>

#include <string>

namespace Friction
{
  using namespace dealii;

  /**
   * How many cells the coarse mesh of a body will have, if its size is up to
   * the scene; otherwise, and for a mesh file, zero. A number that may be
   * larger than any integer.
   */
  double n_coarse_cells(const Parameters::Scene &scene);

  /**
   * Make the coarse mesh of a body in an empty triangulation that lives on one
   * processor, and set boundary and manifold ids. The manifolds themselves are
   * attached later, by set_manifolds(), since they are lost when a mesh is
   * turned or copied.
   *
   * Throws InputError if there is no such body in dim dimensions, or if the
   * mesh file cannot be read; @p where begins the sentence.
   */
  template <int dim>
  void make_geometry(const Parameters::Scene &scene,
                     const std::string       &where,
                     Triangulation<dim>      &triangulation);

  /**
   * Attach the manifolds that belong to the ids set by make_geometry(), so that
   * refined meshes follow curved boundaries exactly: new vertices lie on them,
   * and the manifold knows the normal there. Bodies must have been turned by
   * 'Scene/Rotation angle' around the origin, in three dimensions around the z
   * axis.
   */
  template <int dim>
  void set_manifolds(const Parameters::Scene &scene,
                     Triangulation<dim>      &triangulation);
} // namespace Friction

#endif

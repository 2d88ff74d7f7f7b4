#ifndef friction_scene_round_manifolds_h
#define friction_scene_round_manifolds_h

#include <deal.II/grid/manifold.h>
#include <deal.II/grid/manifold_lib.h>
#include <deal.II/grid/tria.h>

#include <memory>

namespace Friction
{
  using namespace dealii;

  /**
   * Circles and spheres around the origin, as deal.II's SphericalManifold has
   * them. That takes points nearer to each other than 1e-10 for one, whatever
   * the radius, and loses digits before that. Here points between two others
   * have their own formula, and those between more of them are deal.II's, with
   * the first one at distance one.
   */
  template <int dim>
  class Spheres : public Manifold<dim>
  {
  public:
    std::unique_ptr<Manifold<dim>> clone() const override;

    /** Of points in any number, none of them the origin, and no two opposite to
     * each other; weights have the sum one. */
    Point<dim>
    get_new_point(const ArrayView<const Point<dim>> &points,
                  const ArrayView<const double>     &weights) const override;

    /** Away from the origin. */
    Tensor<1, dim>
    normal_vector(const typename Triangulation<dim>::face_iterator &face,
                  const Point<dim> &p) const override;

  private:
    const SphericalManifold<dim> around_one;
  };



  /**
   * The mantle of a cylinder around the z axis. The class it is derived from
   * finds normals by way of two tangents, to rounding; that leaves them with a
   * small component along the axis, and where the displacement along the axis
   * is prescribed, contact could not be told from it exactly.
   */
  class Mantle : public CylindricalManifold<3>
  {
  public:
    Mantle();

    std::unique_ptr<Manifold<3>> clone() const override;

    /** Away from the axis. */
    Tensor<1, 3> normal_vector(const Triangulation<3>::face_iterator &face,
                               const Point<3> &p) const override;
  };
} // namespace Friction

#endif

#ifndef friction_scene_extruded_manifold_h
#define friction_scene_extruded_manifold_h

#include <deal.II/grid/manifold.h>

#include <memory>

namespace Friction
{
  using namespace dealii;

  /**
   * A manifold of a plane mesh, the section, drawn along the z axis: for bodies
   * whose cells are those of the section between planes of constant z, and
   * whose other manifolds are drawn along the axis like this one. If the
   * manifold interpolates inside of coarse cells, new points are those that
   * deal.II's TransfiniteInterpolationManifold would find in the cells of the
   * body. They are found in the section, in a fraction of the time: of the
   * vertices that refinement makes, the middles of a cell and of its faces
   * along the axis lie above points of the section that are there already.
   */
  class ExtrudedManifold : public Manifold<3>
  {
  public:
    /** Keeps the manifold of the section, also in copies. */
    explicit ExtrudedManifold(std::shared_ptr<const Manifold<2>> section);

    std::unique_ptr<Manifold<3>> clone() const override;

    Point<3>
    get_new_point(const ArrayView<const Point<3>> &points,
                  const ArrayView<const double>   &weights) const override;

  private:
    std::shared_ptr<const Manifold<2>> section;
  };
} // namespace Friction

#endif

#ifndef friction_scene_ring_manifold_h
#define friction_scene_ring_manifold_h

#include <deal.II/grid/manifold.h>
#include <deal.II/grid/tria.h>

#include <memory>
#include <vector>

namespace Friction
{
  using namespace dealii;

  /**
   * The cells of a plane mesh between straight sides and a circle around the
   * origin: each coarse cell has one side on the circle and three straight
   * ones. A new point is the mean of the others in the unit square of their
   * coarse cell, which transfinite interpolation maps to the cell,
   *
   *   x(s, t) = (1 - t) inner(s) + t circle(s),
   *
   * with a point that moves along the straight side, and one along the circle
   * opposite to it, both at constant speed. These are the points that deal.II's
   * TransfiniteInterpolationManifold finds to 1e-10 of the cell, for cells with
   * curved sides of all kinds; with one of a known kind they are found to
   * rounding, and in a fraction of the time.
   */
  class RingManifold : public Manifold<2>
  {
  public:
    /** Of the coarse cells of @p mesh with manifold id @p ring; their sides on
     * the circle have manifold id @p circle. Of @p mesh nothing is kept. */
    RingManifold(const Triangulation<2>  &mesh,
                 const types::manifold_id ring,
                 const types::manifold_id circle);

    std::unique_ptr<Manifold<2>> clone() const override;

    /** Of points of the same coarse cell, in any number; weights have the sum
     * one. */
    Point<2>
    get_new_point(const ArrayView<const Point<2>> &points,
                  const ArrayView<const double>   &weights) const override;

  private:
    /** A coarse cell. Angles go from the first side to the second. */
    struct Cell
    {
      Point<2> inner[2];
      Point<2> outer[2];
      double   radius;
      double   first_angle;
      double   angle;

      /** The point of the straight side at @p s. */
      Point<2> at_inner(const double s) const;

      /** The point of the circle at @p s. */
      Point<2> at_circle(const double s) const;

      /** The point x(s, t). */
      Point<2> push_forward(const Point<2> &place) const;

      /** Positive if @p p is outside of one of the straight sides, negative if
       * it is inside of all three: the largest of its distances from them, each
       * times the length of the side. */
      double outside(const Point<2> &p) const;

      /** Where x(s, t) is @p p. */
      Point<2> pull_back(const Point<2> &p) const;
    };

    std::vector<Cell> cells;
  };
} // namespace Friction

#endif

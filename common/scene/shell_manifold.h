#ifndef friction_scene_shell_manifold_h
#define friction_scene_shell_manifold_h

#include <deal.II/grid/manifold.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <memory>
#include <vector>

namespace Friction
{
  using namespace dealii;

  /**
   * The cells of a mesh between straight sides and a sphere around the origin:
   * each coarse cell has one side on the sphere, and its edges from there to
   * the side opposite to it point to the origin. So do all lines in it,
   *
   *   x(s, t, r) = ((1 - r) |c| + r R) c/|c|,  c = c(s, t),
   *
   * where c is the point of the straight side, bilinear in s and t, and R the
   * radius of the sphere. A new point is the mean of the others in the unit
   * cube of their coarse cell. On the straight sides and on the edges these are
   * the points that deal.II's TransfiniteInterpolationManifold finds. In
   * between that follows the means of points on the sphere, which it has to
   * iterate for, and so does finding a place in the unit cube; here all has a
   * formula.
   */
  class ShellManifold : public Manifold<3>
  {
  public:
    /** Of the coarse cells of @p mesh with manifold id @p shell; their sides on
     * the sphere have manifold id @p sphere. Of @p mesh nothing is kept. */
    ShellManifold(const Triangulation<3>  &mesh,
                  const types::manifold_id shell,
                  const types::manifold_id sphere);

    std::unique_ptr<Manifold<3>> clone() const override;

    /** Of points of the same coarse cell, in any number; weights have the sum
     * one. */
    Point<3>
    get_new_point(const ArrayView<const Point<3>> &points,
                  const ArrayView<const double>   &weights) const override;

  private:
    /** A coarse cell. */
    struct Cell
    {
      /** Of the straight side, lexicographically in s and t, in parts of the
       * radius. */
      std::array<Tensor<1, 3>, 4> corners;

      /** A direction d belongs to a place whose coordinate s, for one, is the
       * root of
       *   (1 - s)^2 d.n_0 + s (1 - s) d.n_1 + s^2 d.n_2
       * with these vectors n: then d, c(s, 0) and c(s, 1) are in a plane. */
      std::array<std::array<Tensor<1, 3>, 3>, 2> normals;

      double radius;

      Cell(const std::array<Tensor<1, 3>, 4> &corners, const double radius);

      /** The point c of the straight side. */
      Tensor<1, 3> at_side(const double s, const double t) const;

      /** Positive if a direction is outside of the cell. */
      double outside(const Tensor<1, 3> &direction) const;

      /** The point x(s, t, r). */
      Point<3> push_forward(const Point<3> &place) const;

      /** Where x(s, t, r) is @p p. */
      Point<3> pull_back(const Point<3> &p) const;
    };

    std::vector<Cell> cells;
  };
} // namespace Friction

#endif

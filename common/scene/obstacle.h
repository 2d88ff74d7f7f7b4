#ifndef friction_scene_obstacle_h
#define friction_scene_obstacle_h

#include <common/scene/level_surface.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace Friction
{
  using namespace dealii;

  /**
   * A rigid obstacle: nothing, or half spaces, circular rods (discs in two
   * dimensions), balls, what is around a circular hole or a hollow ball, and
   * surfaces that are given by a function. All that the contact conditions ask
   * of it is how far it is from a point in a given direction, and which
   * direction leads straight towards it.
   */
  template <int dim>
  class Obstacle
  {
  public:
    /// The cosine of the largest angle between a surface and a direction in
    /// which it can be met.
    static constexpr double flattest_cosine = .05;

    /// The half space on that side of the plane to which the normal points.
    struct Plane
    {
      Point<dim>     point;
      Tensor<1, dim> normal; ///< a unit vector
    };

    /// A rod, in two dimensions a disc; without an axis, a ball.
    struct Rod
    {
      Point<dim>     center;
      Tensor<1, dim> axis; ///< a unit vector; zero in two dimensions
      double         radius;
      double         length; ///< may be infinite

      /// Whether it is a hole in the obstacle, and the body in it, or in one
      /// of them.
      bool is_hole = false;
    };

    /// No obstacle at all.
    Obstacle() = default;

    /**
     * The half space on that side of the plane through @p point to which
     * @p normal points, of any positive length.
     */
    static Obstacle
    half_space(const Point<dim> &point, const Tensor<1, dim> &normal)
    {
      Obstacle obstacle;
      obstacle.planes.push_back({point, normal / normal.norm()});
      return obstacle;
    }

    /**
     * Rods of the same radius through the given points, infinite unless a
     * length is given. Of rods that end, only the round surface is an obstacle.
     *
     * @param centers a point on the axis of each rod, the middle one if the
     *   rods have an end
     * @param axes directions of the axes, of any positive length; not used,
     *   and may be empty, in two dimensions
     * @param radius of all rods, a length
     * @param length of all rods
     */
    static Obstacle
    make_rods(const std::vector<Point<dim>>     &centers,
              const std::vector<Tensor<1, dim>> &axes,
              const double                       radius,
              const double length = std::numeric_limits<double>::infinity())
    {
      Assert(dim == 2 || axes.size() == centers.size(),
             ExcDimensionMismatch(axes.size(), centers.size()));
      Obstacle obstacle;
      for (unsigned int i = 0; i < centers.size(); ++i)
        {
          // In 2D the axis is perpendicular to the plane; a zero vector makes
          // the projection below do nothing.
          Tensor<1, dim> axis;
          if (dim == 3)
            axis = axes[i] / axes[i].norm();
          obstacle.rods.push_back({centers[i], axis, radius, length});
        }
      return obstacle;
    }

    /// More of it. An axis may have any length.
    void
    add(Rod rod)
    {
      if (rod.axis.norm() > 0.)
        rod.axis /= rod.axis.norm();
      rods.push_back(rod);
    }

    void
    add(const std::shared_ptr<const LevelSurface<dim>> &surface)
    {
      surfaces.push_back(surface);
    }

    /// Whether there is no obstacle.
    bool
    empty() const
    {
      return planes.empty() && rods.empty() && surfaces.empty();
    }

    /// Whether a point is in the part of it that is given by a function.
    bool
    surfaces_contain(const Point<dim> &p) const
    {
      return std::any_of(
        surfaces.begin(), surfaces.end(), [&](const auto &surface) {
          return surface->contains(p);
        });
    }

    /// Of what it consists.
    const std::vector<Plane> &
    half_spaces() const
    {
      return planes;
    }

    const std::vector<Rod> &
    circular_rods() const
    {
      return rods;
    }

    /// Whether something of it is given by a function.
    bool
    has_surfaces() const
    {
      return !surfaces.empty();
    }

    /**
     * Distance along the unit vector @p direction from @p p to the surface of
     * the obstacle. Negative when @p p lies inside it, and infinite when the
     * ray never meets the surface, or meets it so flatly (the cosine of the
     * angle with its normal being below 0.05) that the distance means nothing.
     */
    double
    gap(const Point<dim> &p, const Tensor<1, dim> &direction) const
    {
      double gap = std::numeric_limits<double>::infinity();
      for (const Plane &plane : planes)
        {
          const double cosine = plane.normal * direction;
          if (cosine > flattest_cosine)
            gap = std::min(gap, plane.normal * (plane.point - p) / cosine);
        }
      const Rod *hole = hole_around(p);
      for (const Rod &rod : rods)
        {
          if (rod.is_hole && &rod != hole)
            continue;
          // The intersection of the ray with the circle, in the plane
          // perpendicular to the axis: the first one, or the way out of a
          // hole.
          const Tensor<1, dim> to_axis      = across(rod, rod.center - p);
          const Tensor<1, dim> n            = across(rod, direction);
          const double         n_sqr        = n.norm_square();
          const double         r            = rod.radius;
          const double         along        = to_axis * n;
          const double         excess       = to_axis.norm_square() - r * r;
          const double         discriminant = along * along - n_sqr * excess;

          // The root of the discriminant is r times the cosine sought.
          const bool flat = discriminant <= std::pow(flattest_cosine * r, 2);
          const bool behind =
            (excess > 0. && (rod.is_hole ? along >= 0. : along <= 0.));
          if (flat || behind)
            continue;
          const double root = std::sqrt(discriminant);
          const double distance =
            (along + (rod.is_hole ? root : -root)) / n_sqr;
          const double from_middle =
            (p + distance * direction - rod.center) * rod.axis;
          // What ends exactly there shall not be a matter of rounding.
          if (std::abs(from_middle) <= (.5 + 1e-10) * rod.length)
            gap = std::min(gap, distance);
        }
      for (const auto &surface : surfaces)
        gap = std::min(gap, surface->gap(p, direction, flattest_cosine));
      return gap;
    }

    /**
     * The unit vector from @p p straight towards the (nearest part of the)
     * obstacle; from inside, the one that led there. Beyond the ends of all
     * rods, to where they would be if they were longer.
     * @param outward  if given, the normal of a body in @p p: only those parts
     *                 of the obstacle count that it faces, and not those to
     *                 which the way leads through the body. Zero if there is
     *                 none.
     */
    Tensor<1, dim>
    normal(const Point<dim>     &p,
           const Tensor<1, dim> &outward = Tensor<1, dim>()) const
    {
      Tensor<1, dim> nearest;
      double         smallest = std::numeric_limits<double>::infinity();
      const auto     consider = [&](const double          distance,
                                const Tensor<1, dim> &direction) {
        const bool faces =
          outward.norm() == 0. || direction * outward > flattest_cosine;
        if (distance < smallest && faces)
          {
            smallest = distance;
            nearest  = direction;
          }
      };
      for (const Plane &plane : planes)
        consider(plane.normal * (plane.point - p), plane.normal);
      const bool any_reaches = any_reaches_as_far_as(p);
      const Rod *hole        = hole_around(p);
      for (const Rod &rod : rods)
        {
          if ((any_reaches && !reaches_as_far_as(rod, p)) ||
              (rod.is_hole && &rod != hole))
            continue;
          const Tensor<1, dim> to_axis = across(rod, rod.center - p);
          const double         side    = rod.is_hole ? -1. : 1.;
          if (to_axis.norm() > 0.)
            consider(side * (to_axis.norm() - rod.radius),
                     side * to_axis / to_axis.norm());
        }
      for (const auto &surface : surfaces)
        {
          const typename LevelSurface<dim>::Way way = surface->way_from(p);
          consider(way.distance, way.direction);
        }
      return nearest;
    }

  private:
    /// A rod that has ended before the point counts only if all of them have.
    static bool
    reaches_as_far_as(const Rod &rod, const Point<dim> &p)
    {
      return std::abs((p - rod.center) * rod.axis) <= (.5 + 1e-10) * rod.length;
    }

    bool
    any_reaches_as_far_as(const Point<dim> &p) const
    {
      return std::any_of(rods.begin(), rods.end(), [&](const Rod &rod) {
        return reaches_as_far_as(rod, p);
      });
    }

    /// Of several holes that in which the point is, or the nearest one; null if
    /// there are none.
    const Rod *
    hole_around(const Point<dim> &p) const
    {
      const bool any_reaches = any_reaches_as_far_as(p);
      const Rod *result      = nullptr;
      double     deepest     = 0;
      for (const Rod &rod : rods)
        if (rod.is_hole && (!any_reaches || reaches_as_far_as(rod, p)))
          {
            const double depth =
              rod.radius - across(rod, rod.center - p).norm();
            if (result == nullptr || depth > deepest)
              {
                result  = &rod;
                deepest = depth;
              }
          }
      return result;
    }

    /// The part of a vector perpendicular to the axis of a rod.
    static Tensor<1, dim>
    across(const Rod &rod, const Tensor<1, dim> &v)
    {
      return v - (v * rod.axis) * rod.axis;
    }

    std::vector<Plane> planes;
    std::vector<Rod>   rods;

    std::vector<std::shared_ptr<const LevelSurface<dim>>> surfaces;
  };
} // namespace Friction

#endif

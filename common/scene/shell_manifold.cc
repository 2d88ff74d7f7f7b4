#include <common/scene/coarse_cell.h>
#include <common/scene/shell_manifold.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  namespace
  {
    // Points are outside of a cell by this part of it at most, from rounding.
    constexpr double rounding_outside = 1e-9;

    // The root between 0 and 1 of (1-s)^2 a + s (1-s) b + s^2 c, where a is
    // not negative and c not positive: of the two that s/(1-s) has, which have
    // different signs, the positive one, without taking a difference of two
    // numbers that may be nearly the same. At the ends a or c is zero, and the
    // root that is meant is the limit: b is negative for s = 0, and positive
    // for s = 1, for there the direction is between two corners of that side.
    double
    root_between(const double a, const double b, const double c)
    {
      const double root = std::sqrt(b * b - 4. * a * c);
      return b >= 0. ? (b + root) / (b + root - 2. * c)
                     : 2. * a / (2. * a + root - b);
    }
  } // namespace



  ShellManifold::ShellManifold(const Triangulation<3>  &mesh,
                               const types::manifold_id shell,
                               const types::manifold_id sphere)
  {
    CoarseCell::for_each_between(
      mesh,
      shell,
      sphere,
      [&](const CoarseCell::Side<3> &inner, const CoarseCell::Side<3> &outer) {
        const double                radius = outer[0].norm();
        std::array<Tensor<1, 3>, 4> corners;
        for (unsigned int v = 0; v < 4; ++v)
          {
            corners[v] = inner[v] / radius;
            Assert(cross_product_3d(inner[v], outer[v]).norm() <=
                     rounding_outside * inner[v].norm() * radius,
                   ExcMessage("An edge does not point to the origin."));
          }
        cells.emplace_back(corners, radius);
      });
    Assert(!cells.empty(), ExcMessage("There is no shell."));
  }



  std::unique_ptr<Manifold<3>>
  ShellManifold::clone() const
  {
    return std::make_unique<ShellManifold>(*this);
  }



  Point<3>
  ShellManifold::get_new_point(const ArrayView<const Point<3>> &points,
                               const ArrayView<const double>   &weights) const
  {
    // The sides of cells are in planes through the origin.
    return CoarseCell::mean(cells, points, weights);
  }



  ShellManifold::Cell::Cell(const std::array<Tensor<1, 3>, 4> &corners,
                            const double                       radius)
    : corners(corners)
    , radius(radius)
  {
    for (unsigned int d = 0; d < 2; ++d)
      {
        // From low to high along the other coordinate.
        const auto low  = [&](const unsigned int end) { return (1 + d) * end; };
        const auto high = [&](const unsigned int end) {
          return (2 - d) + low(end);
        };
        const auto normal = [&](const unsigned int v, const unsigned int w) {
          return cross_product_3d(corners[v], corners[w]);
        };
        normals[d] = {{normal(low(0), high(0)),
                       normal(low(0), high(1)) + normal(low(1), high(0)),
                       normal(low(1), high(1))}};
        if (corners[low(1)] * normals[d][0] < 0.)
          for (Tensor<1, 3> &n : normals[d])
            n = -n;
      }
  }



  Tensor<1, 3>
  ShellManifold::Cell::at_side(const double s, const double t) const
  {
    return (1. - t) * ((1. - s) * corners[0] + s * corners[1]) +
      t * ((1. - s) * corners[2] + s * corners[3]);
  }



  double
  ShellManifold::Cell::outside(const Tensor<1, 3> &direction) const
  {
    return std::max({-(direction * normals[0][0]),
                     direction * normals[0][2],
                     -(direction * normals[1][0]),
                     direction * normals[1][2]});
  }



  Point<3>
  ShellManifold::Cell::push_forward(const Point<3> &place) const
  {
    const Tensor<1, 3> on_side = at_side(place[0], place[1]);
    return Point<3>(radius * (1. - place[2] + place[2] / on_side.norm()) *
                    on_side);
  }



  Point<3>
  ShellManifold::Cell::pull_back(const Point<3> &p) const
  {
    const Tensor<1, 3> scaled = p / radius;
    Assert(outside(scaled) <= rounding_outside,
           ExcMessage("A point is not in its cell."));
    Point<3> place;
    for (unsigned int d = 0; d < 2; ++d)
      place[d] = root_between(std::max(0., scaled * normals[d][0]),
                              scaled * normals[d][1],
                              std::min(0., scaled * normals[d][2]));
    const double inner = at_side(place[0], place[1]).norm();
    place[2]           = (scaled.norm() - inner) / (1. - inner);
    return place;
  }
} // namespace Friction

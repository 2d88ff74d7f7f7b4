#include <common/scene/extruded_manifold.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace Friction
{
  namespace
  {
    // Points of the section are the same if they are nearer to each other than
    // this part of the largest distance, in space, from the first point.
    constexpr double relative_rounding = 1e-10;

    // Sums of weights up to this count as zero.
    constexpr double no_weight = 1e-12;
  } // namespace



  ExtrudedManifold::ExtrudedManifold(std::shared_ptr<const Manifold<2>> section)
    : section(std::move(section))
  {}



  std::unique_ptr<Manifold<3>>
  ExtrudedManifold::clone() const
  {
    return std::make_unique<ExtrudedManifold>(section);
  }



  // The map from the unit cube to a cell is that of the section, and linear
  // along the axis. So a mean in the unit cube is one in the unit square, and
  // points above each other count as one, with the sum of their weights.
  Point<3>
  ExtrudedManifold::get_new_point(const ArrayView<const Point<3>> &points,
                                  const ArrayView<const double> &weights) const
  {
    double size = 0., z = 0.;
    for (unsigned int i = 0; i < points.size(); ++i)
      {
        size = std::max(size, points[i].distance_square(points[0]));
        z += weights[i] * points[i][2];
      }

    std::vector<Point<2>> plane_points;
    std::vector<double>   plane_weights;
    for (unsigned int i = 0; i < points.size(); ++i)
      {
        const Point<2> p(points[i][0], points[i][1]);
        const auto     same = std::find_if(
          plane_points.begin(), plane_points.end(), [&](const Point<2> &other) {
            return p.distance_square(other) <=
              relative_rounding * relative_rounding * size;
          });
        if (same != plane_points.end())
          plane_weights[same - plane_points.begin()] += weights[i];
        else
          {
            plane_points.push_back(p);
            plane_weights.push_back(weights[i]);
          }
      }
    std::size_t n = 0;
    for (std::size_t i = 0; i < plane_points.size(); ++i)
      if (std::abs(plane_weights[i]) > no_weight)
        {
          plane_points[n]    = plane_points[i];
          plane_weights[n++] = plane_weights[i];
        }
    plane_points.resize(n);
    plane_weights.resize(n);

    const Point<2> p = n == 1
      ? plane_points[0]
      : section->get_new_point(make_array_view(plane_points),
                               make_array_view(plane_weights));
    return {p[0], p[1], z};
  }
} // namespace Friction

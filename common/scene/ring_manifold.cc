#include <common/scene/coarse_cell.h>
#include <common/scene/ring_manifold.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  namespace
  {
    // Newton's method has arrived if a step is shorter than this part of a
    // side: its error is the square of that.
    constexpr double       last_step    = 1e-9;
    constexpr unsigned int n_most_steps = 60;

    // Points are outside of a cell by this part of it at most, from rounding.
    constexpr double most_outside = 1e-9;

    double
    cross_product(const Tensor<1, 2> &a, const Tensor<1, 2> &b)
    {
      return a * cross_product_2d(b);
    }
  } // namespace



  RingManifold::RingManifold(const Triangulation<2>  &mesh,
                             const types::manifold_id ring,
                             const types::manifold_id circle)
  {
    CoarseCell::for_each_between(
      mesh,
      ring,
      circle,
      [&](const CoarseCell::Side<2> &inner, const CoarseCell::Side<2> &outer) {
        Cell c;
        for (unsigned int v = 0; v < 2; ++v)
          {
            c.outer[v] = outer[v];
            c.inner[v] = inner[v];
          }
        c.radius      = c.outer[0].norm();
        c.first_angle = std::atan2(c.outer[0][1], c.outer[0][0]);
        c.angle       = std::atan2(cross_product(c.outer[0], c.outer[1]),
                             c.outer[0] * c.outer[1]);
        cells.push_back(c);
      });
    Assert(!cells.empty(), ExcMessage("There is no ring."));
  }



  std::unique_ptr<Manifold<2>>
  RingManifold::clone() const
  {
    return std::make_unique<RingManifold>(*this);
  }



  Point<2>
  RingManifold::get_new_point(const ArrayView<const Point<2>> &points,
                              const ArrayView<const double>   &weights) const
  {
    // Cells are convex.
    return CoarseCell::mean(cells, points, weights);
  }



  Point<2>
  RingManifold::Cell::at_inner(const double s) const
  {
    return inner[0] + s * (inner[1] - inner[0]);
  }



  Point<2>
  RingManifold::Cell::at_circle(const double s) const
  {
    const double a = first_angle + s * angle;
    return {radius * std::cos(a), radius * std::sin(a)};
  }



  Point<2>
  RingManifold::Cell::push_forward(const Point<2> &place) const
  {
    return (1. - place[1]) * at_inner(place[0]) +
      place[1] * at_circle(place[0]);
  }



  double
  RingManifold::Cell::outside(const Point<2> &p) const
  {
    const double direction = angle > 0. ? 1. : -1.;
    return std::max(
      {direction * cross_product(p - inner[0], outer[0] - inner[0]),
       direction * cross_product(outer[1] - inner[1], p - inner[1]),
       direction * cross_product(inner[1] - inner[0], p - inner[0])});
  }



  // The point lies on the line from inner(s) to circle(s), whose s is the root
  // of a function that has one in the cell, and may have others outside of it.
  // Newton's method begins where it would be if the distances from the two
  // lines at the ends were in proportion. A step out of the interval in which
  // the root is known to be is replaced by half of the interval.
  Point<2>
  RingManifold::Cell::pull_back(const Point<2> &p) const
  {
    const Tensor<1, 2> along_side = inner[1] - inner[0];
    const double ends[2] = {cross_product(p - inner[0], outer[0] - inner[0]),
                            cross_product(p - inner[1], outer[1] - inner[1])};
    const bool   rises   = ends[0] < ends[1];
    Assert(std::max(std::min(ends[0], ends[1]), -std::max(ends[0], ends[1])) <=
             most_outside * std::abs(ends[1] - ends[0]),
           ExcMessage("A point is not in its cell."));
    double low = 0., high = 1.;
    double s      = std::clamp(ends[0] / (ends[0] - ends[1]), low, high);
    double change = 1.;
    for (unsigned int step = 0;
         step < n_most_steps && std::abs(change) > last_step;
         ++step)
      {
        const Point<2>     on_side   = at_inner(s);
        const Point<2>     on_circle = at_circle(s);
        const Tensor<1, 2> line      = on_circle - on_side;
        const Tensor<1, 2> along_circle(
          {-angle * on_circle[1], angle * on_circle[0]});
        const double value = cross_product(p - on_side, line);
        change             = value /
          (cross_product(p - on_side, along_circle - along_side) -
           cross_product(along_side, line));
        ((value < 0.) == rises ? low : high) = s;
        if (std::abs(change) > last_step &&
            !(low <= s - change && s - change <= high))
          change = s - .5 * (low + high);
        s -= change;
      }
    Assert(std::abs(change) <= last_step,
           ExcMessage("The place of a point in its cell was not found."));
    const Point<2>     start = at_inner(s);
    const Tensor<1, 2> whole = at_circle(s) - start;
    return {s, (p - start) * whole / whole.norm_square()};
  }
} // namespace Friction

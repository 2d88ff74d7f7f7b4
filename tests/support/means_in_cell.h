#ifndef friction_tests_support_means_in_cell_h
#define friction_tests_support_means_in_cell_h

#include <deal.II/base/array_view.h>
#include <deal.II/base/point.h>

#include <deal.II/grid/manifold.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include <tests/support/random.h>

namespace Tests
{
  /** A new point of a manifold is to be where the weighted mean of others is in
   * the unit cell, which @p x maps to a cell. The largest distance from there,
   * for points drawn at random, often all of them on a side of the cell, on an
   * edge or in a corner. */
  template <int dim, typename Map>
  double
  error_of_means(const dealii::Manifold<dim> &manifold, const Map &x)
  {
    using dealii::Point;
    Random random(1);
    double largest = 0.;
    for (unsigned int i = 0; i < 200; ++i)
      {
        std::array<unsigned int, dim> end;
        for (unsigned int &e : end)
          e = random.below(4);
        const unsigned int      n = 2 + random.below(4);
        std::vector<Point<dim>> places(n), points;
        std::vector<double>     weights;
        for (Point<dim> &p : places)
          {
            for (unsigned int d = 0; d < dim; ++d)
              p[d] = end[d] < 2 ? end[d] : random(0., 1.);
            points.push_back(x(p));
            weights.push_back(random(0., 1.));
          }
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.);
        Point<dim>   mean;
        for (unsigned int j = 0; j < n; ++j)
          {
            weights[j] /= sum;
            mean += weights[j] * places[j];
          }
        const Point<dim> found = manifold.get_new_point(
          dealii::make_array_view(points), dealii::make_array_view(weights));
        largest = std::max(largest, found.distance(x(mean)));
      }
    return largest;
  }
} // namespace Tests

#endif

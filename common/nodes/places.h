#ifndef friction_nodes_places_h
#define friction_nodes_places_h

#include <deal.II/base/point.h>

#include <array>
#include <vector>

namespace Friction
{
  /** Where a node is. In two dimensions the third coordinate is zero, so that
   * what asks for nothing but places is the same in two and in three. */
  using Place  = std::array<double, 3>;
  using Places = std::vector<Place>;

  template <int dim>
  Place
  place_of(const dealii::Point<dim> &point)
  {
    Place place = {{0., 0., 0.}};
    for (unsigned int d = 0; d < dim; ++d)
      place[d] = point[d];
    return place;
  }
} // namespace Friction

#endif

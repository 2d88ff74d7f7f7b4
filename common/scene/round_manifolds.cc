#include <common/scene/round_manifolds.h>

#include <boost/container/small_vector.hpp>

#include <cmath>

namespace Friction
{
  namespace
  {
    // Between two points, by the angles from the direction in their middle,
    // which are exact for the smallest of distances.
    template <int dim>
    Point<dim>
    geodesic(const ArrayView<const Point<dim>> &points,
             const ArrayView<const double>     &weights)
    {
      const double         radii[2] = {points[0].norm(), points[1].norm()};
      const Tensor<1, dim> first    = points[0] / radii[0],
                           last     = points[1] / radii[1];
      const Tensor<1, dim> middle = first + last, along = last - first;
      const double         sine = along.norm(), cosine = middle.norm();
      const double angle = (weights[1] - weights[0]) * std::atan2(sine, cosine);
      Tensor<1, dim> direction = (std::cos(angle) / cosine) * middle;
      if (sine > 0.)
        direction += (std::sin(angle) / sine) * along;
      return Point<dim>((weights[0] * radii[0] + weights[1] * radii[1]) *
                        direction);
    }
  } // namespace



  template <int dim>
  std::unique_ptr<Manifold<dim>>
  Spheres<dim>::clone() const
  {
    return std::make_unique<Spheres<dim>>();
  }



  template <int dim>
  Point<dim>
  Spheres<dim>::get_new_point(const ArrayView<const Point<dim>> &points,
                              const ArrayView<const double>     &weights) const
  {
    if (points.size() == 2)
      return geodesic(points, weights);
    const double                                  radius = points[0].norm();
    boost::container::small_vector<Point<dim>, 8> scaled(points.begin(),
                                                         points.end());
    for (Point<dim> &p : scaled)
      p /= radius;
    return radius *
      around_one.get_new_point(make_array_view(scaled.begin(), scaled.end()),
                               weights);
  }



  template <int dim>
  Tensor<1, dim>
  Spheres<dim>::normal_vector(
    const typename Triangulation<dim>::face_iterator &,
    const Point<dim> &p) const
  {
    return p / p.norm();
  }



  Mantle::Mantle()
    : CylindricalManifold<3>(/*axis = z*/ 2)
  {}



  std::unique_ptr<Manifold<3>>
  Mantle::clone() const
  {
    return std::make_unique<Mantle>();
  }



  Tensor<1, 3>
  Mantle::normal_vector(const Triangulation<3>::face_iterator &,
                        const Point<3> &p) const
  {
    const Tensor<1, 3> radial({p[0], p[1], 0.});
    return radial / radial.norm();
  }



  template class Spheres<2>;
  template class Spheres<3>;
} // namespace Friction

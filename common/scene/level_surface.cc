#include <common/scene/level_surface.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Friction
{
  namespace
  {
    // In multiples of the size of the body.
    constexpr double smallest_step = 1e-4;

    /**
     * A zero of a continuous function between two points in which it has
     * different signs: the regula falsi in the variant called Illinois, which
     * halves the value at an end that stays.
     */
    template <typename F>
    double
    zero_between(const F &f, double a, double b, double f_a, double f_b)
    {
      for (unsigned int i = 0; i < 200; ++i)
        {
          const double t = (a * f_b - b * f_a) / (f_b - f_a);
          if (f_a == 0.)
            return a;
          if (f_b == 0. || !(t > std::min(a, b) && t < std::max(a, b)))
            return b;
          const double f_t = f(t);
          // b is always the last one.
          if ((f_t > 0.) == (f_b > 0.))
            f_a *= .5;
          else
            {
              a   = b;
              f_a = f_b;
            }
          b   = t;
          f_b = f_t;
        }
      return b;
    }
  } // namespace



  template <int dim>
  LevelSurface<dim>::LevelSurface(
    const std::shared_ptr<const Function<dim>> &function,
    const double                                body_size)
    : function(function)
    , size(body_size)
  {}



  template <int dim>
  Tensor<1, dim>
  LevelSurface<dim>::gradient(const Point<dim> &p) const
  {
    const double   h = smallest_step * size;
    Tensor<1, dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const auto at = [&](const double factor) {
          Point<dim> q = p;
          q[d] += factor * h;
          return function->value(q);
        };
        result[d] = (8. * (at(1.) - at(-1.)) - (at(2.) - at(-2.))) / (12. * h);
      }
    return result;
  }



  // We march until the sign changes. Where the function changes by as much as
  // its gradient says, half of the way to its zero is certainly too short; near
  // the surface, or along it, steps are no smaller than what the surface is
  // supposed to be resolved by.
  template <int dim>
  double
  LevelSurface<dim>::gap(const Point<dim>     &p,
                         const Tensor<1, dim> &direction,
                         const double          flattest_cosine) const
  {
    constexpr double never = std::numeric_limits<double>::infinity();
    const auto       at    = [&](const double t) {
      return function->value(p + t * direction);
    };
    double       t = 0., value = at(0.), steepest = 0.;
    const double sign = value < 0. ? -1. : 1.;
    double       zero = value == 0. ? 0. : never;
    while (zero == never && t <= size)
      {
        steepest =
          std::max(steepest, gradient(p + sign * t * direction).norm());
        const double step =
          std::max(steepest > 0. ? .5 * std::abs(value) / steepest : 0.,
                   smallest_step * size);
        const double next = at(sign * (t + step));
        if (next == 0. || (next > 0.) != (value > 0.))
          zero = zero_between(at, sign * t, sign * (t + step), value, next);
        t += step;
        value = next;
      }
    if (zero == never)
      return never;
    const Tensor<1, dim> slope = gradient(p + zero * direction);
    return -(slope * direction) > flattest_cosine * slope.norm() ? zero : never;
  }



  template <int dim>
  auto
  LevelSurface<dim>::way_from(const Point<dim> &p) const -> Way
  {
    const Tensor<1, dim> slope = gradient(p);
    if (slope.norm() == 0.)
      return {std::numeric_limits<double>::infinity(), slope};
    return {function->value(p) / slope.norm(), -slope / slope.norm()};
  }



  template <int dim>
  bool
  LevelSurface<dim>::contains(const Point<dim> &p) const
  {
    return function->value(p) < -smallest_step * size * gradient(p).norm();
  }



  template class LevelSurface<2>;
  template class LevelSurface<3>;
} // namespace Friction

#ifndef friction_scene_level_surface_h
#define friction_scene_level_surface_h

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <memory>

namespace Friction
{
  using namespace dealii;

  /**
   * The surface of an obstacle that is given by a function: positive where a
   * body may be, negative in the obstacle. The function need not be a distance;
   * what is asked of it is a gradient that does not vanish near the surface.
   *
   * Whatever is farther away than the size of the body is not found. Neither is
   * a part of the obstacle that is thinner than a ten-thousandth of it.
   */
  template <int dim>
  class LevelSurface
  {
  public:
    /**
     * @param function   of one component.
     * @param body_size  a length; the gradient is that of differences over a
     *                   ten-thousandth of it, of fourth order.
     */
    LevelSurface(const std::shared_ptr<const Function<dim>> &function,
                 const double                                body_size);

    /**
     * How far it is from @p p to the surface along a unit vector; negative in
     * the obstacle, and then the way back to where it has been entered.
     * Infinite if the surface is not met, or so flatly that the cosine of the
     * angle with its normal is below @p flattest_cosine.
     */
    double gap(const Point<dim>     &p,
               const Tensor<1, dim> &direction,
               const double          flattest_cosine) const;

    /** A distance, negative in the obstacle, and a unit vector, or zero if no
     * way leads there. */
    struct Way
    {
      double         distance;
      Tensor<1, dim> direction;
    };

    /** The way down the gradient in @p p, and how far it would be if that
     * stayed as it is. Of a distance it is the shortest way; of any other
     * function it is that close to the surface, which is where it matters. */
    Way way_from(const Point<dim> &p) const;

    /** Whether @p p is in the obstacle, and deeper than what is too thin to be
     * found. */
    bool contains(const Point<dim> &p) const;

  private:
    const std::shared_ptr<const Function<dim>> function;
    const double                               size;

    Tensor<1, dim> gradient(const Point<dim> &p) const;
  };
} // namespace Friction

#endif

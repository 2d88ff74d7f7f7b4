#ifndef friction_scene_scene_functions_h
#define friction_scene_scene_functions_h

#include <common/parameters/parameters.h>

#include <deal.II/base/function.h>
#include <deal.II/base/tensor.h>

#include <memory>
#include <string>

namespace Friction
{
  using namespace dealii;

  /**
   * The same function, which throws InputError where its value is no finite
   * number, as that of 1/x is at x = 0, or one below the smallest that is
   * allowed: the sentence names the expression, the point and the value. Loads
   * are evaluated by each process on its own cells; the caller sees to it that
   * the error becomes that of all processes, see on_all_processes().
   *
   * @param where     the beginning of the sentence
   * @param text      the expressions as the author of the scene wrote them
   * @param smallest  what values may not be below
   */
  template <int dim>
  std::shared_ptr<const Function<dim>>
  checked_function(const std::shared_ptr<const Function<dim>> &function,
                   const std::string                          &where,
                   const std::string                          &text,
                   const double smallest = -largest_number);

  /**
   * A function of dim components and a vector that is added to it everywhere.
   * @param summand  as it is when the function is evaluated.
   */
  template <int dim>
  std::shared_ptr<const Function<dim>>
  moved_function(const std::shared_ptr<const Function<dim>>  &function,
                 const std::shared_ptr<const Tensor<1, dim>> &summand);

  /**
   * A function given for the scene as written, seen from the turned scene: its
   * argument is turned back, and its value, if a vector, is turned.
   */
  template <int dim>
  std::shared_ptr<const Function<dim>>
  turned_function(const std::shared_ptr<const Function<dim>> &function,
                  const Tensor<2, dim>                       &rotation);
} // namespace Friction

#endif

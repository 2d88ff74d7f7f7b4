#ifndef friction_parameters_wrong_number_h
#define friction_parameters_wrong_number_h

#include <common/input_error.h>

#include <cstddef>
#include <string>

namespace Friction
{
  /**
   * The end of a sentence about a list that has not as many members as there
   * are dimensions. If it has as many as there are in the other program, the
   * whole scene may well be meant for that one.
   */
  inline std::string
  wrong_number(const unsigned int dim,
               const std::size_t  n,
               const std::string &members)
  {
    const std::string other = (dim == 2 ? "3" : "2");
    return "needs " + std::to_string(dim) + " " + members + ", but has " +
      std::to_string(n) + "; correct it" +
      (std::to_string(n) == other ? ", or give the scene to step-friction-" +
           other + "d if it is one of " + other + " dimensions."
                                  : ".");
  }
} // namespace Friction

#endif

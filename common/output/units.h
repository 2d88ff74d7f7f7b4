#ifndef friction_output_units_h
#define friction_output_units_h

#include <common/parameters/parameters.h>

#include <string>

namespace Friction
{
  /**
   * What a recorded number is. Forces on a body in the plane are per length of
   * its thickness, and so are energies.
   */
  enum class Quantity
  {
    number, ///< a count, a ratio, a state
    length,
    area, ///< of a boundary: in the plane a length
    force,
    stress,
    energy,
    energy_norm, ///< the root of an energy
    time
  };

  /**
   * The unit of a quantity in @p dim dimensions, as it is written behind a
   * number, `N/mm^2` for example; nothing if it has none, or if the scene does
   * not name what it is made of.
   *
   * Units are names. Nothing is ever converted: the numbers of a scene have to
   * fit together, whatever they are called.
   */
  std::string unit_of(const Quantity               quantity,
                      const unsigned int           dim,
                      const Parameters::UnitNames &names);
} // namespace Friction

#endif

#include <common/output/units.h>

#include <cstdlib>

namespace Friction
{
  namespace
  {
    // A name to a power, in front of the stroke or behind it.
    std::string
    power_of(const std::string &name, const int power)
    {
      return power == 1 ? name : name + '^' + std::to_string(power);
    }



    // force^f length^l; f is 0 or 1.
    std::string
    product(const Parameters::UnitNames &names, const int f, const int l)
    {
      if ((f != 0 && names.force.empty()) || (l != 0 && names.length.empty()))
        return "";
      if (f == 0)
        return l == 0 ? "" : power_of(names.length, l);
      if (l == 0)
        return names.force;
      return names.force + (l > 0 ? ' ' : '/') +
        power_of(names.length, std::abs(l));
    }
  } // namespace



  std::string
  unit_of(const Quantity               quantity,
          const unsigned int           dim,
          const Parameters::UnitNames &names)
  {
    const int per_thickness = static_cast<int>(dim) - 3;
    switch (quantity)
      {
        case Quantity::number:
          return "";
        case Quantity::length:
          return product(names, 0, 1);
        case Quantity::area:
          return product(names, 0, 2 + per_thickness);
        case Quantity::force:
          return product(names, 1, per_thickness);
        case Quantity::stress:
          return product(names, 1, -2);
        case Quantity::energy:
          return product(names, 1, 1 + per_thickness);
        case Quantity::energy_norm:
          {
            const std::string energy = product(names, 1, 1 + per_thickness);
            if (energy.empty())
              return "";
            return (dim == 2 ? energy : '(' + energy + ')') + "^(1/2)";
          }
        case Quantity::time:
          return "s";
      }
    return "";
  }
} // namespace Friction

#ifndef friction_program_version_h
#define friction_program_version_h

#include <string>

namespace Friction
{
  /**
   * The version of this library, as "1.2.3". It is written into the results of
   * each run.
   */
  std::string version();
} // namespace Friction

#endif

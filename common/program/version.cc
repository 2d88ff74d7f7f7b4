#include <common/program/version.h>

namespace Friction
{
  std::string
  version()
  {
    return FRICTION_VERSION;
  }
} // namespace Friction

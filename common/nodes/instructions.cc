#include <common/nodes/instructions.h>

namespace Friction
{
  std::vector<Instructions>
  available_instructions()
  {
    std::vector<Instructions> available = {Instructions::common};
#ifdef FRICTION_AVX2
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      available.push_back(Instructions::avx2);
#endif
    return available;
  }



  Instructions instructions_in_use = available_instructions().back();
} // namespace Friction

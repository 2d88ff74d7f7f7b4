#include <common/parameters/solver_settings.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  // The less a material can be compressed, the worse sweeps and coarse
  // corrections reduce displacements that hardly change volumes. More sweeps,
  // which follow each other through the cache, make iterations arrive that
  // would not otherwise, and cost hardly any time where these arrive as well;
  // see doc/benchmark/incompressible.txt. Mean strains need more of them, since
  // they leave more displacements that change no volume: three up to a Poisson
  // ratio of 0.456, where the ratio of the two moduli is ten, and with
  // pointwise strains up to 0.477 and twenty-one.
  unsigned int
  enough_smoothing_steps(const double lame_ratio, const VolumetricStrain strain)
  {
    const double per_step = strain == VolumetricStrain::mean ? 3. : 6.;
    return std::lround(std::min(20., std::max(3., lame_ratio / per_step)));
  }



  // More than one pays where tens of cycles are left once phases have settled.
  // The limit is a Poisson ratio of 0.498.
  unsigned int
  enough_recombined_steps(const double lame_ratio)
  {
    return lame_ratio > 248. ? 5 : 1;
  }



  // From a Poisson ratio of 0.4756 on.
  bool
  SolverSettings::nearly_incompressible() const
  {
    return lame_ratio > 19.5;
  }
} // namespace Friction

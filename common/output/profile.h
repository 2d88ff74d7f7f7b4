#ifndef friction_output_profile_h
#define friction_output_profile_h

#include <common/parallel/phase_costs.h>

#include <deal.II/base/mpi.h>

#include <string>

namespace Friction
{
  /**
   * What the solution on a level has cost, as a table with one row per phase:
   * per cycle the messages, bytes and reductions of the process that has most
   * of them, and the seconds of the whole solution, with those spent on waiting
   * for other processes. A collective operation; the text is that of all
   * processes.
   *
   * @param with_times  otherwise nothing that depends on the clock.
   */
  std::string describe_profile(const PhaseCosts  &costs,
                               const unsigned int n_cycles,
                               const bool         with_times,
                               const MPI_Comm     communicator);
} // namespace Friction

#endif

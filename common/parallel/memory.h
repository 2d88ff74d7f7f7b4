#ifndef friction_parallel_memory_h
#define friction_parallel_memory_h

#include <deal.II/base/mpi.h>

namespace Friction
{
  /**
   * The memory, in bytes, that the machines on which these processes run can
   * give them: what is free, within the limit that the system may have set for
   * them, and what they have already. Zero if the system does not say.
   * Collective, the same on all processes.
   */
  double memory_within_reach(const MPI_Comm communicator);
} // namespace Friction

#endif

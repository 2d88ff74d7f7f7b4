#ifndef friction_parallel_memory_h
#define friction_parallel_memory_h

#include <deal.II/base/mpi.h>

#include <string>

namespace Friction
{
  /**
   * The memory, in bytes, that the machines on which these processes run can
   * give them: what is free, within the limit that the system may have set for
   * them, and what they have already. Zero if the system does not say.
   * Collective, the same on all processes.
   */
  double memory_within_reach(const MPI_Comm communicator);

  /**
   * What a group of processes, as those of a container or of a job, may still
   * take of its limit, in bytes; infinite if it has none, or if that is not
   * known. Files that have been read stay in memory as long as no program
   * wants it, and count as used by the group: those that have not been used
   * lately do not here. Where the system does not say how many these are, what
   * is used is not known either, and the limit is all that counts.
   * @param folder  where the system describes such groups, /sys/fs/cgroup, in
   *                its first or second version.
   */
  double memory_left_to_group(const std::string &folder);
} // namespace Friction

#endif

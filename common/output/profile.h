#ifndef friction_output_profile_h
#define friction_output_profile_h

#include <common/output/level_records.h>

#include <deal.II/base/mpi.h>

#include <string>

namespace Friction
{
  /**
   * What the solution on a level has cost, as a table with one row per phase:
   * per cycle the messages, bytes and reductions of the process that has most
   * of them, and the seconds of the whole solution, with those spent on waiting
   * for other processes. Then memory, in bytes per degree of freedom: that of
   * the leaf matrix, of the smoother with the level matrices, and of all
   * processes together when they had most, which is during assembly. A
   * collective operation; the text is that of all processes.
   *
   * @param with_times  otherwise nothing that depends on clock and machine.
   */
  template <int dim>
  std::string describe_profile(const LevelRecords<dim> &records,
                               const bool               with_times,
                               const MPI_Comm           communicator);
} // namespace Friction

#endif

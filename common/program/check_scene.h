#ifndef friction_program_check_scene_h
#define friction_program_check_scene_h

#include <common/parameters/parameters.h>

#include <mpi.h>

#include <ostream>

namespace Friction
{
  /**
   * Does with a scene all that a run does before it solves: makes the first
   * mesh, looks whether every part of the body is held, evaluates all loads,
   * and finds the contact nodes. Prints what it has found, and every warning.
   * Throws InputError as a run would; writes no files. Collective.
   *
   * @param out  of the first process; the others print nothing.
   */
  template <int dim>
  void check_scene(const Parameters &parameters,
                   std::ostream     &out,
                   const MPI_Comm    communicator);
} // namespace Friction

#endif

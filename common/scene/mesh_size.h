#ifndef friction_scene_mesh_size_h
#define friction_scene_mesh_size_h

#include <deal.II/base/mpi.h>

namespace Friction
{
  /**
   * To be called before a mesh is made or refined, so that a scene that asks
   * for more than the machine has is refused in a sentence, and not by the
   * system or by p4est in the middle of their work. Throws InputError if a mesh
   * is too large for the memory within reach, or for the numbers of its degrees
   * of freedom, or if its cells are refined too often. Collective.
   *
   * @param n_cells   active cells that the mesh will have on all processes
   * @param n_levels  refinements that the smallest of them will have; zero: it
   *                  is the coarse mesh
   */
  void check_that_mesh_fits(const unsigned int dim,
                            const double       n_cells,
                            const unsigned int n_levels,
                            const MPI_Comm     communicator);
} // namespace Friction

#endif

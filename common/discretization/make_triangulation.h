#ifndef friction_discretization_make_triangulation_h
#define friction_discretization_make_triangulation_h

#include <deal.II/grid/tria.h>

#include <memory>

namespace Friction
{
  using namespace dealii;

  /**
   * An empty mesh of the kind that the multigrid method needs: with a hierarchy
   * of levels on all processes, and levels of cells at a vertex that differ by
   * one at most.
   *
   * Several processes share a parallel::distributed::Triangulation. One process
   * has a plain one, without p4est, which is refined in the same way and, but
   * for new vertices on curved surfaces, in less than half of the time.
   *
   * @param for_checkpoints  whether the mesh is to be saved or loaded, which
   *   only p4est can do, for any number of processes.
   */
  template <int dim>
  std::unique_ptr<Triangulation<dim>>
  make_triangulation(const MPI_Comm communicator    = MPI_COMM_WORLD,
                     const bool     for_checkpoints = false);
} // namespace Friction

#endif

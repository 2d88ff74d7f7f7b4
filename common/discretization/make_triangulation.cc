#include <common/compatibility.h>
#include <common/discretization/make_triangulation.h>

#include <deal.II/base/mpi.h>

#include <deal.II/distributed/tria.h>

namespace Friction
{
  template <int dim>
  std::unique_ptr<Triangulation<dim>>
  make_triangulation(const MPI_Comm communicator, const bool for_checkpoints)
  {
    const auto smoothing =
      Triangulation<dim>::limit_level_difference_at_vertices;
    if (Utilities::MPI::n_mpi_processes(communicator) == 1 && !for_checkpoints)
      return std::make_unique<Compatibility::UndividedTriangulation<dim>>(
        communicator, smoothing);

    using Distributed = parallel::distributed::Triangulation<dim>;
    return std::make_unique<Distributed>(
      communicator, smoothing, Distributed::construct_multigrid_hierarchy);
  }



  template std::unique_ptr<Triangulation<2>> make_triangulation(const MPI_Comm,
                                                                const bool);
  template std::unique_ptr<Triangulation<3>> make_triangulation(const MPI_Comm,
                                                                const bool);
} // namespace Friction

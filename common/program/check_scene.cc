#include <common/algorithms/initial_guess.h>
#include <common/algorithms/nested_iteration.h>
#include <common/output/warnings.h>
#include <common/printable.h>
#include <common/program/check_scene.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace Friction
{
  template <int dim>
  void
  check_scene(const Parameters &parameters,
              std::ostream     &out,
              const MPI_Comm    communicator)
  {
    NestedIteration<dim> nest(parameters, {}, communicator);
    nest.begin();
    VectorType guess;
    nest.make_guess(guess);

    const Discretization<dim>     &discretization = nest.discretization();
    const std::vector<std::string> warnings =
      warnings_at_start(discretization, parameters);

    double smallest_gap = std::numeric_limits<double>::max();
    for (const ContactNode<dim> &p : discretization.contact())
      smallest_gap = std::min(smallest_gap, p.gap);
    smallest_gap = Utilities::MPI::min(smallest_gap, communicator);
    const unsigned int n_nodes =
      Utilities::MPI::sum(discretization.contact().size(), communicator);
    const auto n_cells = nest.mesh().n_global_active_cells();
    if (Utilities::MPI::this_mpi_process(communicator) != 0)
      return;

    for (const std::string &warning : warnings)
      out << warning << '\n';
    std::string ids;
    for (const auto id : nest.mesh().get_boundary_ids())
      ids += (ids.empty() ? "" : ", ") + std::to_string(id);
    out << "Scene '" << parameters.name << "': " << nest.mesh().n_cells(0)
        << (nest.mesh().n_cells(0) == 1 ? " coarse cell" : " coarse cells")
        << " with boundary ids " << ids << "; the first mesh has "
        << counted(n_cells, "cell", "cells") << " and "
        << discretization.dof_handler().n_dofs() << " degrees of freedom.\n";
    if (n_nodes > 0)
      out << n_nodes << " of its nodes may touch the obstacle; the nearest is "
          << smallest_gap + 0. << " away from it.\n";
    out << "Nothing has been solved or written; without --check the scene "
        << (warnings.empty() ? "runs as it is."
                             : "would run in spite of the warnings above.")
        << std::endl;
  }



  template void
  check_scene<2>(const Parameters &, std::ostream &, const MPI_Comm);
  template void
  check_scene<3>(const Parameters &, std::ostream &, const MPI_Comm);
} // namespace Friction

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

    const Discretization<dim> &discretization = nest.discretization();
    std::vector<std::string>   warnings       = warnings_at_start(
      discretization, parameters, warnings_about_loads(discretization));
    // A run says this in the end, of its last mesh.
    for (const std::string &warning :
         warnings_about_regions(discretization, "first"))
      warnings.push_back(warning);

    const auto               &conditions = nest.scene().contact_conditions();
    std::vector<double>       smallest_gaps(conditions.size(),
                                      std::numeric_limits<double>::max());
    std::vector<unsigned int> n_nodes(conditions.size(), 0);
    for (const ContactNode<dim> &p : discretization.contact())
      {
        smallest_gaps[p.condition] =
          std::min(smallest_gaps[p.condition], p.gap);
        ++n_nodes[p.condition];
      }
    for (unsigned int i = 0; i < conditions.size(); ++i)
      {
        smallest_gaps[i] = Utilities::MPI::min(smallest_gaps[i], communicator);
        n_nodes[i]       = Utilities::MPI::sum(n_nodes[i], communicator);
      }
    const auto n_cells = nest.mesh().n_global_active_cells();
    // Boundary ids are gathered from all processes, so each of them asks.
    const auto boundary_ids = nest.mesh().get_boundary_ids();
    if (Utilities::MPI::this_mpi_process(communicator) != 0)
      return;

    for (const std::string &warning : warnings)
      out << warning << '\n';
    std::string ids;
    for (const auto id : boundary_ids)
      ids += (ids.empty() ? "" : ", ") + std::to_string(id);
    out << "Scene '" << parameters.name << "': " << nest.mesh().n_cells(0)
        << (nest.mesh().n_cells(0) == 1 ? " coarse cell" : " coarse cells")
        << " with boundary ids " << ids << "; the first mesh has "
        << counted(n_cells, "cell", "cells") << " and "
        << discretization.dof_handler().n_dofs() << " degrees of freedom.\n";
    for (unsigned int i = 0; i < conditions.size(); ++i)
      if (n_nodes[i] > 0)
        out << n_nodes[i] << " of its nodes may touch "
            << (conditions.size() == 1
                  ? "the obstacle"
                  : "'" + conditions[i].obstacle_section() + "'")
            << "; the nearest is " << smallest_gaps[i] + 0.
            << " away from it.\n";
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

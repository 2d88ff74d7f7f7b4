// Messages of the program around the library, and those of an exchange of
// ghosts that has been moved to another place.
//
// - A message that the program has sent, with the tag that the library uses, is
//   not taken for one of the library's while matrices of levels are made and a
//   problem is solved, and the program gets it in the end.
// - An exchange that has been moved brings the same values as one that stays
//   where it is. It cannot be copied, and not be moved while messages are on
//   their way, which an assertion sees to.

#include <common/algorithms/contact_solver.h>
#include <common/parallel/ghost_exchange.h>

#include <iostream>
#include <type_traits>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

static_assert(!std::is_copy_constructible<GhostExchange>::value &&
                !std::is_copy_assignable<GhostExchange>::value,
              "Messages that are on their way have one address only.");

namespace test_messages
{
  void
  test_foreign_messages(const Discretized<2> &d, const SolverSettings &settings)
  {
    const int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const int n    = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);

    // As level_matrices.cc numbers its own.
    constexpr int tag      = 4712;
    const double  sent     = 100. + rank;
    double        received = 0.;
    MPI_Request   request;
    MPI_Isend(
      &sent, 1, MPI_DOUBLE, (rank + 1) % n, tag, MPI_COMM_WORLD, &request);

    VectorType       u = admissible_start(d);
    ContactState     state(d.contact().size(), d.problem().has_friction());
    ContactSolver<2> solver(d, settings);
    check_everywhere(solver.solve(u, state).converged, "the problem is solved");

    const int left = (rank + n - 1) % n;
    MPI_Recv(
      &received, 1, MPI_DOUBLE, left, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
    check_everywhere(received == 100. + left,
                     "and the message has waited for the program");
  }



  void
  test_moved_exchange(const Discretized<2> &d)
  {
    const LevelHierarchy<2> hierarchy(
      d.dof_handler(), d.constraints(), d.stiffness().blocks());
    const auto &level = hierarchy.level(hierarchy.n_levels() - 2);
    const int   rank  = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);

    std::vector<double> stays(level.n_local_nodes(), -1.);
    for (unsigned int node = 0; node < level.n_nodes(); ++node)
      stays[node] = 1000. * rank + node;
    const std::vector<double> before = stays;
    std::vector<double>       moves  = stays;

    GhostExchange exchange(level.numbering(), level.coupled_ghosts());
    exchange.update(stays.data(), 1);

    GhostExchange first(level.numbering(), level.coupled_ghosts());
    GhostExchange second(std::move(first));
    GhostExchange third;
    third = std::move(second);
    third.update(moves.data(), 1);

    check_everywhere(!level.coupled_ghosts().empty() && stays != before,
                     "every process has ghosts");
    check_everywhere(moves == stays, "and gets the values of all of them");
  }
} // namespace test_messages



TEST(messages)
{
  Parameters p = block_parameters<2>(FrictionLaw::coulomb, .4);
  p.refinement.initial_refinements = 4;
  const Scene<2> scene(p);
  const auto     mesh = make_triangulation<2>();
  scene.make_coarse_mesh(*mesh);
  mesh->refine_global(p.refinement.initial_refinements);
  const Discretized<2> d(scene, *mesh);

  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << "Messages of the program" << std::endl;
  test_foreign_messages(d, p.solver);
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << "An exchange that is moved" << std::endl;
  test_moved_exchange(d);
}

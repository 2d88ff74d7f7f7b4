// A contact problem by the installed library: a scene file, one mesh, one
// solution.

#include <common/discretization/discretization.h>
#include <common/algorithms/coulomb_solver.h>

#include <iostream>

int
main(int argc, char **argv)
{
  using namespace Friction;
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Parameters                 parameters = read_parameters(argv[1], {});
  const Scene<2>                   scene(parameters);
  const auto                       mesh = make_triangulation<2>();
  scene.make_coarse_mesh(*mesh);
  mesh->refine_global(4);

  const Discretized<2> problem(scene, *mesh);
  VectorType              u     = admissible_start(problem);
  ContactState            state = ContactState(problem.contact().size(), problem.problem().has_friction());
  CoulombSolver<2>        solver(
    *problem.hierarchy, problem.problem(), parameters.solver);
  const SolverReport report = solver.solve(u, state);
  std::cout << state.n_contact() << " nodes in contact, " << state.n_sticking()
            << " of them stick, "
            << (report.converged ? "solved" : "not solved") << std::endl;
}

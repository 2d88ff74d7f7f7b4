// A contact problem by the installed library: a scene file, one mesh, one
// solution.

#include <common/algorithms/contact_solver.h>
#include <common/algorithms/initial_guess.h>

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

  Discretization<2> discretization(scene, *mesh);
  discretization.set_up();
  discretization.assemble(elasticity<2>(scene.materials()));

  VectorType       u     = discretization.vector(), no_tractions(u);
  ContactState     state = make_initial_guess(discretization, u, no_tractions);
  ContactSolver<2> solver(discretization, parameters.solver);
  const SolverReport report = solver.solve(u, state);
  std::cout << state.n_contact() << " nodes in contact, " << state.n_sticking()
            << " of them stick, "
            << (report.converged ? "solved" : "not solved") << std::endl;
}

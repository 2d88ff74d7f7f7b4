// Newton's method for the laws of contact and friction. Where Algorithm 3 or,
// for convex problems, the multigrid iteration arrives, it finds the same
// solution, in a few steps: without friction, with Tresca's and with Coulomb's,
// on adaptive meshes with hanging nodes, in two and three dimensions, where
// slip is partly prescribed and where it counts from an earlier load step. It
// finds solutions that fulfil the law where friction is so strong that the
// others arrive nowhere. Linear problems take a number of iterations that
// hardly depends on the mesh.

#include <common/algorithms/nested_iteration.h>
#include <common/algorithms/newton_solver.h>
#include <common/input_error.h>
#include <common/iteration/multigrid_newton_step.h>

#include <tests/support/check.h>
#include <tests/support/test.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

using namespace dealii;
using namespace Friction;
using Tests::check_everywhere;

namespace test_newton_solver
{
  using Entries = std::vector<std::string>;

  template <int dim>
  Parameters
  scene(const std::string &name, const Entries &entries)
  {
    const std::string folder = dim == 2 ? SCENES_DIR : SCENES_3D_DIR;
    return read_parameters(folder + "/" + name + ".prm", entries);
  }



  struct Outcome
  {
    bool         converged   = true;
    double       difference  = 0; // to the accepted solution, relative
    double       certificate = 0;
    unsigned int steps = 0, n_problems = 0, iterations_per_step = 0;
  };



  // Solves with Newton's method from the guess of the present mesh. The
  // difference to @p other is a relative one.
  template <int dim>
  void
  add_newton(Outcome              &outcome,
             NestedIteration<dim> &nest,
             const VectorType     *other,
             VectorType           &u,
             ContactState         &state)
  {
    const Discretization<dim>  &d       = nest.discretization();
    const DiscreteProblem<dim> &problem = d.problem();
    state                               = nest.make_guess(u);
    const TrescaFunctional<dim> functional(problem);
    const MonotoneSmoother<dim> smoother(problem);
    Levels<dim>                 levels(d.dof_handler(), problem);
    TruncatedCorrection<dim>    correction(levels, Cycle::V, 6);
    MultigridNewtonStep<dim>    step(problem, smoother, levels, correction, 3);
    NewtonSolver<dim>           solver(functional, step);
    const MultigridResult       result = solver.solve(u, state, {});
    SolverReport                report;
    certify(report, functional, u, state);

    outcome.converged = outcome.converged && result.converged;
    outcome.certificate =
      std::max(outcome.certificate, report.certificate.largest());
    outcome.steps += solver.n_steps();
    ++outcome.n_problems;
    outcome.iterations_per_step = std::max<unsigned int>(
      outcome.iterations_per_step, result.cycles.size() / solver.n_steps());
    if (other == nullptr)
      return;
    double difference = 0;
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      if (!d.constraints().is_hanging(i / dim))
        difference = std::max(
          difference, std::abs(u.local_element(i) - other->local_element(i)));
    const MPI_Comm comm = problem.communicator();
    outcome.difference =
      std::max(outcome.difference,
               Utilities::MPI::max(difference, comm) / other->linfty_norm());
  }



  // On all meshes and in all load steps of a scene. Steps are counted on the
  // average: where a node turns from one direction of slip to the other, a step
  // may pass the law's kink again and again until it has become short, and
  // whether it does is decided by rounding. A load step of the scene mindlin
  // with three nodes in contact takes 4 to 12.
  template <int dim>
  void
  test_agreement(const std::string &what,
                 const std::string &name,
                 const Entries     &entries)
  {
    NestedIteration<dim> nest(scene<dim>(name, entries));
    Outcome              outcome;
    nest.begin();
    do
      do
        {
          VectorType   by_newton, u;
          ContactState by_newton_state(0, false), state(0, false);
          nest.solve_with(nest.parameters().solver, u, state);
          add_newton(outcome, nest, &u, by_newton, by_newton_state);
          nest.solve();
      } while (nest.advance());
    while (nest.begin_next_load_step());
    std::cout << what << std::endl;
    check_everywhere(outcome.converged, "converges");
    check_everywhere(outcome.difference < 1e-7, "to the same solution");
    check_everywhere(outcome.certificate < 1e-6, "that fulfils the law");
    check_everywhere(outcome.steps <= 6 * outcome.n_problems,
                     "in six steps on the average");
    check_everywhere(outcome.iterations_per_step <= 12,
                     "of 12 iterations at most");
  }



  // Where others arrive nowhere.
  void
  test_much_friction()
  {
    std::cout << "much friction" << std::endl;
    NestedIteration<2> nest(scene<2>(
      "raous", {"Contact/Friction coefficient=100", "Refinement/Levels=3"}));
    Outcome            outcome;
    unsigned int       failures = 0;
    nest.begin();
    do
      {
        SolverSettings plain = nest.parameters().solver;
        plain.safeguards     = false;
        VectorType   u;
        ContactState state(0, false);
        failures += !nest.solve_with(plain, u, state).converged;
        add_newton<2>(outcome, nest, nullptr, u, state);
        SolverReport report;
        nest.accept(
          u, state, nest.solve_with(nest.parameters().solver, u, state));
    } while (nest.advance());
    check_everywhere(failures > 0, "Algorithm 3 does not arrive");
    check_everywhere(outcome.converged, "Newton's method does");
    check_everywhere(outcome.certificate < 1e-6, "and fulfils the law");
    check_everywhere(outcome.iterations_per_step <= 6,
                     "in steps of six iterations at most");
  }
} // namespace test_newton_solver



TEST(newton_solver)
{
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  const Entries adaptive   = {"Refinement/Strategy=adaptive",
                              "Refinement/Levels=4"};
  const Entries adaptive_3 = {"Refinement/Strategy=adaptive",
                              "Refinement/Levels=1"};
  const auto    with       = [](Entries entries, const std::string &entry) {
    entries.push_back(entry);
    return entries;
  };
  test_agreement<2>(
    "no friction", "block", with(adaptive, "Contact/Friction law=none"));
  test_agreement<2>("Tresca", "tresca", {"Refinement/Levels=2"});
  test_agreement<2>("Coulomb", "block", adaptive);
  test_agreement<2>("load steps",
                    "mindlin",
                    {"Refinement/Levels=2",
                     "Load steps/Times=0, 1, 2, 4",
                     "Solver/Inner tolerance=1e-9"});
  test_agreement<3>(
    "no friction, 3D", "block", with(adaptive_3, "Contact/Friction law=none"));
  test_agreement<3>("Coulomb, 3D", "block", adaptive_3);
  test_agreement<3>("rods", "cylinder", {"Refinement/Levels=1"});
  test_much_friction();
}

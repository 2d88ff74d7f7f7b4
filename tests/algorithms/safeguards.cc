// What happens when an iteration is getting nowhere. Part by part: stalling is
// noticed, and slow progress is not taken for it; mixing finds the fixed point
// of a map that throws everything away from it; algebraic corrections solve
// what coarse levels do not help with; and the chain of all of them finds
// solutions where the first attempt fails, says what it did, and says so if it
// failed.

#include <common/algorithms/mixed_fixed_point.h>
#include <common/algorithms/nested_iteration.h>
#include <common/algorithms/safeguarded_solver.h>

#include <Eigen/LU>

#include <functional>
#include <iostream>

#include <tests/support/check.h>

#include "../support/random_problem.h"
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_safeguards
{
  void
  test_stalling()
  {
    std::cout << "Stalling" << std::endl;
    using Sequence       = std::function<double(const unsigned int)>;
    const auto stalls_at = [](const Sequence    &increment,
                              const unsigned int patience  = 50,
                              const Sequence    &truncated = nullptr) {
      MultigridResult result;
      for (unsigned int cycle = 0; cycle < 200; ++cycle)
        {
          CycleInfo info = {};
          info.increment = increment(cycle);
          info.truncated = truncated ? truncated(cycle) : 0.;
          result.cycles.push_back(info);
          if (info.increment <= 1e-9)
            return 0u;
          if (result.stalls(1e-9, 200, patience))
            return cycle + 1;
        }
      return 200u;
    };
    check(stalls_at([](const unsigned int) { return 1e-3; }) == 50,
          "constant increments are given up after 50 cycles");
    check(stalls_at([](const unsigned int c) { return c % 2 ? 1e-2 : 1e-3; }) ==
            50,
          "so are increments that go to and fro");
    check(stalls_at([](const unsigned int c) { return std::pow(.89, c); }) == 0,
          "a contraction of 0.89 per cycle is not");
    check(stalls_at([](const unsigned int c) { return std::pow(.95, c); }) ==
            50,
          "one of 0.95 is, as it would take 400 cycles");
    check(stalls_at([](const unsigned int c) {
            return c < 40 ? 1e-2 : 1e-2 * std::pow(.5, c - 40.);
          }) == 0,
          "forty cycles to find the contact zone are granted");
    check(stalls_at([](const unsigned int c) { return c % 2 ? 1e-2 : 1e-3; },
                    15) == 15,
          "with less patience going to and fro is given up after 15 cycles");
    check(
      stalls_at([](const unsigned int c) { return std::pow(.89, c); }, 15) == 0,
      "and a contraction of 0.89 is not");
    const auto constant = [](const unsigned int) { return 1e-3; };
    check(stalls_at(
            constant,
            50,
            [](const unsigned int c) { return std::min(2. * c, 150.); }) == 86,
          "nor is a contact zone that grows, until it has its size");
    check(stalls_at(constant,
                    50,
                    [](const unsigned int c) { return c % 2 ? 100. : 0.; }) ==
            50,
          "phases that go to and fro are");
  }



  // tau -> M tau + b with eigenvalues 3, -5 and 0.5.
  void
  test_mixing()
  {
    std::cout << "Mixing" << std::endl;
    Eigen::Matrix3d V;
    V << 1, 2, 0, 0, 1, 1, 1, 0, 1;
    const Eigen::Matrix3d M =
      V * Eigen::Vector3d(3, -5, .5).asDiagonal() * V.inverse();
    const Eigen::Vector3d solution(1, 2, 3);
    const auto            iterate = [&](const unsigned int depth) {
      MixedFixedPoint     fixed_point(depth, .5, MPI_COMM_WORLD);
      std::vector<double> tau = {1.1, 1.9, 3.2};
      for (unsigned int i = 0; i < 8; ++i)
        {
          const Eigen::Vector3d found =
            solution + M * (Eigen::Vector3d(tau.data()) - solution);
          tau = fixed_point.next(tau, {found(0), found(1), found(2)});
        }
      return (Eigen::Vector3d(tau.data()) - solution).norm();
    };
    check(iterate(0) > 10., "the damped iteration leaves the fixed point");
    check_below(iterate(3), 1e-8, "mixed from three steps it is found");
  }



  template <int dim>
  SolverReport
  solve(const Parameters &parameters, VectorType &u, ContactState &state)
  {
    const Scene<dim> scene(parameters);
    const auto       mesh = make_triangulation<dim>();
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(parameters.refinement.initial_refinements);
    const Discretized<dim> d(scene, *mesh);
    u     = admissible_start(d);
    state = ContactState(d.contact().size(), d.problem().has_friction());
    ContactSolver<dim> solver(d, parameters.solver);
    return solver.solve(u, state);
  }



  // Cells that are a hundred times shorter in two directions than in the third,
  // with a mean volumetric strain of a material for which no planes are found:
  // there lines are of no help. The body is small enough for its contact nodes
  // alone; without that, algebraic corrections have to do it.
  void
  test_long_cells(const FrictionLaw law)
  {
    std::cout << "Long cells, " << (law == FrictionLaw::none ? "no " : "")
              << "friction" << std::endl;
    Parameters p            = block_parameters<3>(law, .4);
    p.scene.size            = {100., 1., 1.};
    p.scene.subdivisions    = {1, 1, 1};
    p.scene.distortion      = 0.;
    p.material              = Material(1., .45, VolumetricStrain::mean);
    p.solver.maximum_cycles = 60;
    p.refinement.initial_refinements = 3;
    VectorType         u, v;
    ContactState       state(0, false), other(0, false);
    const SolverReport report         = solve<3>(p, u, state);
    const auto         is_solved_soon = [](const SolverReport &report) {
      check(report.converged && report.cycles.size() <= 80,
            "it is solved soon");
      std::cout << report.attempts.size() << " attempts, the last one: "
                << (report.attempts.empty() ? "" : report.attempts.back().name)
                << std::endl;
    };
    is_solved_soon(report);
    p.solver.condensation = CondensationUse::never;
    is_solved_soon(solve<3>(p, v, other));
    check_below(relative_distance(u, v), 1e-6, "displacements agree");

    // The same by patience.
    p.solver.safeguards       = false;
    p.solver.maximum_cycles   = 5000;
    p.solver.recombined_steps = 20;
    check(solve<3>(p, v, other).converged, "so it is by patience");
    check_below(relative_distance(u, v), 1e-6, "displacements agree");
  }



  // Much friction, for which the iteration goes to and fro. What one mesh has
  // needed the next one begins with.
  void
  test_much_friction(const bool condensation)
  {
    std::cout << "Much friction" << std::endl;
    NestedIteration<2> nest(
      read_parameters(SCENES_DIR "/raous.prm",
                      {"Contact/Friction coefficient=10",
                       std::string("Solver/Condensation=") +
                         (condensation ? "where cycles are many" : "never")}));
    nest.begin();
    unsigned int failures = 0, solved = 0, most_cycles = 0, n_attempts = 0;
    std::string  last;
    do
      {
        VectorType   u;
        ContactState state(0, false);
        failures +=
          !nest
             .solve_with(without_safeguards(nest.parameters().solver), u, state)
             .converged;
        solved += nest.solve().converged;
        most_cycles =
          std::max<unsigned int>(most_cycles, nest.report().cycles.size());
        n_attempts = nest.report().attempts.size();
        if (n_attempts > 0)
          last = nest.report().attempts.back().name;
    } while (nest.advance());
    check(failures > 0, "without safeguards there are meshes without solution");
    check(solved == nest.parameters().refinement.levels + 1,
          "with them there is one on all meshes");
    std::cout << "found by " << last << std::endl;
    check(n_attempts == 1, "on the last mesh at once");
    check(most_cycles <= 25, "in 25 cycles at most");
  }



  // Much friction, and a material that hardly changes its volume: levels are of
  // little use to any method, and contact nodes alone come first.
  void
  test_much_friction_and_little_volume()
  {
    std::cout << "Much friction, nearly incompressible" << std::endl;
    Parameters         p = read_parameters(SCENES_DIR "/hertz.prm",
                                   {"Contact/Friction coefficient=1.7",
                                            "Material/Poisson ratio=0.4985",
                                            "Material/Volumetric strain=mean",
                                            "Refinement/Initial refinements=4"});
    VectorType         u, v;
    ContactState       state(0, false), other(0, false);
    const SolverReport report = solve<2>(p, u, state);
    check(report.converged && report.attempts.size() == 1,
          "it is solved at the first attempt");
    if (!report.attempts.empty())
      std::cout << report.attempts[0].name << std::endl;
    p.solver.condensation = CondensationUse::never;
    check(solve<2>(p, v, other).converged, "and by others");
    check_below(relative_distance(u, v), 1e-6, "displacements agree");
  }



  // A material that hardly changes its volume, with levels: Algorithm 3
  // goes on where it was given up.
  void
  test_little_volume()
  {
    std::cout << "Nearly incompressible" << std::endl;
    Parameters         p = read_parameters(SCENES_DIR "/block.prm",
                                   {"Material/Poisson ratio=0.4999",
                                            "Material/Volumetric strain=mean",
                                            "Refinement/Initial refinements=4",
                                            "Solver/Inner tolerance=1e-9",
                                            "Solver/Maximum cycles=80",
                                            "Solver/Condensation=never"});
    VectorType         u, v;
    ContactState       state(0, false), other(0, false);
    const SolverReport report = solve<2>(p, u, state);
    check(report.converged, "it is solved");
    for (const SolverAttempt &attempt : report.attempts)
      std::cout << attempt.name << std::endl;
    check(report.next_method == Method::algorithm,
          "and the next mesh begins with that");
    p.solver.condensation        = CondensationUse::where_cycles_are_many;
    const SolverReport condensed = solve<2>(p, v, other);
    check(condensed.converged && condensed.attempts.size() == 1 &&
            condensed.next_method == Method::algorithm,
          "it is at the first attempt");
    if (!condensed.attempts.empty())
      std::cout << condensed.attempts[0].name << std::endl;
    check_below(relative_distance(u, v), 1e-6, "displacements agree");
  }



  // All of a long side comes into contact, of which the guess touches nothing:
  // that is too much for contact nodes alone, where one gives up, but says
  // nothing against any method.
  void
  test_unforeseen_contact()
  {
    std::cout << "Unforeseen contact" << std::endl;
    const Parameters p =
      read_parameters(SCENES_DIR "/block.prm",
                      {"Scene/Size=128, 1",
                       "Scene/Subdivisions=128, 1",
                       "Refinement/Initial refinements=0",
                       "Obstacle/Point=0, -0.002",
                       "Boundary conditions/Displacement=3: 0.002, -0.01",
                       "Solver/Inner tolerance=1e-9",
                       "Solver/Condensation=where quicker"});
    VectorType         u;
    ContactState       state(0, false);
    const SolverReport report = solve<2>(p, u, state);
    check(report.converged && report.attempts.empty(),
          "it is solved over levels");
    check(report.next_method == Method::algorithm,
          "and the next mesh begins with that");
  }



  // No solution satisfies the laws to the last digit. If that is what is asked
  // for, everything is tried, and what is said in the end is that it was not
  // enough.
  void
  test_failure()
  {
    std::cout << "Failure" << std::endl;
    Parameters p = block_parameters<2>(FrictionLaw::coulomb, .4);
    p.solver.certificate_tolerance   = 1e-30;
    p.refinement.initial_refinements = 3;
    VectorType         u;
    ContactState       state(0, false);
    const SolverReport report = solve<2>(p, u, state);
    check(!report.converged, "it is not solved");
    for (const SolverAttempt &attempt : report.attempts)
      std::cout << attempt.name << std::endl;
    check_below(report.certificate.largest(), 1e-8, "almost it is");
  }
} // namespace test_safeguards



TEST(safeguards)
{
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  test_stalling();
  test_mixing();
  test_long_cells(FrictionLaw::coulomb);
  test_long_cells(FrictionLaw::none);
  test_much_friction(false);
  test_much_friction(true);
  test_much_friction_and_little_volume();
  test_little_volume();
  test_unforeseen_contact();
  test_failure();
}

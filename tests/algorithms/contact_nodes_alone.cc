// CondensedSolver, which has CoulombSolver, Newton's method or, in two
// dimensions, complementary pivoting for the condensed problem, against
// CoulombSolver with corrections from the whole matrix, which shares the
// relaxation but neither matrix nor factors: the same displacements, normal
// forces and phases, for all laws of friction, on curved bodies and meshes with
// hanging nodes, on any number of processes; the second call has nothing left
// to do. Histories and platens come out the same with and without it. Where it
// knows that coarse levels will not do, SafeguardedSolver begins with it; and
// on small meshes, where no levels are made then.
//
// The guess of a long block touches nowhere: of its contact nodes a few are
// kept, and more and more of them until all that touch are, with the same
// solution as if all had been kept from the beginning; also if the first few
// cannot hold the body, which then runs away.

#include <common/algorithms/condensed_solver.h>
#include <common/algorithms/contact_solver.h>
#include <common/algorithms/nested_iteration.h>
#include <common/iteration/algebraic_correction.h>
#include <common/levels/aggregate_levels.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_contact_nodes_alone
{
  template <int dim>
  void
  test(const Parameters &parameters, const FrictionLaw law, Random &random)
  {
    const RandomProblem<dim>   whole(parameters, 3, .5, random);
    const DiscreteProblem<dim> problem =
      whole.friction_problem(law == FrictionLaw::none ? 0. : .4, law);
    SolverSettings settings;
    settings.inner_tolerance = 1e-11;
    const CoulombSettings limits(settings);

    const TrescaFunctional<dim> functional(problem);
    const MonotoneSmoother<dim> smoother(problem);
    Linearization<dim>       linearization(problem, TruncationVariant::phases);
    AlgebraicCorrection<dim> correction(problem, CoarsestMethod::direct);
    LineSearch<dim>          line_search(functional, 1., 0);
    MonotoneMultigrid<dim>   iteration(
      functional, smoother, linearization, correction, line_search);

    VectorType   u = admissible_start(whole.discretization);
    ContactState state(problem.contact.size(), problem.has_friction());
    for (unsigned int p = 0; p < state.size(); ++p)
      state.set_normal_force(p, 1e-3 * problem.contact[p].measure);
    const VectorType   start       = u;
    const ContactState start_state = state;
    check_everywhere(
      CoulombSolver<dim>(iteration, limits).solve(u, state).converged,
      "  solved by the whole matrix");

    using By                         = typename CondensedSolver<dim>::By;
    VectorType           guess       = start;
    ContactState         guess_state = start_state;
    CondensedSolver<dim> condensed(
      problem,
      node_positions(whole.discretization.dof_handler(), problem.constraints),
      settings,
      Iterate(guess, guess_state));
    check_everywhere(condensed.is_worthwhile(24.), "  the body is small");
    for (const std::string by :
         {"", "Newton's method", "Algorithm 2", "pivoting"})
      {
        if (dim == 3 && by == "pivoting")
          continue;
        CoulombSettings its_limits(limits);
        if (by == "Algorithm 2")
          {
            its_limits.algorithm       = Algorithm::fixed_point;
            its_limits.outer_tolerance = 1e-11;
          }
        const By     method = by == "pivoting" ? By::pivoting
              : by == "Newton's method"        ? By::newton_solver
                                               : By::coulomb_solver;
        VectorType   v      = start;
        ContactState other  = start_state;
        const auto   solve  = [&]() {
          return condensed.solve(
            functional,
            Iterate(v, other, problem.has_coulomb_friction()),
            method,
            its_limits,
            {});
        };
        const SolverReport report = solve();
        check_everywhere(report.converged,
                         "  solved by contact nodes" +
                           (by.empty() ? "" : ", by " + by));
        check_everywhere(report.certificate.largest() < 1e-8,
                         "  and certified");
        check_everywhere(
          std::abs(report.cycles.back().energy / report.energy - 1) < 1e-10,
          "  cycles tell the energy of the body");
        check_everywhere(report.pace == 0.,
                         "  and nothing of cycles over levels");

        check_everywhere(relative_distance(v, u) < 1e-8,
                         "  the displacement is the same");
        check_everywhere(phases_agree(state, other), "  phases are");
        check_everywhere(relative_distance_of_forces(other, state) <= 1e-6,
                         "  and normal forces");

        // Pivoting begins with phases of its own.
        const VectorType   before  = v;
        const unsigned int n_again = solve().cycles.size();
        if (method != By::pivoting)
          check_everywhere(n_again <= 2, "  nothing is left to do");
        check_everywhere(relative_distance(v, before) < 1e-8,
                         "  and nothing is done");
      }
  }



  template <int dim>
  void
  test(Random &random)
  {
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << dim << "D" << std::endl;
    for (const FrictionLaw law :
         {FrictionLaw::none, FrictionLaw::tresca, FrictionLaw::coulomb})
      test<dim>(curved_parameters<dim>(FrictionLaw::coulomb, .4), law, random);
  }



  template <int dim>
  Parameters
  block_scene(const std::vector<std::string> &entries)
  {
    return read_parameters((dim == 2 ? SCENES_DIR "/" : SCENES_3D_DIR "/") +
                             std::string("block.prm"),
                           entries);
  }



  // Histories, in which slip has its origin where the load step before ended,
  // with sides that are held in one direction where they meet contact, and with
  // a force that a platen has to find its place for: the same with and without
  // condensation. The force is met to a millionth.
  template <int dim>
  void
  test_history(const std::string       &name,
               std::vector<std::string> entries,
               const double             bound = 1e-7)
  {
    for (const std::string &entry :
         {std::string("Refinement/Initial refinements=") +
            (dim == 2 ? "2" : "1"),
          std::string("Material/Regions=where abs(") + (dim == 2 ? "y" : "z") +
            " - 0.33) < 0.1: 1e3*E, nu",
          std::string("Solver/Inner tolerance=1e-11"),
          std::string("Load steps/Times=1, 2, 3")})
      entries.push_back(entry);
    std::vector<VectorType> found[2];
    bool                    converged = true, is_condensed = true;
    for (const bool condensation : {false, true})
      {
        entries.push_back(std::string("Solver/Condensation=") +
                          (condensation ? "where cycles are many" : "never"));
        NestedIteration<dim> nest(block_scene<dim>(entries));
        nest.begin();
        do
          {
            const SolverReport &report = nest.solve();
            converged                  = converged && report.converged;
            for (const SolverAttempt &attempt : report.attempts)
              is_condensed = is_condensed &&
                (attempt.name == "Algorithm 3 on contact nodes alone") ==
                  condensation;
            is_condensed =
              is_condensed && !(condensation && report.attempts.empty());
            found[condensation].push_back(nest.displacement());
        } while (nest.begin_next_load_step());
        entries.pop_back();
      }
    double distance = 0;
    for (unsigned int step = 0; step < found[0].size(); ++step)
      distance =
        std::max(distance, relative_distance(found[1][step], found[0][step]));
    check_everywhere(converged && found[0].size() == 3, name + ": solved");
    check_everywhere(is_condensed, "  on contact nodes alone");
    check_everywhere(distance < bound, "  displacements are the same");
  }



  template <int dim>
  void
  test_growing_zone(const std::string              &name,
                    const std::vector<std::string> &entries)
  {
    std::vector<std::string> all = {
      "Solver/Inner tolerance=1e-11",
      "Refinement/Initial refinements=0",
      "Boundary conditions/Displacement=" +
        std::string(dim == 2 ? "3: 0.002, -0.01" : "5: 0.002, 0, -0.01"),
      "Obstacle/Point=" + std::string(dim == 2 ? "0, -0.002" : "0, 0, -0.002")};
    all.insert(all.end(), entries.begin(), entries.end());
    NestedIteration<dim> nest(block_scene<dim>(all));
    nest.begin();
    const Discretization<dim>  &d        = nest.discretization();
    const DiscreteProblem<dim>  problem  = d.problem();
    const SolverSettings       &settings = nest.parameters().solver;
    const TrescaFunctional<dim> functional(problem);
    const CoulombSettings       limits(settings);

    // From a guess that touches nowhere, and from one that does everywhere.
    VectorType   u[2]     = {admissible_start(d), admissible_start(d)};
    ContactState state[2] = {ContactState(problem.contact.size(), true),
                             ContactState(problem.contact.size(), true)};
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      state[1].set(p, true, false);
    std::size_t memory[2];
    for (unsigned int k = 0; k < 2; ++k)
      {
        CondensedSolver<dim> condensed(
          problem,
          node_positions(d.dof_handler(), problem.constraints),
          settings,
          Iterate(u[k], state[k]));
        const SolverReport report =
          condensed.solve(functional,
                          Iterate(u[k], state[k], true),
                          CondensedSolver<dim>::By::coulomb_solver,
                          limits,
                          {});
        check_everywhere(
          report.converged && report.certificate.largest() < 1e-8,
          (k == 0 ? name + ": " : "  ") + "solved from a guess" +
            (k == 0 ? " that touches nowhere" : " that touches"));
        memory[k] = condensed.memory_consumption();
      }
    check_everywhere(relative_distance(u[0], u[1]) < 1e-9,
                     "  displacements are the same");
    check_everywhere(phases_agree(state[0], state[1]), "  phases are");
    const bool fewer = memory[0] < memory[1];
    check_everywhere(fewer == (name == "a long block on one of its ends"),
                     std::string("  ") + (fewer ? "" : "not ") +
                       "by fewer nodes in the end");
  }



  // No level is made on a small mesh.
  template <int dim>
  void
  test_small_mesh()
  {
    VectorType found[2];
    for (const bool is_quicker : {false, true})
      {
        NestedIteration<dim> nest(
          block_scene<dim>({"Solver/Inner tolerance=1e-11",
                            std::string("Refinement/Initial refinements=") +
                              (dim == 2 ? "3" : "2"),
                            std::string("Solver/Condensation=where ") +
                              (is_quicker ? "quicker" : "cycles are many")}));
        nest.begin();
        const Discretization<dim> &d = nest.discretization();
        ContactSolver<dim>         solver(d, nest.parameters().solver);
        VectorType                &u     = found[is_quicker];
        ContactState               state = nest.make_guess(u);
        solver.prepare(u, state);
        const SolverReport report = solver.solve(u, state);
        check_everywhere(report.converged &&
                           report.attempts.empty() != is_quicker,
                         std::string("small mesh: solved on ") +
                           (is_quicker ? "contact nodes alone" : "levels"));
        check_everywhere(
          (solver.levels().memory_consumption() == 0) == is_quicker,
          std::string("  levels are ") + (is_quicker ? "not made" : "made"));
      }
    VectorType difference = found[0];
    difference -= found[1];
    check_everywhere(difference.linfty_norm() < 1e-9 * found[0].linfty_norm(),
                     "  displacements are the same");
  }



  // What the safeguards do on the first mesh of the scene "block".
  template <int dim>
  void
  test_safeguards(const std::string &name,
                  const std::string &entry,
                  const bool         is_hard,
                  const std::string &other = "")
  {
    std::vector<std::string> entries = {
      std::string("Refinement/Initial refinements=") + (dim == 2 ? "3" : "2"),
      entry};
    if (!other.empty())
      entries.push_back(other);
    NestedIteration<dim> nest(block_scene<dim>(entries));
    nest.begin();
    nest.solve();
    const SolverReport &report           = nest.report();
    const bool          on_contact_nodes = report.attempts.size() == 1 &&
      report.attempts[0].name == "Algorithm 3 on contact nodes alone";
    check_everywhere(report.converged &&
                       (is_hard ? on_contact_nodes : report.attempts.empty()),
                     name + (is_hard ? " is" : " is not") +
                       " solved on contact nodes alone");
  }
} // namespace test_contact_nodes_alone



TEST(contact_nodes_alone)
{
  Random random(1);
  test<2>(random);
  test<3>(random);
  const std::string to_and_fro = "(2 - t)*0.02, ";
  test_history<2>("history",
                  {"Boundary conditions/Displacement=3: " + to_and_fro +
                   "-0.02; 0: 0, free"});
  test_history<2>("platen",
                  {"Boundary conditions/Displacement=3: 0, -0.005",
                   "Boundary conditions/Force=3: (2 - t)*0.002, -0.02"},
                  1e-5);
  test_history<3>("history",
                  {"Boundary conditions/Displacement=5: " + to_and_fro +
                   "0.01, -0.02; 2: free, 0, free"});
  test_growing_zone<2>("a long block",
                       {"Scene/Size=8, 1", "Scene/Subdivisions=64, 4"});
  test_growing_zone<2>("a long block on one of its ends",
                       {"Scene/Size=8, 1",
                        "Scene/Subdivisions=64, 4",
                        "Obstacle/Normal=-0.05, -1"});
  test_growing_zone<2>("a long block that nothing else holds",
                       {"Scene/Size=8, 1",
                        "Scene/Subdivisions=64, 4",
                        "Obstacle/Normal=-0.001, -1",
                        "Boundary conditions/Displacement=3: 0, free",
                        "Boundary conditions/Traction=3: 0, -0.01"});
  test_growing_zone<3>("a long block",
                       {"Scene/Size=6, 1, 1", "Scene/Subdivisions=24, 2, 2"});
  test_small_mesh<2>();
  test_small_mesh<3>();
  const std::string layer = "Material/Regions=where abs(y - 0.33) < 0.1: ";
  test_safeguards<2>("a block", "Solver/Safeguards=true", false);
  test_safeguards<2>("one with a stiff layer", layer + "1e3*E, nu", true);
  test_safeguards<2>(
    "one with a layer that is hardly stiffer", layer + "3*E, nu", false);
  test_safeguards<2>("one that keeps its volume",
                     "Material/Poisson ratio=0.4999",
                     true,
                     "Material/Volumetric strain=mean");
}

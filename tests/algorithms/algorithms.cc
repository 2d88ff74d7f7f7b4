// Algorithms 2 and 3 find the same solution; a coefficient of zero is the same
// as no friction, and costs nothing; the initial guess of a finer mesh is
// admissible and a good one.
//
// In three dimensions there is more to choose from. On a mesh with nodes that
// hang on the contact boundary, below which there is a rod, so that normals
// point in all directions, everything that can be chosen about the solver leads
// to the same solution.

#include <common/algorithms/nested_iteration.h>
#include <common/contact/contact_forces.h>
#include <common/iteration/tresca_functional.h>

#include <cstring>
#include <iostream>

#include <tests/support/check.h>

#include "../support/random_problem.h"
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_algorithms
{
  double
  largest_difference(const VectorType &a, const VectorType &b)
  {
    double largest = 0;
    for (unsigned int i = 0; i < a.locally_owned_size(); ++i)
      largest =
        std::max(largest, std::abs(a.local_element(i) - b.local_element(i)));
    return largest;
  }



  bool
  same_bits(const VectorType &a, const VectorType &b)
  {
    return a.locally_owned_size() == b.locally_owned_size() &&
      std::memcmp(
        a.begin(), b.begin(), a.locally_owned_size() * sizeof(double)) == 0;
  }



  // On each level of the Hertz scene both algorithms start from the same
  // interpolated guess. (The first levels, where one node is in contact and
  // the mesh knows nothing of the contact zone, take part.)
  void
  compare_algorithms()
  {
    std::cout << "Algorithms 2 and 3" << std::endl;
    NestedIteration<2> iteration(without_safeguards(read_parameters(
      SCENES_DIR "/hertz.prm", {"Refinement/Maximum dofs=1500"})));
    iteration.begin();
    SolverSettings fixed_point      = iteration.parameters().solver;
    fixed_point.algorithm           = Algorithm::fixed_point;
    SolverSettings damped           = fixed_point;
    damped.outer_damping            = 0.5;
    damped.maximum_outer_iterations = 100;

    double       displacement = 0, force = 0, damped_displacement = 0;
    unsigned int outer     = 0;
    bool         converged = true, same = true, counted = true;
    do
      {
        iteration.solve();
        VectorType         u;
        ContactState       state(0, false);
        const SolverReport report = iteration.solve_with(fixed_point, u, state);
        converged =
          converged && iteration.report().converged && report.converged;
        outer        = std::max(outer, report.outer_iterations);
        displacement = std::max(
          displacement,
          largest_difference(u, iteration.displacement()) / u.linfty_norm());
        force = std::max(
          force,
          largest_difference(report.residual, iteration.report().residual) /
            report.residual.linfty_norm());
        same = same && phases_agree(state, iteration.state());

        counted =
          counted && report.outer_changes.size() == report.outer_iterations;

        const SolverReport slow = iteration.solve_with(damped, u, state);
        converged               = converged && slow.converged &&
          slow.outer_iterations >= report.outer_iterations;
        same                = same && phases_agree(state, iteration.state());
        damped_displacement = std::max(
          damped_displacement,
          largest_difference(u, iteration.displacement()) / u.linfty_norm());
    } while (iteration.advance());
    check(converged, "both converge on every level");
    check_below(displacement, 1e-6, "displacements agree to 1e-6");
    check_below(force, 1e-6, "nodal forces agree to 1e-6");
    check_below(damped_displacement, 1e-6, "and those of Algorithm 2, damped");
    check(same, "the states are the same");
    check_below(outer, 7, "Algorithm 2 takes at most 7 outer iterations");

    // The two numbers called rho_tau: the geometric mean of 1/10, 1/1000 and
    // 1/100000 is 1/1000, and each is a hundredth of the one before. A change
    // may vanish in the end.
    SolverReport known;
    known.outer_changes = {1e-1, 1e-3, 1e-5};
    SolverReport vanishing;
    vanishing.outer_changes = {1e-1, 0.};
    check(counted && std::abs(known.rho_tau_as_printed() / 1e-3 - 1) < 1e-12 &&
            std::abs(known.rho_tau_contraction() / 1e-2 - 1) < 1e-12 &&
            vanishing.rho_tau_contraction() == 0. &&
            vanishing.rho_tau_as_printed() >= 0.,
          "rho_tau, both ways");
  }



  void
  compare_in_3d()
  {
    Random                 random(3);
    const RandomProblem<3> fixture(
      curved_parameters<3>(FrictionLaw::coulomb, .4), 3, .3, random);
    const Discretization<3> &d = fixture.discretization;

    SolverSettings standard;
    standard.inner_tolerance = 1e-10;
    standard.outer_tolerance = 1e-9;
    std::vector<std::pair<std::string, SolverSettings>> choices;
    const auto add = [&](const std::string &name, const auto &change) {
      choices.emplace_back(name, standard);
      change(choices.back().second);
    };
    add("Algorithm 3", [](SolverSettings &) {});
    add("Algorithm 2",
        [](SolverSettings &s) { s.algorithm = Algorithm::fixed_point; });
    add("Uzawa's method in the local problems",
        [](SolverSettings &s) { s.local_solver = LocalSolver::uzawa; });
    add("algebraic corrections", [](SolverSettings &s) {
      s.coarse_correction = CoarseCorrection::algebraic;
    });
    add("W-cycles", [](SolverSettings &s) { s.cycle = Cycle::W; });
    add("no recombination", [](SolverSettings &s) { s.recombined_steps = 0; });
    add("no omega''", [](SolverSettings &s) {
      s.truncation = TruncationVariant::phases_without_second_order;
    });
    add("truncation of all nodes in contact",
        [](SolverSettings &s) { s.truncation = TruncationVariant::contact; });
    add("the monotone correction", [](SolverSettings &s) {
      s.coarse_correction = CoarseCorrection::monotone;
    });

    VectorType   solution, forces;
    ContactState states(0, false);
    for (const auto &choice : choices)
      {
        VectorType         u = admissible_start(d);
        ContactState       state(d.contact().size(), true);
        ContactSolver<3>   solver(d, without_safeguards(choice.second));
        const SolverReport report = solver.solve(u, state);
        if (solution.size() == 0)
          {
            solution = u;
            forces   = report.residual;
            states   = state;
            unsigned int n_hanging[2];
            for (const bool sticking : {false, true})
              n_hanging[sticking] =
                fixture.n_hanging_at_contact([&](const unsigned int p) {
                  return state.in_contact(p) && state.sticks(p) == sticking;
                });
            std::cout << "three dimensions, " << d.contact().size()
                      << " contact nodes, " << state.n_contact()
                      << " in contact, " << state.n_sticking() << " stick"
                      << std::endl;
            check(n_hanging[0] > 0 && n_hanging[1] > 0,
                  "nodes hang at sliding and at sticking nodes");
            check_below(report.certificate.largest(), 1e-8, "certified");
          }
        check(report.converged && phases_agree(state, states) &&
                largest_difference(u, solution) <=
                  1e-7 * solution.linfty_norm() &&
                largest_difference(report.residual, forces) <=
                  1e-7 * forces.linfty_norm(),
              choice.first);
      }
  }



  // Displacement and tractions interpolated from the coarser mesh.
  void
  compare_guesses()
  {
    std::cout << "initial guess" << std::endl;
    NestedIteration<2> iteration(without_safeguards(read_parameters(
      SCENES_DIR "/hertz.prm", {"Refinement/Maximum dofs=1500"})));
    iteration.begin();
    bool         admissible = true, prescribed = true, positive = true;
    double       total = 0;
    unsigned int warm = 0, cold = 0;
    do
      {
        const Discretization<2>   &d       = iteration.discretization();
        const DiscreteProblem<2>  &problem = d.problem();
        VectorType                 u;
        const ContactState         guess       = iteration.make_guess(u);
        const NodalConstraints<2> &constraints = d.constraints();
        admissible                             = admissible &&
          TrescaFunctional<2>(problem).largest_penetration(u) <= 1e-16;
        for (unsigned int node = 0; node < constraints.n_nodes(); ++node)
          for (unsigned int c = 0; c < 2; ++c)
            if (constraints.is_prescribed(node, c))
              prescribed = prescribed &&
                u.local_element(2 * node + c) ==
                  constraints.prescribed_values().local_element(2 * node + c);
        double guessed = 0, found = 0;
        for (unsigned int p = 0; p < guess.size(); ++p)
          {
            positive = positive && guess.normal_force(p) >= 0;
            guessed += guess.normal_force(p);
          }

        iteration.solve();
        for (unsigned int p = 0; p < guess.size(); ++p)
          found += iteration.state().normal_force(p);
        if (iteration.level() >= 5)
          {
            // From here on the coarser mesh resolves the contact zone.
            total = std::max(total, std::abs(guessed / found - 1));
            warm += iteration.report().cycles.size();
            u                      = admissible_start(d);
            ContactState     state = ContactState(guess.size(), true);
            ContactSolver<2> solver(
              d.dof_handler(),
              problem,
              without_safeguards(iteration.parameters().solver));
            cold += solver.solve(u, state).cycles.size();
          }
    } while (iteration.advance());
    check(admissible, "admissible");
    check(prescribed, "prescribed values to the last bit");
    check(positive, "normal forces not negative");
    check_below(total, 0.1, "their sum known to 10 %");
    check(warm < cold, "fewer cycles than from zero");
  }



  // The same run under three names.
  void
  without_friction()
  {
    std::cout << "no friction" << std::endl;
    const auto make = [](const std::vector<std::string> &more) {
      std::vector<std::string> overrides = {"Refinement/Maximum dofs=600"};
      overrides.insert(overrides.end(), more.begin(), more.end());
      auto nest = std::make_unique<NestedIteration<2>>(without_safeguards(
        read_parameters(SCENES_DIR "/hertz.prm", overrides)));
      nest->begin();
      return nest;
    };
    const auto none = make({"Contact/Friction law=none"});
    const auto zero = make({"Contact/Friction coefficient=0"});
    const auto both =
      make({"Contact/Friction law=none", "Contact/Friction coefficient=0"});

    bool more, same = true, nothing_allocated = true, nothing_said = true;
    do
      {
        none->solve();
        zero->solve();
        both->solve();
        for (const auto *other : {zero.get(), both.get()})
          {
            same = same && other->report().converged &&
              same_bits(none->displacement(), other->displacement()) &&
              same_bits(none->report().residual, other->report().residual) &&
              phases_agree(none->state(), other->state()) &&
              none->report().energy == other->report().energy &&
              none->report().cycles.size() == other->report().cycles.size();
            for (unsigned int c = 0; same && c < none->report().cycles.size();
                 ++c)
              same = none->report().cycles[c].energy ==
                  other->report().cycles[c].energy &&
                none->report().cycles[c].increment ==
                  other->report().cycles[c].increment;
          }
        for (const auto *one : {none.get(), zero.get(), both.get()})
          {
            const ContactState &state = one->state();
            nothing_allocated         = nothing_allocated &&
              state.friction_memory() == 0 && !state.has_friction();
            nothing_said = nothing_said && state.n_contact() > 0 &&
              state.n_sticking() == 0 && one->report().outer_iterations == 1 &&
              one->report().outer_changes.empty() &&
              one->report().certificate.cone < 1e-8;
          }
        more = none->advance();
        more = (zero->advance() == more) && more;
        more = (both->advance() == more) && more;
    } while (more);
    check(same, "law none and F = 0: the same run, bit for bit");
    check(nothing_allocated, "nothing is allocated for friction");
    check(nothing_said, "contact, but nothing sticks, and one outer iteration");

    // The same on the level of the parts: whatever the law is called, with a
    // coefficient of zero there is no friction, and a state that has none stays
    // without. One cycle truncates one component per node in contact, the
    // normal one, and no more.
    const Discretization<2> &d         = none->discretization();
    bool                     same_work = true, normal_only = true;
    VectorType               first;
    std::size_t              rows = 0, memory = 0;
    for (const FrictionLaw law :
         {FrictionLaw::none, FrictionLaw::coulomb, FrictionLaw::tresca})
      {
        DiscreteProblem<2> problem   = d.problem();
        problem.friction_law         = law;
        problem.friction_coefficient = law == FrictionLaw::none ? 0.4 : 0.;
        VectorType         u         = admissible_start(d);
        ContactState       state(d.contact().size(), problem.has_friction());
        ContactSolver<2>   solver(d.dof_handler(),
                                problem,
                                without_safeguards(none->parameters().solver));
        const SolverReport result = solver.solve(u, state);
        set_normal_forces(problem.contact, result.residual, state);
        normal_only = normal_only && result.converged &&
          !problem.has_friction() && state.friction_memory() == 0 &&
          result.cycles.back().truncated == state.n_contact();
        if (law == FrictionLaw::none)
          {
            first  = u;
            rows   = solver.levels().n_updated_rows();
            memory = result.solver_memory;
          }
        same_work = same_work && same_bits(u, first) &&
          rows == solver.levels().n_updated_rows() &&
          memory == result.solver_memory;
      }
    check(normal_only, "truncated components: the normal ones, nothing else");
    check(same_work, "the same work and memory for all laws");

    // The opposite, so that the numbers above mean something.
    const auto friction = make({});
    friction->solve();
    check(friction->state().has_friction() &&
            friction->state().friction_memory() >=
              friction->state().size() * (sizeof(double) + sizeof(char)),
          "with friction something is allocated");
  }
} // namespace test_algorithms

TEST(algorithms)
{
  compare_algorithms();
  compare_in_3d();
  compare_guesses();
  without_friction();
}

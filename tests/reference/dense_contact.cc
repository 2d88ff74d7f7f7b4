// The direct solution of the discrete law against what is known of the scenes:
// the published block of Raous et al., patch tests with linear solutions, and
// small rearrangements of one problem that must not matter.

#include <cstdio>

#include <tests/reference/solutions/dense_contact.h>
#include <tests/reference/solutions/scenes.h>

#include <tests/support/test.h>

using namespace Reference;

namespace test_dense_contact
{
  // In units that leave digits for a comparison with absolute tolerance 1e-6:
  // forces and displacements times 100, energy times 10000.
  void
  print_block(const unsigned int n, const double F)
  {
    const ContactProblem  problem  = block(n, F);
    const ContactSolution solution = solve(problem);
    const double          energy =
      0.5 * solution.displacement.dot(solution.residual); // no forces given
    std::printf("block %2ux%-2u F=%.2f  open %u sliding %u sticking %u\n",
                n,
                n,
                F,
                solution.count(State::open),
                solution.count(State::sliding),
                solution.count(State::sticking));
    std::printf("  100 N = %.8f  100 T = %.8f  10000 strain energy = %.8f\n",
                100. * solution.normal_force.sum(),
                100. * std::abs(solution.tangential_force.sum()),
                1e4 * energy);
    std::printf("  100 u_x = %.8f at (0,0), %.8f at (1,0)\n",
                100. * solution.displacement[0],
                100. * solution.displacement[2 * n]);
  }


  void
  print_raous(const unsigned int n)
  {
    const ContactProblem  problem  = raous(n);
    const ContactSolution solution = solve(problem);
    std::printf("raous %ux%u u_x in micrometres:", n, n);
    for (const double x : {0., 1.25, 5., 7.5, 11.25})
      std::printf(
        " %.3f",
        1e6 * solution.displacement[2 * node_at(problem.mesh, {1e-3 * x, 0.})]);
    double last_open = -1., last_sliding = -1., first_sticking = -1.;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      {
        const double x = 1e3 * problem.mesh.nodes[problem.contact[p].node][0];
        if (solution.state[p] == State::open)
          last_open = x;
        if (solution.state[p] == State::sliding)
          last_sliding = x;
        if (solution.state[p] == State::sticking && first_sticking < 0.)
          first_sticking = x;
      }
    std::printf("\n  open to %.2f, sliding to %.2f, sticking from %.2f mm\n",
                last_open,
                last_sliding,
                first_sticking);
  }


  // Largest error of a patch test, relative to the largest displacement, and
  // whether all nodes are in the state they should be in.
  void
  check_patch(const char *name, const StickSlip &scene)
  {
    const ContactProblem  problem  = scene.problem(6, 5, 0.2);
    const ContactSolution solution = solve(problem);
    double                error = 0., size = 0.;
    for (unsigned int p = 0; p < problem.mesh.nodes.size(); ++p)
      {
        const Eigen::Vector2d exact = scene.displacement(problem.mesh.nodes[p]);
        error                       = std::max(
          error, (solution.displacement.segment<2>(2 * p) - exact).norm());
        size = std::max(size, exact.norm());
      }
    const bool states =
      solution.count(scene.sticks() ? State::sticking : State::sliding) ==
      problem.contact.size();
    std::printf("patch %s: %s, exact to 1e-12: %s, states: %s\n",
                name,
                scene.sticks() ? "sticks" : "slides",
                error <= 1e-12 * size ? "yes" : "no",
                states ? "right" : "wrong");
    if (error > 1e-12 * size)
      std::printf("  error %.3e\n", error / size);
  }
} // namespace test_dense_contact



TEST(dense_contact)
{
  const double d = 0.01, F = 0.4, U = StickSlip::threshold(d, F);
  check_patch("stick", StickSlip(0.5 * U, d, F));
  check_patch("just below", StickSlip(0.99 * U, d, F));
  check_patch("just above", StickSlip(1.01 * U, d, F));
  check_patch("slip", StickSlip(2. * U, d, F));
  check_patch("slip to the left", StickSlip(-2. * U, d, F));
  check_patch("gap", StickSlip(2. * U, d, F, 0.003));
  check_patch("rotated",
              StickSlip(1.01 * U, d, F, 0.003, 2., 1., 1., 0.3, 0.7));
  check_patch("stiff", StickSlip(2. * U, d, F, 0., 1., 1., 1e10));
  check_patch("soft", StickSlip(2. * U, d, F, 0., 1., 1., 1e-10));

  print_raous(32);

  for (const unsigned int n : {8, 16})
    for (const double F : {0., 0.05, 0.4, 1.})
      print_block(n, F);

  // Tresca friction with the bounds of the Coulomb solution is the same
  // problem.
  {
    ContactProblem        problem = block(8, 0.4);
    const ContactSolution coulomb = solve(problem);
    problem.friction              = Friction::tresca;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      problem.contact[p].friction_bound = 0.4 * coulomb.normal_force[p];
    const ContactSolution tresca = solve(problem);
    std::printf(
      "Tresca with Coulomb's bounds differs by less than 1e-12: %s\n",
      (tresca.displacement - coulomb.displacement).cwiseAbs().maxCoeff() <
          1e-12 * 0.02
        ? "yes"
        : "no");

    // An open node is still held by Tresca friction, and its bound cannot be
    // exceeded.
    for (auto &node : problem.contact)
      {
        node.gap            = 1.;
        node.friction_bound = 1e-4;
      }
    const ContactSolution held = solve(problem);
    std::printf("Tresca friction without touch: open %u, |R_T| sum %.8f of "
                "%.8f\n",
                held.count(State::open),
                held.tangential_force.cwiseAbs().sum(),
                9e-4);
  }

  // A hanging node that is one only in name: two cells above, one below, all
  // linear.
  {
    ContactProblem problem;
    problem.mesh.nodes = {{0., 0.},
                          {1., 0.},
                          {0., 1.},
                          {0.5, 1.},
                          {1., 1.},
                          {0., 2.},
                          {0.5, 2.},
                          {1., 2.}};
    problem.mesh.cells = {{{0, 1, 2, 4}}, {{2, 3, 5, 6}}, {{3, 4, 6, 7}}};
    problem.hanging    = {{3, {{2, 0.5}, {4, 0.5}}}};
    const StickSlip scene(0.01, 0.01, 0.4, 0., 1., 2.);
    for (const unsigned int p : {5, 6, 7})
      for (unsigned int c = 0; c < 2; ++c)
        problem.dirichlet.push_back(
          {p, c, scene.displacement(problem.mesh.nodes[p])[c]});
    for (const unsigned int p : {0, 1})
      problem.contact.push_back({p, Eigen::Vector2d(0., -1.), 0., 0.4, 0.});
    const Eigen::Vector2d traction(-0.3 / 1.3 / 0.4 * 0.01 / 2.,
                                   scene.shear_stress());
    add_traction(problem, 1, 4, traction);
    add_traction(problem, 4, 7, traction);
    add_traction(problem, 0, 2, -traction);
    add_traction(problem, 2, 5, -traction);
    const ContactSolution solution = solve(problem);
    double                error    = 0.;
    for (unsigned int p = 0; p < problem.mesh.nodes.size(); ++p)
      error = std::max(error,
                       (solution.displacement.segment<2>(2 * p) -
                        scene.displacement(problem.mesh.nodes[p]))
                         .norm());
    std::printf("patch with a hanging node, exact to 1e-14: %s\n",
                error < 1e-14 ? "yes" : "no");
  }

  // Two ways to the solution, where about half of the nodes slide.
  {
    const ContactProblem  problem  = block(8, 0.4, 0.45);
    const ContactSolution solution = solve(problem);
    const ContactSolution relaxed  = solve(problem, Method::relaxation);
    std::printf(
      "block 8x8 nu=0.45 open %u sliding %u sticking %u, relaxation "
      "agrees to 1e-12: %s\n",
      solution.count(State::open),
      solution.count(State::sliding),
      solution.count(State::sticking),
      (solution.displacement - relaxed.displacement).cwiseAbs().maxCoeff() <
          1e-12 * 0.02
        ? "yes"
        : "no");
  }

  // The check notices what is wrong.
  {
    const ContactProblem  problem  = raous(8);
    const ContactSolution solution = solve(problem);
    std::printf("raous 8x8 violates the law by less than 1e-12: %s\n",
                solution.violations.max() < 1e-12 ? "yes" : "no");
    Eigen::VectorXd moved = solution.displacement;
    moved[2 * problem.contact[4].node + 1] -= 1e-6;
    std::printf("  penetration of a node that is pushed in by 1e-6: %.6f of "
                "the largest displacement\n",
                check(problem, moved).penetration);
    ContactProblem slippery = problem;
    for (auto &node : slippery.contact)
      node.friction_coefficient = 0.9;
    std::printf(
      "  cone violated for smaller F: %s, unchanged otherwise: %s\n",
      check(slippery, solution.displacement).cone > 1e-3 ? "yes" : "no",
      check(slippery, solution.displacement).equilibrium < 1e-12 ? "yes"
                                                                 : "no");
  }
}

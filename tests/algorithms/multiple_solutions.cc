// With much friction the discrete problem has several solutions. The smallest
// example is a single square cell of which three corners are held and the
// fourth, A at the origin, rests on a plane: one node, two unknowns, and all
// solutions can be written down. (For a linear triangle the same was found by
// Klarbring, Ing. Arch. 60, 1990.)
//
// With the stiffness K_tt = K_nn = a, K_tn = b > 0 of that node, and a load
// (f, -q), q > 0, the node
// - sticks, if |f| <= F q;
// - slides to the left, u_t = (f + F q) / (a - F b), if that is negative and
//   there is pressure left, q + b u_t >= 0;
// - is open, K u = (f, -q), if that lifts it off.
// For F > a/b = 4 (3 - 4 nu) / 3 and -F q < f < -(a/b) q these are all three at
// the same time: friction is strong enough to hold the node, but a node that
// slides is lifted by its own slip, which takes away the friction.

#include <common/algorithms/contact_solver.h>
#include <common/algorithms/safeguarded_solver.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

#include "../support/random_problem.h"

using namespace Tests;

namespace test_multiple_solutions
{
  constexpr double F = 4, f = -3, q = 1;

  struct Solution
  {
    std::string name;
    double      u_t, u_y;
    bool        contact, stick;
    double      pressure;
  };

  Parameters
  parameters()
  {
    Parameters p         = block_parameters<2>(FrictionLaw::coulomb, F);
    p.scene.size         = {1., 1.};
    p.scene.subdivisions = {1, 1};
    p.scene.distortion   = 0.;
    p.boundary_conditions.displacement = {{"1", {"0", "0"}}, {"3", {"0", "0"}}};
    // A has half of the load of the left edge.
    p.boundary_conditions.traction = {
      {"0", {std::to_string(2 * f), std::to_string(-2 * q)}}};
    return p;
  }



  std::vector<Solution>
  all_solutions(const Material &material)
  {
    const double lambda = material.lambda(), mu = material.mu();
    const double a = (lambda + 3 * mu) / 3., b = (lambda + mu) / 4.;
    check(F > a / b && -F * q < f && f < -a / b * q,
          "the coefficient of friction and the load allow three solutions");
    const double slip = (f + F * q) / (a - F * b);
    return {{"stick", 0., 0., true, true, q},
            {"slip", slip, 0., true, false, q + b * slip},
            {"open",
             (a * f + b * q) / (a * a - b * b),
             (-a * q - b * f) / (a * a - b * b),
             false,
             false,
             0.}};
  }



  struct Node
  {
    const Discretization<2> &d;

    VectorType
    displacement(const double u_x, const double u_y) const
    {
      VectorType u(d.constraints().partitioner());
      d.constraints().impose(u);
      u.local_element(2 * (d.contact())[0].node)     = u_x;
      u.local_element(2 * (d.contact())[0].node + 1) = u_y;
      return u;
    }

    std::string
    name_of(const VectorType &u, const std::vector<Solution> &solutions) const
    {
      for (const Solution &s : solutions)
        {
          VectorType difference = displacement(s.u_t, s.u_y);
          difference -= u;
          if (difference.linfty_norm() < 1e-7)
            return s.name;
        }
      return "none";
    }
  };
} // namespace test_multiple_solutions



TEST(multiple_solutions)
{
  const Parameters p = parameters();
  const Scene<2>   scene(p);
  std::cout << scene.warning(scene.contact_conditions()[0].friction_coefficient)
            << std::endl;
  const auto mesh = make_triangulation<2>();
  scene.make_coarse_mesh(*mesh);
  const Discretized<2> d(scene, *mesh);
  const Node           node      = {d};
  const auto           solutions = all_solutions(scene.materials().base());
  check(d.contact().size() == 1, "there is one contact node");

  // Each of them satisfies the discrete law.
  for (const Solution &s : solutions)
    {
      const VectorType u = node.displacement(s.u_t, s.u_y);
      VectorType       residual(u);
      d.stiffness().residual(residual, d.loads(), u);
      ContactState state(1, true);
      if (s.name == "stick" || s.name == "slip")
        state.set(0, true, s.name == "stick");
      const Certificate certificate =
        make_certificate(d.problem(), u, residual, state);
      check_below(certificate.largest(), 1e-12, "law of contact: " + s.name);
    }

  // Which of them is found depends on where one starts, and how one goes on.
  SolverSettings three, two, mixed;
  two.algorithm                = Algorithm::fixed_point;
  mixed                        = two;
  mixed.outer_damping          = .5;
  mixed.mixed_outer_iterations = 5;
  const std::vector<std::pair<std::string, SolverSettings>> algorithms = {
    {"Algorithm 3", three},
    {"Algorithm 2", two},
    {"Algorithm 2, mixed", mixed}};

  std::vector<std::pair<std::string, Solution>> starts;
  for (const Solution &s : solutions)
    {
      starts.emplace_back(s.name, s);
      Solution less = s, more = s;
      less.u_t *= .9;
      less.u_y *= .9;
      less.pressure *= .9;
      more.u_t *= 1.1;
      more.u_y *= 1.1;
      more.pressure *= 1.1;
      starts.emplace_back("90 % of " + s.name, less);
      starts.emplace_back("110 % of " + s.name, more);
    }
  starts.emplace_back("no displacement, no force",
                      Solution{"", 0., 0., true, false, 0.});

  for (const auto &algorithm : algorithms)
    {
      std::cout << algorithm.first << std::endl;
      for (const auto &start : starts)
        {
          const Solution &s     = start.second;
          VectorType      u     = node.displacement(s.u_t, s.u_y);
          ContactState    state = ContactState(1, true);
          state.set(0, s.contact, s.stick);
          state.set_normal_force(0, s.pressure);
          SolverSettings settings = algorithm.second;
          settings.safeguards     = false;
          ContactSolver<2>   solver(d, without_safeguards(settings));
          const SolverReport report = solver.solve(u, state);
          std::cout << "  from " << start.first << ": "
                    << (report.converged ? node.name_of(u, solutions)
                                         : "does not converge")
                    << std::endl;
        }
    }
}

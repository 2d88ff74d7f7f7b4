// The point contact of Hertz: the half ball on a plane, without friction.
//
// Two kinds of error must be kept apart. That of the mesh depends on h/a, the
// size of the cells over the radius of the contact zone; that of the model on
// a/R, since Hertz's body is a half space and ours is held at a distance R. So
// all meshes here are graded alike, seen from the contact zone: halving a and
// the cells with it leaves the error of the mesh as it is, and what changes is
// the model's.
//
// What is known about the latter: as a/R -> 0, a body that is held somewhere
// far away differs from the half space by a rigid displacement that is
// proportional to the force,
//   d = delta(P) - c P/(Es R),   delta(P) = (3 P/(4 Es sqrt(R)))^(2/3),
// where the number c depends on the shape of the body and on where it is held,
// not on the load. So the force is larger than Hertz's by a relative 2 c a/R in
// first order, but the law behind it has the exponent 3/2. The contact zone
// itself knows nothing of d: its radius and peak pressure follow from the force
// up to an error of order (a/R)^2.

#include <common/algorithms/nested_iteration.h>

#include <cmath>
#include <iostream>

#include <tests/support/check.h>

#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_half_ball_3d
{
  constexpr double R = 1, E = 1, nu = .3;
  const double     Es = E / (1 - nu * nu);

  struct Hertz
  {
    double approach, radius, peak;
  };

  Hertz
  hertz(const double force)
  {
    const double a = std::cbrt(3 * force * R / (4 * Es));
    return {a * a / R, a, 3 * force / (2 * numbers::PI * a * a)};
  }

  Parameters
  half_ball(const double d, const std::vector<std::string> &more = {})
  {
    std::ostringstream text;
    text << "Scene/Constants=d = " << d;
    std::vector<std::string> overrides = {text.str(),
                                          "Solver/Inner tolerance=1e-9"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return without_safeguards(
      read_parameters(SCENES_3D_DIR "/half-ball.prm", overrides));
  }



  /** What has been measured on one mesh. */
  struct Measured
  {
    bool         converged;
    double       force, energy, peak;
    double       radius; ///< where p^2, which is linear in r^2, comes to zero
    double       pressure_error; ///< in L2, relative to Hertz's with this force
    unsigned int n_dofs, n_contact, n_cycles;
  };

  Measured
  measure(const ContactBoundary<3> &contact,
          const ContactState       &state,
          const SolverReport       &report)
  {
    Measured result;
    result.converged = report.converged;
    result.energy    = report.energy;
    result.n_contact = state.n_contact();
    result.n_cycles  = report.cycles.size();
    result.n_dofs    = report.residual.size();

    // Least squares, p^2 = p0^2 - slope r^2, weighted with the measures.
    double w = 0, x = 0, xx = 0, y = 0, xy = 0;
    result.force = result.peak = 0;
    for (unsigned int p = 0; p < contact.size(); ++p)
      if (state.in_contact(p))
        {
          const ContactNode<3> &node  = contact[p];
          const double          force = normal_component(node, report.residual),
                       pressure = force / node.measure, m = node.measure,
                       r2 = node.point[0] * node.point[0] +
            node.point[1] * node.point[1],
                       p2 = pressure * pressure;
          result.force -= force * node.normal()[2];
          result.peak = std::max(result.peak, pressure);
          w += m;
          x += m * r2;
          xx += m * r2 * r2;
          y += m * p2;
          xy += m * r2 * p2;
        }
    const double slope     = (w * xy - x * y) / (w * xx - x * x);
    const double intercept = (y - slope * x) / w;
    result.radius          = std::sqrt(-intercept / slope);

    const Hertz expected = hertz(result.force);
    double      error = 0, norm = 0;
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const ContactNode<3> &node = contact[p];
        const double          r2 =
          node.point[0] * node.point[0] + node.point[1] * node.point[1];
        const double there = expected.peak *
          std::sqrt(std::max(0., 1 - r2 / (expected.radius * expected.radius)));
        error +=
          node.measure *
          std::pow(
            normal_component(node, report.residual) / node.measure - there, 2);
        norm += node.measure * there * there;
      }
    result.pressure_error = std::sqrt(error / norm);
    return result;
  }



  /**
   * The body with a mesh of which each cell is smaller than 1.2 times its
   * distance from the lowest point, or than 1.2 a: h/a in the contact zone, and
   * around its rim, is 0.3. The zone itself is not enough: cells that are
   * coarse just outside make the force too large by half a percent.
   */
  class Body
  {
  public:
    explicit Body(const double d)
      : parameters(half_ball(d))
      , scene(parameters)
      , mesh(make_triangulation<3>())
    {
      scene.make_coarse_mesh(*mesh);
      const double a = std::sqrt(R * d);
      for (bool changed = true; changed;)
        {
          changed = false;
          for (const auto &cell : mesh->active_cell_iterators())
            {
              double distance = R;
              for (const unsigned int v : cell->vertex_indices())
                distance = std::min(
                  distance, cell->vertex(v).distance(Point<3>(0, 0, -R)));
              if (cell->diameter() > 1.2 * std::max(distance, a))
                {
                  cell->set_refine_flag();
                  changed = true;
                }
            }
          mesh->execute_coarsening_and_refinement();
        }
    }

    void
    refine()
    {
      mesh->refine_global(1);
    }

    Measured
    solve() const
    {
      const Discretized<3> discretization(scene, *mesh);
      VectorType           u = admissible_start(discretization);
      ContactState         state(discretization.contact().size(), false);
      ContactSolver<3>     solver(discretization,
                              without_safeguards(parameters.solver));
      const SolverReport   report = solver.solve(u, state);
      return measure(discretization.contact(), state, report);
    }

  private:
    const Parameters                  parameters;
    const Scene<3>                    scene;
    std::unique_ptr<Triangulation<3>> mesh;
  };



  // Radius and peak against what the force says, up to the error of the mesh
  // and that of the finite body. Most of the error in L2 comes from the nodes
  // next to the rim, where the pressure has an infinite slope.
  void
  check_zone(const Measured &m, const double mesh_error)
  {
    const Hertz  expected = hertz(m.force);
    const double model    = std::pow(expected.radius / R, 2);
    check(m.converged, "converged");
    check_below(std::abs(m.radius / expected.radius - 1),
                mesh_error + .5 * model,
                "radius of the contact zone");
    check_below(std::abs(m.peak / expected.peak - 1),
                mesh_error + .6 * model,
                "peak pressure");
    check_below(m.pressure_error, .12, "pressure in L2");
  }
} // namespace test_half_ball_3d

TEST(half_ball_3d)
{
  // The energy is that of a minimum, so its error is the square of an error of
  // order one; the force is its derivative by d.
  std::cout << "Three meshes, a/R = 0.2" << std::endl;
  std::vector<Measured> meshes;
  {
    Body body(.04);
    meshes.push_back(body.solve());
    for (unsigned int refinement = 0; refinement < 2; ++refinement)
      {
        body.refine();
        meshes.push_back(body.solve());
      }
  }
  const auto order = [&](const double Measured::*value) {
    return std::log2((meshes[1].*value - meshes[0].*value) /
                     (meshes[2].*value - meshes[1].*value));
  };
  check_below(std::abs(order(&Measured::energy) - 2), .3, "energy: order 2");
  check_below(std::abs(order(&Measured::force) - 2), .5, "force: order 2");
  check_below(meshes[2].pressure_error, .05, "pressure in L2");

  std::cout << "Three bodies, a/R = 0.2, 0.1 and 0.05" << std::endl;
  const std::vector<double> ds     = {.04, .01, .0025};
  std::vector<Measured>     bodies = {meshes[1]};
  for (unsigned int i = 1; i < 3; ++i)
    {
      Body body(ds[i]);
      body.refine();
      bodies.push_back(body.solve());
    }
  for (const Measured &body : bodies)
    check_zone(body, .01);

  // One number c for all of them.
  std::vector<double> c;
  for (unsigned int i = 0; i < 3; ++i)
    c.push_back((hertz(bodies[i].force).approach - ds[i]) * Es * R /
                bodies[i].force);
  check_below(std::max({c[0], c[1], c[2]}) / std::min({c[0], c[1], c[2]}),
              1.1,
              "the same rigid displacement per force");

  // The law's exponent, as it stands and corrected by the one in the middle.
  const auto exponent = [&](const unsigned int i, const double c) {
    const auto approach = [&](const unsigned int j) {
      return ds[j] + c * bodies[j].force / (Es * R);
    };
    return std::log(bodies[i].force / bodies[i + 1].force) /
      std::log(approach(i) / approach(i + 1));
  };
  const double excess = exponent(0, 0) - 1.5, next = exponent(1, 0) - 1.5;
  check_below(std::abs(exponent(0, c[1]) - 1.5), .003, "exponent 3/2");
  check_below(std::abs(exponent(1, c[1]) - 1.5), .003, "exponent 3/2");
  check_below(std::abs(excess / next - 2),
              .3,
              "deviation without correction: of first order in a/R");

  // As the scene refines it.
  std::cout << "Adaptive refinement, a/R = 0.1" << std::endl;
  NestedIteration<3> iteration(
    half_ball(.01, {"Refinement/Maximum dofs=6000"}));
  iteration.begin();
  unsigned int n_cycles = 0;
  do
    {
      iteration.solve();
      if (iteration.level() >= 2)
        n_cycles =
          std::max<unsigned int>(n_cycles, iteration.report().cycles.size());
  } while (iteration.advance());
  const Measured m = measure(iteration.discretization().contact(),
                             iteration.state(),
                             iteration.report());
  check_zone(m, .02);
  check_below(n_cycles, 15, "cycles on each level from the second on");
}

// The scene extruded-hertz against the plane scene hertz on the same
// cross-section. Nothing depends on z, so the three-dimensional solution is
// known from the two-dimensional one, node by node: the same displacements,
// the same states in each layer of nodes, forces and energy times what belongs
// to a layer of the length.

#include <common/algorithms/nested_iteration.h>

#include <iostream>

#include <tests/support/check.h>

#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_extruded_hertz_3d
{
  // Push harder than the scenes do: the meshes here are uniform and coarse, and
  // the contact zone shall have some nodes that stick and some that slip.
  std::vector<std::string>
  overrides(const unsigned int refinements,
            const double       F,
            const std::string &displacement)
  {
    std::ostringstream friction;
    friction << "Contact/Friction coefficient=" << F;
    return {friction.str(),
            "Boundary conditions/Displacement=" + displacement,
            "Refinement/Strategy=uniform",
            "Refinement/Initial refinements=" + std::to_string(refinements),
            "Refinement/Levels=0",
            "Solver/Inner tolerance=1e-12"};
  }



  void
  compare(const unsigned int refinements,
          const double       F,
          const LocalSolver  local_solver,
          const std::string &what)
  {
    NestedIteration<2> plane(without_safeguards(read_parameters(
      SCENES_DIR "/hertz.prm", overrides(refinements, F, "1: 0, -0.08"))));
    plane.begin();
    Parameters parameters          = without_safeguards(read_parameters(
      SCENES_3D_DIR "/extruded-hertz.prm",
      overrides(
        refinements, F, "1: 0, -0.08, 0; 2: free, free, 0; 3: free, free, 0")));
    parameters.solver.local_solver = local_solver;
    NestedIteration<3> solid(parameters);
    solid.begin();
    plane.solve();
    solid.solve();
    const ContactBoundary<2> &plane_contact = plane.discretization().contact();
    const ContactBoundary<3> &solid_contact = solid.discretization().contact();

    // The layers of nodes, and what each of them stands for.
    const double       length = parameters.scene.length;
    const unsigned int n_layers =
      solid.mesh().n_active_cells() / plane.mesh().n_active_cells();
    const auto z_measure = [&](const double z) {
      const bool at_end = (z < 1e-9 || z > length - 1e-9);
      return length / n_layers * (at_end ? .5 : 1.);
    };

    // Displacements. The node of the plane mesh below a node is found by
    // coordinates; meshes that differ are found out, too.
    const auto         plane_points       = node_points(plane.discretization());
    const auto         solid_points       = node_points(solid.discretization());
    double             displacement_error = 0, displacement_scale = 0;
    unsigned int       n_without_partner = 0;
    const unsigned int none              = numbers::invalid_unsigned_int;
    const auto         partner           = [&](const Point<3> &p) {
      for (unsigned int i = 0; i < plane_points.size(); ++i)
        if (plane_points[i].distance(Point<2>(p[0], p[1])) < 1e-10)
          return i;
      return none;
    };
    for (unsigned int i = 0; i < solid_points.size(); ++i)
      {
        const unsigned int j = partner(solid_points[i]);
        if (j == none)
          {
            ++n_without_partner;
            continue;
          }
        for (unsigned int c = 0; c < 3; ++c)
          {
            const double expected =
              (c < 2 ? plane.displacement().local_element(2 * j + c) : 0.);
            displacement_error =
              std::max(displacement_error,
                       std::abs(solid.displacement().local_element(3 * i + c) -
                                expected));
            displacement_scale =
              std::max(displacement_scale, std::abs(expected));
          }
      }

    // Contact nodes: states, normals and gaps, measures, forces.
    double       force_error = 0, force_scale = 0, geometry_error = 0;
    unsigned int n_different_states = 0;
    std::vector<unsigned int> times_found(plane_contact.size(), 0);
    for (unsigned int p = 0; p < solid_contact.size(); ++p)
      {
        const ContactNode<3> &node = solid_contact[p];
        unsigned int          q    = 0;
        while (q < plane_contact.size() &&
               plane_contact[q].point.distance(
                 Point<2>(node.point[0], node.point[1])) > 1e-10)
          ++q;
        if (q == plane_contact.size())
          {
            ++n_without_partner;
            continue;
          }
        ++times_found[q];
        const ContactNode<2> &below = plane_contact[q];
        const double          dz    = z_measure(node.point[2]);
        n_different_states +=
          (solid.state().in_contact(p) != plane.state().in_contact(q) ||
           solid.state().sticks(p) != plane.state().sticks(q));
        geometry_error =
          std::max({geometry_error,
                    std::abs(node.measure / (dz * below.measure) - 1),
                    std::abs(node.gap - below.gap),
                    std::abs(node.normal()[2]),
                    (Point<2>(node.normal()[0], node.normal()[1]) -
                     Point<2>(below.normal()[0], below.normal()[1]))
                      .norm()});
        // That in z direction is a reaction at the ends, where z is held.
        for (unsigned int c = 0; c < 2; ++c)
          {
            const double expected =
              dz * plane.report().residual.local_element(2 * below.node + c);
            force_error =
              std::max(force_error,
                       std::abs(solid.report().residual.local_element(
                                  3 * node.node + c) -
                                expected));
            force_scale = std::max(force_scale, std::abs(expected));
          }
        if (std::abs(node.point[2] - length / 2) < .49 * length)
          force_error = std::max(
            force_error,
            std::abs(solid.report().residual.local_element(3 * node.node + 2)));
      }
    for (const unsigned int n : times_found)
      n_without_partner += (n != n_layers + 1);

    displacement_error /= displacement_scale;
    force_error /= force_scale;
    const double energy_error =
      std::abs(solid.report().energy / (length * plane.report().energy) - 1);

    std::cout << what << ", " << n_layers << " layers of "
              << plane.mesh().n_active_cells()
              << " cells: " << plane.state().n_contact()
              << " nodes of the cross-section in "
              << "contact, " << plane.state().n_sticking() << " sticking"
              << std::endl;
    check(plane.report().converged && solid.report().converged &&
            n_without_partner == 0,
          "converged, and all nodes correspond");
    check_below(geometry_error, 1e-9, "normals, gaps and measures");
    check(n_different_states == 0, "states");
    check_below(displacement_error, 1e-9, "displacements");
    check_below(force_error, 1e-9, "nodal forces");
    check_below(energy_error, 1e-9, "energy");
  }
} // namespace test_extruded_hertz_3d

TEST(extruded_hertz_3d)
{
  const auto secular = LocalSolver::secular_equation;
  for (const unsigned int refinements : {1, 2})
    {
      compare(refinements, 0., secular, "F = 0");
      compare(refinements, .1, secular, "F = 0.1");
      compare(refinements, .4, secular, "F = 0.4");
      compare(refinements, .4, LocalSolver::uzawa, "F = 0.4, Uzawa");
    }
}

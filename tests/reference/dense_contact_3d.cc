// The direct solution of the discrete law in three dimensions against what is
// known without it: linear solutions, the two-dimensional reference where
// nothing depends on y, symmetries, and its own certificate.

#include <tests/reference/solutions/dense_contact_3d.h>

#include <cstdio>

#include <tests/reference/solutions/scenes_3d.h>

#include <tests/support/test.h>

using namespace Reference;

namespace test_dense_contact_3d
{
  const char *
  yes(const bool condition)
  {
    return condition ? "yes" : "no";
  }


  // In units that leave digits for a comparison with absolute tolerance 1e-6.
  // With F = 0 the state "sliding" means in touch.
  void
  print_block(const unsigned int n, const double F)
  {
    const ContactSolution3D solution = solve(block_3d(n, F));
    Eigen::Vector3d         force    = Eigen::Vector3d::Zero();
    for (const auto &R_T : solution.tangential_force)
      force += R_T;
    std::printf("block %u^3 F=%.2f  open %u sliding %u sticking %u, "
                "law holds to 1e-12: %s\n",
                n,
                F,
                solution.count(State::open),
                solution.count(State::sliding),
                solution.count(State::sticking),
                yes(solution.violations.max() <= 1e-12));
    std::printf("  100 N = %.7f  100 T = %.7f  10000 potential energy = %.7f "
                "total = %.7f\n",
                100. * solution.normal_force.sum(),
                100. * force.norm(),
                1e4 * solution.potential_energy,
                1e4 * solution.energy());
  }


  // Largest error of a patch test, relative to the largest displacement, and
  // whether all nodes are in the state they should be in.
  void
  check_patch(const char *name, const StickSlip3D &scene)
  {
    const ContactProblem3D  problem  = scene.problem({{4, 3, 3}}, 0.2);
    const ContactSolution3D solution = solve(problem);
    double                  error = 0., size = 0.;
    for (unsigned int p = 0; p < problem.mesh.nodes.size(); ++p)
      {
        const Eigen::Vector3d exact = scene.displacement(problem.mesh.nodes[p]);
        error                       = std::max(
          error, (solution.displacement.segment<3>(3 * p) - exact).norm());
        size = std::max(size, exact.norm());
      }
    std::printf(
      "patch %s: %s, exact to 1e-12: %s, states: %s, law holds to 1e-12: %s\n",
      name,
      scene.sticks() ? "sticks" : "slides",
      yes(error <= 1e-12 * size),
      solution.count(scene.sticks() ? State::sticking : State::sliding) ==
          problem.contact.size()
        ? "right"
        : "wrong",
      yes(solution.violations.max() <= 1e-12));
    if (error > 1e-12 * size)
      std::printf("  error %.3e\n", error / size);
  }


  void
  check_patches()
  {
    const double          d = 0.01, F = 0.4, U = StickSlip::threshold(d, F);
    const Eigen::Vector2d along(std::cos(0.9), std::sin(0.9));
    const Eigen::Vector3d brick(2., 1.5, 0.8);
    const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1., 2., -1.).normalized())
        .toRotationMatrix();
    check_patch("stick", StickSlip3D(0.5 * U * along, d, F));
    check_patch("just below", StickSlip3D(0.99 * U * along, d, F));
    check_patch("just above", StickSlip3D(1.01 * U * along, d, F));
    check_patch("slip", StickSlip3D(2. * U * along, d, F));
    check_patch("slip back", StickSlip3D(-2. * U * along, d, F));
    check_patch("gap", StickSlip3D(2. * U * along, d, F, 0.003));
    check_patch(
      "rotated brick",
      StickSlip3D(1.5 * U * along, d, F, 0.003, brick, 1., 0.3, rotation));
    check_patch("stiff", StickSlip3D(2. * U * along, d, F, 0., brick, 1e10));
  }


  // A problem of plane strain against the two-dimensional reference. The third
  // direction, with two cells of unequal width, is held by u_y = 0 on the faces
  // only; the nodes between them find u_y = 0 by themselves.
  void
  check_plane_strain(const char *name, const ContactProblem &plane)
  {
    const std::vector<double> layers = {0., 0.4, 1.};
    const unsigned int        n      = plane.mesh.nodes.size();
    const auto share = [](const unsigned int layer) { // of the width one
      return layer == 0 ? 0.2 : layer == 1 ? 0.5 : 0.3;
    };

    ContactProblem3D problem;
    problem.youngs_modulus = plane.youngs_modulus;
    problem.poisson_ratio  = plane.poisson_ratio;
    problem.friction       = plane.friction;
    problem.forces         = Eigen::VectorXd::Zero(9 * n);
    for (unsigned int layer = 0; layer < 3; ++layer)
      for (unsigned int p = 0; p < n; ++p)
        {
          const unsigned int q = layer * n + p;
          problem.mesh.nodes.emplace_back(
            plane.mesh.nodes[p][0], layers[layer], plane.mesh.nodes[p][1]);
          if (layer != 1)
            problem.dirichlet.push_back({q, 1, 0.});
          if (plane.forces.size() > 0)
            {
              problem.forces[3 * q] = share(layer) * plane.forces[2 * p];
              problem.forces[3 * q + 2] =
                share(layer) * plane.forces[2 * p + 1];
            }
        }
    for (unsigned int layer = 0; layer < 3; ++layer)
      {
        for (const auto &d : plane.dirichlet)
          problem.dirichlet.push_back(
            {layer * n + d.node, 2 * d.component, d.value});
        for (const auto &node : plane.contact)
          problem.contact.push_back(
            {layer * n + node.node,
             Eigen::Vector3d(node.normal[0], 0., node.normal[1]),
             node.gap,
             node.friction_coefficient,
             share(layer) * node.friction_bound});
      }
    // The inner layer is wholly prescribed at the top, as `rotated` below
    // wants.
    for (const auto &d : plane.dirichlet)
      if (d.component == 0)
        problem.dirichlet.push_back({n + d.node, 1, 0.});
    for (unsigned int layer = 0; layer < 2; ++layer)
      for (const auto &c : plane.mesh.cells)
        {
          std::array<unsigned int, 8> cell;
          for (unsigned int v = 0; v < 8; ++v)
            cell[v] =
              (layer + ((v >> 1) & 1)) * n + c[(v & 1) + 2 * ((v >> 2) & 1)];
          problem.mesh.cells.push_back(cell);
        }

    const ContactSolution   truth    = solve(plane);
    const ContactSolution3D solution = solve(problem);
    Eigen::VectorXd         expected = Eigen::VectorXd::Zero(9 * n);
    for (unsigned int q = 0; q < 3 * n; ++q)
      {
        expected[3 * q]     = truth.displacement[2 * (q % n)];
        expected[3 * q + 2] = truth.displacement[2 * (q % n) + 1];
      }
    const double size       = truth.displacement.cwiseAbs().maxCoeff();
    const auto   difference = [&](const Eigen::VectorXd &u) {
      return (u - expected).cwiseAbs().maxCoeff() / size;
    };
    bool same_states = true;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      same_states = same_states &&
        solution.state[p] == truth.state[p % plane.contact.size()];
    std::printf("%s (open %u sliding %u sticking %u): "
                "as in 2D to 1e-12: %s, states too: %s\n",
                name,
                truth.count(State::open),
                truth.count(State::sliding),
                truth.count(State::sticking),
                yes(difference(solution.displacement) <= 1e-12),
                yes(same_states));
    if (difference(solution.displacement) > 1e-12)
      std::printf("  difference %.3e\n", difference(solution.displacement));

    // Replace u_y = 0 on the faces by the forces that it takes, and look from
    // elsewhere: now all tangential components are free.
    ContactProblem3D free_faces = problem;
    std::vector<int> prescribed(3 * n, 0);
    for (const auto &d : plane.dirichlet)
      for (unsigned int layer = 0; layer < 3; ++layer)
        ++prescribed[layer * n + d.node];
    if (std::count(prescribed.begin(), prescribed.end(), 1) > 0)
      return; // a plane of symmetry has to keep its axes
    free_faces.dirichlet.clear();
    for (const auto &d : problem.dirichlet)
      if (prescribed[d.node] == 2)
        free_faces.dirichlet.push_back(d);
      else
        free_faces.forces[3 * d.node + 1] = solution.residual[3 * d.node + 1];
    const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.6, Eigen::Vector3d(2., -1., 3.).normalized())
        .toRotationMatrix();
    const ContactSolution3D turned = solve(rotated(free_faces, rotation));
    Eigen::VectorXd         back(9 * n);
    for (unsigned int q = 0; q < 3 * n; ++q)
      back.segment<3>(3 * q) =
        rotation.transpose() * turned.displacement.segment<3>(3 * q);
    std::printf("  free faces under these forces, rotated, to 1e-10: %s\n",
                yes(difference(back) <= 1e-10));
    if (difference(back) > 1e-10)
      std::printf("  difference %.3e\n", difference(back));
  }


  void
  check_plane_strains()
  {
    ContactProblem distorted = block(8, 0.4, 0.45);
    distorted.mesh           = rectangle(8, 8, 1., 1., 0.15);
    check_plane_strain("block 8x8 F=0.05", block(8, 0.05));
    check_plane_strain("block 8x8 F=0.4 nu=0.45", block(8, 0.4, 0.45));
    check_plane_strain("distorted block 8x8 F=0.4 nu=0.45", distorted);
    check_plane_strain("raous 16x16", raous(16));

    // A curved obstacle leaves nodes open.
    for (auto &node : distorted.contact)
      node.gap = 0.1 * std::pow(distorted.mesh.nodes[node.node][0] - 0.4, 2);
    check_plane_strain("distorted block on a curved obstacle", distorted);
    distorted.friction = Friction::tresca;
    for (auto &node : distorted.contact)
      node.friction_bound = 2e-4;
    check_plane_strain("the same by Tresca's law", distorted);
  }


  // A sphere pressed into the block and pulled aside: open, sliding and
  // sticking nodes, whose forces point in all directions.
  ContactProblem3D
  sphere(const unsigned int n, const double F, const Eigen::Vector3d &top)
  {
    ContactProblem3D problem = block_3d(n, F, 0.3, top);
    for (auto &node : problem.contact)
      {
        const Eigen::Vector3d x = problem.mesh.nodes[node.node];
        node.gap = 0.15 * (std::pow(x[0] - 0.5, 2) + std::pow(x[1] - 0.5, 2));
      }
    return problem;
  }


  void
  check_sphere()
  {
    const unsigned int      n        = 6;
    const ContactProblem3D  problem  = sphere(n, 0.2, {0.004, 0.002, -0.02});
    const ContactSolution3D solution = solve(problem);
    std::printf(
      "sphere %u^3 open %u sliding %u sticking %u, law holds to 1e-12: "
      "%s\n",
      n,
      solution.count(State::open),
      solution.count(State::sliding),
      solution.count(State::sticking),
      yes(solution.violations.max() <= 1e-12));

    // x and y exchanged
    const ContactSolution3D mirrored =
      solve(sphere(n, 0.2, {0.002, 0.004, -0.02}));
    double difference = 0.;
    for (unsigned int p = 0; p < problem.mesh.nodes.size(); ++p)
      {
        const Eigen::Vector3d x = problem.mesh.nodes[p],
                              u = solution.displacement.segment<3>(3 * p);
        const unsigned int q    = node_at(problem.mesh, {x[1], x[0], x[2]});
        difference              = std::max(difference,
                              (mirrored.displacement.segment<3>(3 * q) -
                               Eigen::Vector3d(u[1], u[0], u[2]))
                                .norm());
      }
    std::printf("  mirror image to 1e-12: %s\n",
                yes(difference < 1e-12 * 0.02));

    // Tresca friction with the bounds of the Coulomb solution is the same
    // problem, and its solution is the minimum of the energy.
    ContactProblem3D tresca = problem;
    tresca.friction         = Friction::tresca;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      tresca.contact[p].friction_bound =
        std::max(0.2 * solution.normal_force[p], 0.);
    const ContactSolution3D given = solve(tresca);
    std::printf(
      "  Tresca with Coulomb's bounds differs by less than 1e-12: %s\n",
      yes((given.displacement - solution.displacement).cwiseAbs().maxCoeff() <
          1e-12 * 0.02));
    const Eigen::SparseMatrix<double> A =
      stiffness(tresca.mesh, tresca.poisson_ratio);
    bool lowest = true;
    for (unsigned int trial = 0; trial < 100; ++trial)
      {
        Eigen::VectorXd u = given.displacement;
        for (unsigned int i = 0; i < u.size(); ++i)
          u[i] += 1e-4 * std::sin(12.9898 * i + 78.233 * trial);
        for (const auto &d : tresca.dirichlet)
          u[3 * d.node + d.component] = d.value;
        double energy = 0.;
        for (const auto &node : tresca.contact)
          {
            const unsigned int i = 3 * node.node;
            u[i + 2]             = std::max(u[i + 2], -node.gap); // admissible
            energy += node.friction_bound * u.segment<2>(i).norm();
          }
        energy += 0.5 * u.dot(A * u);
        lowest = lowest && energy > given.energy();
      }
    std::printf("  no neighbour has less energy: %s\n", yes(lowest));

    // The check notices what is wrong.
    Eigen::VectorXd    moved = solution.displacement;
    const unsigned int middle =
      node_at(problem.mesh, Eigen::Vector3d(0.5, 0.5, 0.));
    moved[3 * middle + 2] -= 1e-6;
    std::printf(
      "  penetration of a node that is pushed in by 1e-6: %.6f of the "
      "largest displacement\n",
      check(problem, moved).penetration);
    ContactProblem3D slippery = problem;
    for (auto &node : slippery.contact)
      node.friction_coefficient = 0.15;
    const Violations wrong = check(slippery, solution.displacement);
    std::printf("  cone violated for smaller F: %s, unchanged otherwise: %s\n",
                yes(wrong.cone > 1e-3),
                yes(wrong.equilibrium < 1e-12 && wrong.penetration < 1e-12));
  }
} // namespace test_dense_contact_3d



TEST(dense_contact_3d)
{
  check_patches();
  check_plane_strains();
  check_sphere();
  for (const unsigned int n : {4, 8})
    for (const double F : {0., 0.05, 0.4, 1.})
      print_block(n, F);
}

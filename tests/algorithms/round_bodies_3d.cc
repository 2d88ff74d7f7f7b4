// Round bodies against a direct solution of the discrete law on the same mesh,
// with normals and gaps from closed forms: two cylinders on rods, parallel to
// them and across, and the half ball. Then what is known of the cylinders on
// finer meshes: mirror symmetry, balance of forces, and cycles that do not
// grow.

#include <common/algorithms/nested_iteration.h>

#include <functional>
#include <iostream>
#include <map>

#include <tests/support/check.h>

#include <tests/reference/solutions/dense_contact_3d.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_round_bodies_3d
{
  constexpr double infinity = std::numeric_limits<double>::infinity();

  /** What a scene means, said once more. Its bodies have radius one. */
  struct Body
  {
    std::string scene;

    Eigen::Vector3d                              push; ///< of what is held
    std::function<bool(const Eigen::Vector3d &)> is_held;

    /// The vector from the axis, or from the centre; as long as the radius on
    /// the boundary that may touch.
    std::function<Eigen::Vector3d(const Eigen::Vector3d &)> radial;

    /// Distance of a point from the obstacle along the normal.
    std::function<double(const Eigen::Vector3d &, const Eigen::Vector3d &)> gap;
  };

  /** In the plane across a rod with its axis in the origin and radius 1/2: the
   * smaller root of |x + t n| = 1/2, where n may be shorter than one. A ray
   * that misses the rod or only grazes it has none. */
  double
  distance_to_rod(const Eigen::Vector2d &x, const Eigen::Vector2d &n)
  {
    const double b = x.dot(n), c = x.squaredNorm() - .25,
                 discriminant = b * b - n.squaredNorm() * c;
    if (discriminant < 1e-6 || b >= 0)
      return infinity;
    return (-b - std::sqrt(discriminant)) / n.squaredNorm();
  }

  std::vector<Body>
  bodies()
  {
    using Vector = Eigen::Vector3d;

    Body parallel_rods;
    parallel_rods.scene   = "cylinder";
    parallel_rods.push    = {0, -.03, 0};
    parallel_rods.is_held = [](const Vector &x) {
      return std::min(x[2], 2 - x[2]) < 1e-9;
    };
    parallel_rods.radial = [](const Vector &x) {
      return Vector(x[0], x[1], 0);
    };
    parallel_rods.gap = [](const Vector &x, const Vector &n) {
      double gap = infinity;
      for (const double c : {-.75, .75})
        gap = std::min(
          gap,
          distance_to_rod({x[0] - c, x[1] + .75 * std::sqrt(3.)}, n.head<2>()));
      return gap;
    };

    Body crossing_rods  = parallel_rods;
    crossing_rods.scene = "crossing-rods";
    crossing_rods.push  = {0, -.08, 0};
    crossing_rods.gap   = [](const Vector &x, const Vector &n) {
      double gap = infinity;
      for (const double z : {.5, 1.5})
        gap =
          std::min(gap, distance_to_rod({x[1] + 1.5, x[2] - z}, n.tail<2>()));
      return gap;
    };

    // Pushed harder than in the scene, so that a coarse mesh has some nodes in
    // contact.
    Body half_ball;
    half_ball.scene   = "half-ball";
    half_ball.push    = {0, 0, -.3};
    half_ball.is_held = [](const Vector &x) { return x[2] > -1e-9; };
    half_ball.radial  = [](const Vector &x) { return x; };
    half_ball.gap     = [](const Vector &x, const Vector &n) {
      return (1 + x[2]) / -n[2];
    };

    return {parallel_rods, crossing_rods, half_ball};
  }



  /** The discrete problem. Of the mesh, only vertices and cells are used. */
  Reference::ContactProblem3D
  make_reference(const Triangulation<3> &mesh,
                 const Body             &body,
                 const double            nu,
                 const double            F)
  {
    Reference::ContactProblem3D problem;
    problem.poisson_ratio = nu;
    problem.mesh.nodes.resize(mesh.n_vertices());
    for (const auto &cell : mesh.active_cell_iterators())
      {
        std::array<unsigned int, 8> vertices;
        for (const unsigned int v : cell->vertex_indices())
          {
            const Point<3> &x               = cell->vertex(v);
            vertices[v]                     = cell->vertex_index(v);
            problem.mesh.nodes[vertices[v]] = {x[0], x[1], x[2]};
          }
        problem.mesh.cells.push_back(vertices);
      }
    for (unsigned int p = 0; p < problem.mesh.nodes.size(); ++p)
      {
        const Eigen::Vector3d &x = problem.mesh.nodes[p];
        const Eigen::Vector3d  n = body.radial(x);
        if (body.is_held(x))
          for (unsigned int c = 0; c < 3; ++c)
            problem.dirichlet.push_back({p, c, body.push[c]});
        else if (std::abs(n.norm() - 1) < 1e-9)
          {
            const double gap = body.gap(x, n.normalized());
            if (std::isfinite(gap))
              problem.contact.push_back({p, n.normalized(), gap, F, 0.});
          }
      }
    return problem;
  }



  void
  compare(const Body &body, const double nu, const double F)
  {
    std::ostringstream friction, displacement;
    friction << "Contact/Friction coefficient=" << F;
    displacement << "Boundary conditions/Displacement=1: " << body.push[0]
                 << ", " << body.push[1] << ", " << body.push[2];
    if (body.scene != "half-ball")
      displacement << "; 2: " << body.push[0] << ", " << body.push[1] << ", "
                   << body.push[2];
    const Parameters parameters = without_safeguards(
      read_parameters(SCENES_3D_DIR "/" + body.scene + ".prm",
                      {friction.str(),
                       displacement.str(),
                       "Contact/Friction law=Coulomb",
                       "Refinement/Initial refinements=1",
                       "Solver/Inner tolerance=1e-12"}));
    NestedIteration<3> iteration(parameters);
    iteration.begin();
    const Discretization<3>          &d = iteration.discretization();
    const Reference::ContactProblem3D problem =
      make_reference(iteration.mesh(), body, nu, F);
    const Reference::ContactSolution3D exact = Reference::solve(problem);

    std::vector<unsigned int> vertex(d.constraints().n_nodes());
    for (const auto &cell : d.dof_handler().active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        vertex[d.constraints().node_of_dof(cell->vertex_dof_index(v, 0))] =
          cell->vertex_index(v);
    std::vector<int> contact_number(problem.mesh.nodes.size(), -1);
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      contact_number[problem.contact[p].node] = p;

    std::cout << body.scene << ", F = " << F << ": "
              << exact.state.size() - exact.count(Reference::State::open)
              << " nodes in contact, "
              << exact.count(Reference::State::sticking) << " sticking"
              << std::endl;

    bool         converged          = true;
    double       displacement_error = 0, force_error = 0, geometry_error = 0;
    unsigned int n_different =
      (d.contact().size() == problem.contact.size() ? 0 : 1);
    for (const CoarseCorrection correction :
         {CoarseCorrection::truncated, CoarseCorrection::monotone})
      {
        SolverSettings settings    = parameters.solver;
        settings.coarse_correction = correction;
        VectorType         u;
        ContactState       state(0, false);
        const SolverReport report = iteration.solve_with(settings, u, state);
        converged                 = converged && report.converged;
        for (unsigned int i = 0; i < vertex.size(); ++i)
          for (unsigned int c = 0; c < 3; ++c)
            {
              const unsigned int j = 3 * vertex[i] + c;
              displacement_error   = std::max(
                displacement_error,
                std::abs(u.local_element(3 * i + c) - exact.displacement[j]));
              force_error =
                std::max(force_error,
                         std::abs(-report.residual.local_element(3 * i + c) -
                                  exact.residual[j]));
            }
        for (unsigned int p = 0; p < d.contact().size(); ++p)
          {
            const ContactNode<3> &node = (d.contact())[p];
            const int             q    = contact_number[vertex[node.node]];
            if (q < 0)
              {
                ++n_different;
                continue;
              }
            const Reference::State found = !state.in_contact(p)
              ? Reference::State::open
              : state.sticks(p) ? Reference::State::sticking
                                : Reference::State::sliding;
            n_different += (found != exact.state[q]);
            geometry_error = std::max(
              geometry_error, std::abs(node.gap - problem.contact[q].gap));
            for (unsigned int c = 0; c < 3; ++c)
              geometry_error = std::max(
                geometry_error,
                std::abs(node.normal()[c] - problem.contact[q].normal[c]));
          }
      }
    displacement_error /= exact.displacement.cwiseAbs().maxCoeff();
    force_error /= exact.normal_force.cwiseAbs().maxCoeff();
    check(converged && n_different == 0, "converged, contact nodes and states");
    check_below(geometry_error, 1e-12, "normals and gaps");
    check_below(displacement_error, 1e-9, "displacements");
    check_below(force_error, 1e-9, "nodal forces");
  }



  // ----- symmetry, balance, cycles -----

  // On each mesh whose nodes have their mirror images x -> -x and z -> 2 - z
  // among the nodes, so has the solution.
  unsigned int
  asymmetry(const NestedIteration<3> &iteration, double &difference)
  {
    const Discretization<3>    &d      = iteration.discretization();
    const std::vector<Point<3>> points = node_points(d);
    const auto                  key    = [](const Point<3> &p) {
      return std::array<long, 3>{{std::lround(1e7 * p[0]),
                                  std::lround(1e7 * p[1]),
                                  std::lround(1e7 * p[2])}};
    };
    std::map<std::array<long, 3>, unsigned int> node_of;
    for (unsigned int i = 0; i < points.size(); ++i)
      node_of[key(points[i])] = i;
    std::map<unsigned int, unsigned int> contact_of;
    for (unsigned int p = 0; p < d.contact().size(); ++p)
      contact_of[(d.contact())[p].node] = p;

    const auto  &u = iteration.displacement(), &f = iteration.report().residual;
    unsigned int n_different = 0;
    double       u_scale = 0, f_scale = 0, u_error = 0, f_error = 0;
    for (unsigned int i = 0; i < points.size(); ++i)
      for (const unsigned int mirrored : {0, 2})
        {
          Point<3> image  = points[i];
          image[mirrored] = (mirrored == 0 ? 0. : 2.) - image[mirrored];
          const auto it   = node_of.find(key(image));
          if (it == node_of.end())
            {
              ++n_different;
              continue;
            }
          const unsigned int j = it->second;
          for (unsigned int c = 0; c < 3; ++c)
            {
              const double sign = (c == mirrored ? -1. : 1.);
              const double u_i  = u.local_element(3 * i + c),
                           f_i  = f.local_element(3 * i + c);
              u_error           = std::max(
                u_error, std::abs(u_i - sign * u.local_element(3 * j + c)));
              f_error = std::max(
                f_error, std::abs(f_i - sign * f.local_element(3 * j + c)));
              u_scale = std::max(u_scale, std::abs(u_i));
              f_scale = std::max(f_scale, std::abs(f_i));
            }
          const auto p = contact_of.find(i), q = contact_of.find(j);
          if ((p == contact_of.end()) != (q == contact_of.end()))
            ++n_different;
          else if (p != contact_of.end())
            n_different += (iteration.state().in_contact(p->second) !=
                              iteration.state().in_contact(q->second) ||
                            iteration.state().sticks(p->second) !=
                              iteration.state().sticks(q->second));
        }
    difference = std::max(u_error / u_scale, f_error / f_scale);
    return n_different;
  }

  // Contact forces and the reactions at held nodes, and, if there are no
  // hanging nodes, their moments about the origin: the resultants over the sums
  // of absolute values. Where nodes hang on a curved boundary they do not lie
  // in the middle of their masters, but are displaced like the middle, so that
  // a small rotation is no longer free of strain, nor are moments in balance.
  double
  imbalance(const NestedIteration<3> &iteration)
  {
    const Discretization<3>    &d      = iteration.discretization();
    const std::vector<Point<3>> points = node_points(d);
    std::vector<bool>           loaded(points.size(), false);
    for (const ContactNode<3> &node : d.contact())
      loaded[node.node] = true;

    Tensor<1, 3> force, moment;
    double       sum           = 0;
    bool         nothing_hangs = true;
    for (unsigned int i = 0; i < points.size(); ++i)
      {
        nothing_hangs = nothing_hangs && !d.constraints().is_hanging(i);
        if (!loaded[i] && !d.constraints().is_fixed(i))
          continue;
        Tensor<1, 3> f;
        for (unsigned int c = 0; c < 3; ++c)
          f[c] = iteration.report().residual.local_element(3 * i + c);
        force += f;
        moment += cross_product_3d(points[i], f);
        sum += f.norm();
      }
    return std::max(force.norm(), nothing_hangs ? moment.norm() : 0.) / sum;
  }

  void
  run(const std::string              &what,
      const std::string              &scene,
      const std::vector<std::string> &overrides)
  {
    std::cout << what << std::endl;
    Parameters parameters = without_safeguards(
      read_parameters(SCENES_3D_DIR "/" + scene + ".prm", overrides));
    NestedIteration<3> iteration(parameters);
    iteration.begin();
    bool         converged = true;
    unsigned int n_cycles = 0, n_different = 0;
    double       largest_difference = 0, largest_imbalance = 0;
    do
      {
        iteration.solve();
        converged = converged && iteration.report().converged;
        if (iteration.level() >= 2)
          n_cycles =
            std::max<unsigned int>(n_cycles, iteration.report().cycles.size());
        double             difference;
        const unsigned int n = asymmetry(iteration, difference);
        n_different += n;
        largest_difference = std::max(largest_difference, difference);
        const double e     = imbalance(iteration);
        largest_imbalance  = std::max(largest_imbalance, e);
    } while (iteration.advance());
    check(converged, "converged");
    check(n_different == 0, "nodes and their states are symmetric");
    check_below(
      largest_difference, 1e-7, "displacements and forces are symmetric");
    check_below(largest_imbalance, 1e-8, "what acts on the body is in balance");
    check_below(n_cycles, 15, "cycles on each level from the second on");
  }
} // namespace test_round_bodies_3d

TEST(round_bodies_3d)
{
  for (const Body &body : bodies())
    for (const double F : {0., .1, .4})
      compare(body, body.scene == "half-ball" ? .3 : .325, F);

  run("cylinder, uniform refinement",
      "cylinder",
      {"Refinement/Strategy=uniform",
       "Refinement/Initial refinements=0",
       "Refinement/Maximum dofs=4000"});
  run("cylinder, adaptive refinement",
      "cylinder",
      {"Refinement/Initial refinements=0",
       "Refinement/Marking=0.5",
       "Refinement/Maximum dofs=15000"});
  run("crossing-rods, adaptive refinement",
      "crossing-rods",
      {"Refinement/Maximum dofs=15000", "Solver/Inner tolerance=1e-9"});
}

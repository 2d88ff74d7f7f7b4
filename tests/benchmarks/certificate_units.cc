// What the certificate says of errors of a known size, in the units that it had
// until version 0.2 and in those that it has: a table of doc/benchmark.
//
// Usage: benchmark-certificate_units ROOT DOFS [SCENE ...]
//
// ROOT is that of the repository, DOFS about the size of the finest meshes.
// Scenes are all that are shipped, or those named. Each is solved, and then
// looked at as if one thing in the problem were another, by one part in a
// thousand: the coefficient of friction, the place of the obstacle (of the
// largest displacement), the shear modulus. So it is a solution with an error
// of that size. Units should make the same number of it
// - on three meshes, the finest one, one with about a quarter of its unknowns
//   and one with a sixteenth,
// - with a clamp: the upper quarter of the body is a thousand times stiffer,
// - with an obstacle that is farther off: body and obstacle have ten times the
//   indentation between them, which the prescribed displacement makes up for,
// - in other units of length and force.
//
// The last three are tried where the problem stays the same: with a clamp that
// is not in contact itself, with planes, and with data that are not made for
// one place. Of a history it is the last step that is looked at, on each of the
// meshes.
//
// The last column is the ratio of the largest number of a row to the smallest.
// The length by which the obstacle is displaced is given, and the stress that
// it means is divided by the peak pressure; so there it is the ratio of these
// stresses, which does not change where the peak pressure does: with the mesh
// at the corners of a block, or with the clamp.
//
// The exit status is 1 if it is more than two for what the certificate says.

#include <common/algorithms/nested_iteration.h>

#include <deal.II/base/bounding_box.h>

#include <deal.II/grid/grid_tools.h>

#include <tests/benchmarks/benchmark.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

namespace benchmark_certificate_units
{
  using namespace dealii;
  using namespace Friction;

  using Entries = std::vector<std::string>;

  // What has to be changed in a scene.
  struct Variants
  {
    unsigned int vertical;
    Entries      farther_off, other_units;

    /// In all runs; not empty where the scene is a history, and makes it short.
    Entries always = {};

    /// Whether there is room for a clamp that does not touch the obstacle.
    bool clamp = true;
  };

  const std::map<std::string, Variants> scenes_2d = {
    {"hertz",
     {1,
      {"Obstacle/Point=0, -1.062",
       "Boundary conditions/Displacement=1: 0, -0.0682"},
      {"Scene/Radius=0.001",
       "Material/Young's modulus=1e11",
       "Obstacle/Point=0, -0.001",
       "Boundary conditions/Displacement=1: 0, -0.0000062"}}},
    {"block",
     {1,
      {"Obstacle/Point=0, -0.2",
       "Boundary conditions/Displacement=3: 0.02, -0.22"},
      {"Scene/Size=0.001, 0.001",
       "Material/Young's modulus=1e11",
       "Boundary conditions/Displacement=3: 0.00002, -0.00002"}}},
    {"tresca",
     {1,
      {"Obstacle/Point=0, -0.2",
       "Boundary conditions/Displacement=3: 0.02, -0.22"},
      {}}},
    {"punch",
     {1,
      {"Obstacle/Point=0, -0.04",
       "Boundary conditions/Displacement=2: 0.001, -0.044"},
      {}}},
    {"raous", {1, {}, {}}},
    {"manufactured", {1, {}, {}}},
    {"incompressible", {1, {}, {}}},
    {"stick-slip", {1, {}, {}}},
    {"ice",
     {1,
      {"Obstacle/Point=0, -0.2",
       "Boundary conditions/Displacement=3: 0.006, -0.22"},
      {}}},
    {"wheel",
     {1,
      {"Obstacle/Point=0, -1.1",
       "Boundary conditions/Displacement=1: 0.006, -0.11"},
      {}}},
    {"pin", {1, {}, {}, {}, false}},
    {"wall", {1, {}, {}, {}, false}},
    {"rough", {1, {}, {}}},
    {"inclined",
     {1,
      {"Obstacle/Point=0, -0.05",
       "Boundary conditions/Displacement=3: 0, -0.055"},
      {},
      {"Load steps/Times=0.5, 0.9"}}},
    {"mindlin",
     {1,
      {"Obstacle/Point=0, -1.062",
       "Scene/Constants=U_turn = 0.003; depth = 0.0682"},
      {},
      {"Load steps/Times=0, 2, 4, 6"}}}};

  const std::map<std::string, Variants> scenes_3d = {
    {"cylinder", {1, {}, {}}},
    {"crossing-rods", {1, {}, {}}},
    {"cylinder-thesis", {1, {}, {}}},
    {"half-ball",
     {2,
      {"Obstacle/Point=0, 0, -1.1",
       "Boundary conditions/Displacement=1: 0, 0, -0.11"},
      {}}},
    {"ball-on-ball", {2, {}, {}, {"Load steps/Times=0, 1"}}},
    {"mindlin",
     {2,
      {"Obstacle/Point=0, 0, -1.1",
       "Scene/Constants=U_turn = 0.003; depth = 0.11"},
      {},
      {"Load steps/Times=0, 2, 4"}}},
    {"extruded-hertz",
     {1,
      {"Obstacle/Point=0, -1.062, 0",
       "Boundary conditions/Displacement=1: 0, -0.0682, 0; "
       "2: free, free, 0; 3: free, free, 0"},
      {}}},
    {"block",
     {2,
      {"Obstacle/Point=0, 0, -0.2",
       "Boundary conditions/Displacement=5: 0.02, 0.01, -0.22"},
      {"Scene/Size=0.001, 0.001, 0.001",
       "Material/Young's modulus=1e11",
       "Boundary conditions/Displacement=5: 0.00002, 0.00001, -0.00002"}}},
    {"stick-slip", {2, {}, {}}}};

  enum Error
  {
    of_friction,
    of_obstacle,
    of_stiffness,
    n_errors
  };
  constexpr std::array<const char *, n_errors> error_names = {
    {"friction", "obstacle", "stiffness"}};

  constexpr double error_size = 1e-3;

  // What certificates say of the errors.
  struct Violations
  {
    std::array<double, n_errors> before{}, after{};
    double                       dofs     = 0;
    double                       pressure = 0; // the largest, over E
  };



  // Forces relative to the largest one, lengths to the largest displacement or
  // distance on the contact boundary, as it was. All of it is of one process.
  template <int dim>
  double
  former_certificate(const DiscreteProblem<dim> &problem,
                     const VectorType           &u,
                     const VectorType           &r,
                     const ContactState         &state)
  {
    const auto       &contact = problem.contact;
    std::vector<char> is_contact_node(problem.constraints.n_owned_nodes(), 0);
    double            force = 0, length = 0, unbalanced = 0, result = 0;
    for (const auto &p : contact)
      {
        is_contact_node[p.node] = 1;
        length = std::max(length, std::abs(normal_component(p, u) - p.gap));
        for (unsigned int d = 0; d < dim; ++d)
          length =
            std::max(length, std::abs(u.local_element(dim * p.node + d)));
      }
    for (unsigned int i = 0; i < r.locally_owned_size(); ++i)
      if (!problem.constraints.is_hanging(i / dim))
        {
          force = std::max(force, std::abs(r.local_element(i)));
          if (!is_contact_node[i / dim] &&
              !problem.constraints.is_prescribed(i / dim, i % dim))
            unbalanced = std::max(unbalanced, std::abs(r.local_element(i)));
        }
    result = unbalanced / force;
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const double pressing = normal_component(contact[p], r) / force;
        const double room =
          (contact[p].gap - normal_component(contact[p], u)) / length;
        const double bound = problem.effective_coefficient(contact[p]) *
          (problem.has_coulomb_friction(contact[p])
             ? std::max(0., pressing)
             : state.normal_force(p) / force);
        const auto r_T  = tangential_components<dim>(contact[p], r);
        const auto u_T  = slip_components<dim>(contact[p], u);
        double     slip = 0, drag = 0, deviation = 0;
        for (unsigned int t = 0; t < dim - 1; ++t)
          slip = std::hypot(slip, u_T[t]);
        for (unsigned int t = 0; t < contact[p].n_free_tangents; ++t)
          {
            drag = std::hypot(drag, r_T[t] / force);
            if (slip > 0)
              deviation =
                std::hypot(deviation, r_T[t] / force - bound * u_T[t] / slip);
          }
        result = std::max({result,
                           -room,
                           -pressing,
                           std::min(pressing, room),
                           drag - bound,
                           std::min(deviation, slip / length)});
      }
    return result;
  }



  // With the same Lame constant and another shear modulus.
  Material
  with_other_shear_modulus(const Material &material)
  {
    const double lambda = material.lambda();
    const double mu     = (1 + error_size) * material.mu();
    return Material(mu * (3 * lambda + 2 * mu) / (lambda + mu),
                    lambda / (2 * (lambda + mu)),
                    material.volumetric_strain());
  }



  // The form of materials by region, each of them changed.
  template <int dim>
  CellForm<dim>
  elasticity_of(const Materials<dim>                            &materials,
                const std::function<Material(const Material &)> &change)
  {
    std::vector<CellForm<dim>> forms;
    for (const Material &material : materials.of_regions())
      forms.push_back(elasticity<dim>(change(material)));
    return [=](const FEValues<dim> &values, CellBlocks<dim> &blocks) {
      forms[materials.region(values.get_cell())](values, blocks);
    };
  }



  template <int dim>
  CellForm<dim>
  with_clamp(const CellForm<dim> &form,
             const double         factor,
             const double         above,
             const unsigned int   vertical)
  {
    return [=](const FEValues<dim> &values, CellBlocks<dim> &blocks) {
      form(values, blocks);
      if (values.get_cell()->center()[vertical] > above)
        blocks *= factor;
    };
  }



  // The violations on each level of a run, and in each later load step.
  // @param distance  of the error of the obstacle; zero: a thousandth of the
  //                  largest displacement, which it is set to.
  template <int dim>
  std::vector<Violations>
  run(const Parameters  &parameters,
      const double       clamp,
      const unsigned int vertical,
      double            &distance)
  {
    const auto coarse = make_triangulation<dim>();
    Scene<dim>(parameters).make_coarse_mesh(*coarse);
    const auto   box = GridTools::compute_bounding_box(*coarse);
    const double above =
      box.lower_bound(vertical) + .75 * box.side_length(vertical);
    const auto materials = Scene<dim>(parameters).materials();
    const auto form =
      [&](const std::function<Material(const Material &)> &change) {
        return with_clamp<dim>(
          elasticity_of<dim>(materials, change), clamp, above, vertical);
      };
    NestedIteration<dim>    nest(parameters,
                              form([](const Material &m) { return m; }));
    std::vector<Violations> result;
    nest.begin();
    bool more = true;
    while (more)
      {
        if (!nest.solve().converged)
          throw ExcMessage("A scene is not solved.");
        const DiscreteProblem<dim> &problem = nest.discretization().problem();
        const VectorType           &u       = nest.displacement();
        const ContactState         &state   = nest.state();
        const VectorType           &r       = nest.report().residual;
        Violations                  level;
        for (const auto &p : problem.contact)
          level.pressure = std::max(level.pressure,
                                    normal_component(p, r) / p.measure /
                                      parameters.material.youngs_modulus());
        level.dofs      = nest.discretization().dof_handler().n_dofs();
        const auto look = [&](const Error                 error,
                              const DiscreteProblem<dim> &with_problem,
                              const VectorType           &with_u,
                              const VectorType           &with_r) {
          level.before[error] =
            former_certificate(with_problem, with_u, with_r, state);
          level.after[error] =
            make_certificate(with_problem, with_u, with_r, state).largest();
        };

        DiscreteProblem<dim> rougher = problem;
        rougher.friction_coefficient *= 1 + error_size;
        look(of_friction, rougher, u, r);

        if (distance == 0)
          distance = error_size * u.linfty_norm();
        VectorType deeper(u);
        for (const auto &p : problem.contact)
          for (unsigned int d = 0; d < dim; ++d)
            deeper.local_element(dim * p.node + d) += distance * p.normal()[d];
        look(of_obstacle, problem, deeper, r);

        Discretization<dim> other(nest.scene(), nest.mesh());
        other.set_up();
        other.assemble(form(with_other_shear_modulus));
        VectorType with_other(r);
        other.stiffness().residual(with_other, problem.forces, u);
        look(of_stiffness, problem, u, with_other);

        result.push_back(level);
        more = nest.advance() || nest.begin_next_load_step();
      }
    return result;
  }



  // The last one that is no larger than a part of the largest.
  const Violations &
  of_size(const std::vector<Violations> &levels, const double dofs)
  {
    std::size_t i = levels.size() - 1;
    while (i > 0 && levels[i].dofs > dofs)
      --i;
    return levels[i];
  }



  template <int dim>
  bool
  study(const std::string &root,
        const std::string &name,
        const Variants    &variants,
        const double       dofs)
  {
    const std::string path = root + "/step-friction-" + std::to_string(dim) +
      "d/scenes/" + name + ".prm";
    double     distance = 0;
    const auto solve =
      [&](Entries entries, const double limit, const double clamp) {
        entries.insert(
          entries.begin(), variants.always.begin(), variants.always.end());
        entries.push_back("Refinement/Maximum dofs=" +
                          std::to_string(static_cast<unsigned int>(limit)));
        entries.push_back("Refinement/Levels=25");
        entries.push_back("Solver/Inner tolerance=1e-9");
        return run<dim>(
          read_parameters(path, entries), clamp, variants.vertical, distance);
      };

    // On the middle one of the three meshes, or nearly so, all else is tried.
    const auto   levels = solve({}, dofs / 2, 1.);
    const double finest = levels.back().dofs;
    // That of a history is the last step, on a mesh of its own.
    const auto on_mesh = [&](const double limit) {
      const Violations &found = of_size(levels, limit);
      return variants.always.empty() || &found == &levels.back()
        ? found
        : solve({}, found.dofs, 1.).back();
    };
    std::vector<Violations> columns = {
      on_mesh(finest / 10), on_mesh(finest / 3), on_mesh(finest)};
    const double limit = columns[1].dofs;
    columns.push_back(variants.clamp ? solve({}, limit, 1000.).back()
                                     : Violations());
    columns.push_back(variants.farther_off.empty()
                        ? Violations()
                        : solve(variants.farther_off, limit, 1.).back());
    double unit = 1e-3 * distance;
    std::swap(distance, unit);
    columns.push_back(variants.other_units.empty()
                        ? Violations()
                        : solve(variants.other_units, limit, 1.).back());

    bool good = true;
    for (unsigned int e = 0; e < n_errors; ++e)
      for (const bool is_new : {false, true})
        {
          std::printf("%-20s %-10s %-7s",
                      is_new || e > 0
                        ? ""
                        : (name + " (" + std::to_string(dim) + "D)").c_str(),
                      is_new ? "" : error_names[e],
                      is_new ? "after" : "before");
          double smallest = 1e300, largest = 0;
          for (const Violations &c : columns)
            {
              const double value = is_new ? c.after[e] : c.before[e];
              if (c.dofs == 0)
                std::printf("        -");
              else
                std::printf(" %8.1e", value);
              // What is a rounding error has no size: where nothing slides, the
              // solution is right for any larger coefficient of friction.
              if (c.dofs > 0 && c.after[e] > 1e-8)
                {
                  const double stress =
                    value * (is_new && e == of_obstacle ? c.pressure : 1.);
                  smallest = std::min(smallest, stress);
                  largest  = std::max(largest, stress);
                }
            }
          const double spread = largest > 0 ? largest / smallest : 1.;
          std::printf(" %8.1f\n", spread);
          good = good && (!is_new || spread <= 2.);
        }
    std::fflush(stdout);
    return good;
  }
} // namespace benchmark_certificate_units

BENCHMARK(certificate_units)
{
  try
    {
      if (argc < 3)
        throw std::runtime_error(
          "Usage: benchmark-certificate_units ROOT DOFS [SCENE ...]");
      const std::string root = argv[1];
      const double      dofs = std::stod(argv[2]);
      const Entries     names(argv + 3, argv + argc);
      const auto        wanted = [&](const std::string &name) {
        return names.empty() ||
          std::find(names.begin(), names.end(), name) != names.end();
      };
      std::printf("%-20s %-10s %-7s %8s %8s %8s %8s %8s %8s %8s\n",
                  "scene",
                  "error",
                  "units",
                  "coarse",
                  "medium",
                  "fine",
                  "clamp",
                  "far off",
                  "mm, Pa",
                  "spread");
      bool good = true;
      for (const auto &scene : scenes_2d)
        if (wanted(scene.first))
          good &= study<2>(root, scene.first, scene.second, dofs);
      for (const auto &scene : scenes_3d)
        if (wanted(scene.first + "-3d"))
          good &= study<3>(root, scene.first, scene.second, dofs);
      return good ? 0 : 1;
    }
  catch (const std::exception &error)
    {
      std::cerr << error.what() << std::endl;
      return 1;
    }
  return 0;
}

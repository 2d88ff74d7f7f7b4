// The scenes that state their exact solution: is it one? Balance of forces
// inside, given tractions and displacements on the boundary, and the law of
// contact and friction at the bottom, all by finite differences.

#include <common/scene/scene.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <functional>
#include <iostream>

#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;

namespace test_solutions
{
  template <int dim>
  std::string
  scene_file(const std::string &name)
  {
    return SOURCE_DIR "/../../step-friction-" + std::to_string(dim) +
      "d/scenes/" + name + ".prm";
  }



  // Stress at a point, by central differences of the displacement.
  template <int dim>
  Tensor<2, dim>
  stress(const Scene<dim> &scene, const Point<dim> &p)
  {
    const double   h = 1e-4;
    const auto    &u = *scene.exact_displacement();
    Tensor<2, dim> gradient;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int d = 0; d < dim; ++d)
        {
          Point<dim> above = p, below = p;
          above[d] += h;
          below[d] -= h;
          gradient[c][d] = (u.value(above, c) - u.value(below, c)) / (2. * h);
        }
    Tensor<2, dim> sigma =
      scene.materials().base().mu() * (gradient + transpose(gradient));
    for (unsigned int d = 0; d < dim; ++d)
      sigma[d][d] += scene.materials().base().lambda() * trace(gradient);
    return sigma;
  }



  // Largest violations at a number of points, relative to the largest stress.
  // The body is a rectangle of the given size, in contact where its last
  // coordinate is zero.
  template <int dim>
  void
  check(const std::string              &name,
        const std::vector<std::string> &overrides,
        const Tensor<1, dim>           &size)
  {
    const Parameters parameters =
      read_parameters(scene_file<dim>(name), overrides);
    const Scene<dim> scene(parameters);
    const double   angle = parameters.scene.rotation_angle * numbers::PI / 180.;
    Tensor<2, dim> Q(unit_symmetric_tensor<dim>());
    Q[0][0] = Q[1][1] = std::cos(angle);
    Q[1][0]           = std::sin(angle);
    Q[0][1]           = -Q[1][0];
    const auto at     = [&](Point<dim> p) {
      for (unsigned int d = 0; d < dim; ++d)
        p[d] *= size[d];
      return Point<dim>(Q * p);
    };
    const auto &u            = *scene.exact_displacement();
    const auto  displacement = [&](const Point<dim> &p) {
      Tensor<1, dim> value;
      for (unsigned int c = 0; c < dim; ++c)
        value[c] = u.value(p, c);
      return value;
    };

    const unsigned int n       = 29;
    const double       h       = 1e-3;
    double             balance = 0., traction = 0., difference = 0., law = 0.;
    double             scale  = 0.;
    unsigned int       n_open = 0, n_slip = 0, n_stick = 0;
    for (unsigned int i = 0; i < n; ++i)
      {
        // In the unit square or cube, a point of which all but the last
        // coordinate wander through it, and its projection to a side.
        Point<dim> place;
        place[0] = (i + .5) / n;
        if (dim == 3)
          place[1] = std::fmod((i + .5) / 1.618034, 1.);
        const auto on_side = [&](const unsigned int id) {
          Point<dim>   p;
          unsigned int next = 0;
          for (unsigned int d = 0; d < dim; ++d)
            p[d] = (d == id / 2 ? id % 2 : place[next++]);
          return at(p);
        };
        const auto outward_normal = [&](const unsigned int id) {
          Tensor<1, dim> normal;
          normal[id / 2] = (id % 2 == 1 ? 1. : -1.);
          return Q * normal;
        };

        for (const double height : {.2, .7})
          {
            place[dim - 1]     = height;
            const Point<dim> p = at(place);
            Tensor<1, dim>   residual;
            if (scene.body_force())
              for (unsigned int c = 0; c < dim; ++c)
                residual[c] = scene.body_force()->value(p, c);
            for (unsigned int d = 0; d < dim; ++d)
              {
                Point<dim> above = p, below = p;
                above[d] += h;
                below[d] -= h;
                const Tensor<2, dim> change =
                  stress(scene, above) - stress(scene, below);
                for (unsigned int c = 0; c < dim; ++c)
                  residual[c] += change[c][d] / (2. * h);
              }
            balance = std::max(balance, residual.norm());
            scale   = std::max(scale, stress(scene, p).norm());
          }

        for (const auto &condition : scene.traction_conditions())
          {
            const Point<dim>     p = on_side(condition.boundary_id);
            const Tensor<1, dim> t =
              stress(scene, p) * outward_normal(condition.boundary_id);
            for (unsigned int c = 0; c < dim; ++c)
              traction = std::max(
                traction, std::abs(t[c] - condition.traction->value(p, c)));
          }
        for (const auto &condition : scene.dirichlet_conditions())
          {
            const Point<dim> p = on_side(condition.boundary_id);
            for (unsigned int c = 0; c < dim; ++c)
              difference = std::max(
                difference,
                std::abs(u.value(p, c) - condition.displacement->value(p, c)));
          }

        // At the bottom.
        const Tensor<1, dim> normal = outward_normal(2 * dim - 2);
        const Point<dim>     p      = on_side(2 * dim - 2);
        const Tensor<1, dim> t      = stress(scene, p) * normal;
        const double         gap =
          scene.contact_conditions()[0].obstacle.gap(p, normal);
        const Tensor<1, dim> value    = displacement(p);
        const double         pressure = -(t * normal);
        const Tensor<1, dim> shear    = t - (t * normal) * normal;
        const Tensor<1, dim> slip     = value - (value * normal) * normal;
        const double         bound =
          scene.contact_conditions()[0].friction_coefficient * pressure;
        const double distance = gap - value * normal;
        const bool   open     = distance > 1e-9;
        const bool   slipping = slip.norm() > 1e-9;
        ++(open ? n_open : slipping ? n_slip : n_stick);
        law = std::max(
          {law,
           -distance,
           -pressure,
           open ? std::abs(pressure) : 0.,
           shear.norm() - bound,
           slipping ? (shear + bound / slip.norm() * slip).norm() : 0.});
      }
    const auto small = [&](const double value, const double tolerance) {
      return value < tolerance * scale ? "holds" : "FAILS";
    };
    std::cout << name << ": balance " << small(balance, 1e-3) << ", tractions "
              << small(traction, 1e-5) << ", displacements "
              << small(difference, 1e-12) << ", law " << small(law, 1e-5)
              << "; open " << n_open << ", slip " << n_slip << ", stick "
              << n_stick << std::endl;
  }



  // The others are at least read.
  template <int dim>
  void
  print(const std::string &name)
  {
    const Scene<dim>   scene(read_parameters(scene_file<dim>(name)));
    Triangulation<dim> mesh;
    scene.make_coarse_mesh(mesh);
    std::cout << name << ": F "
              << scene.contact_conditions()[0].friction_coefficient << ", "
              << mesh.n_active_cells() << " cells, "
              << scene.dirichlet_conditions().size() << " Dirichlet, "
              << scene.traction_conditions().size() << " traction, "
              << scene.pinned_points().size() << " pinned" << std::endl;
  }
} // namespace test_solutions

TEST(solutions)
{
  const Tensor<1, 2> long_block({3., 1.}), block({2., 1.});
  check("manufactured", {}, long_block);
  check("manufactured", {"Contact/Friction coefficient=0.8"}, long_block);
  check("manufactured",
        {"Material/Poisson ratio=0.45", "Scene/Rotation angle=30"},
        long_block);
  check("incompressible", {}, long_block);
  check("incompressible", {"Material/Poisson ratio=0.3"}, long_block);
  check("incompressible", {"Material/Poisson ratio=0.4999"}, long_block);
  const std::string others = "Scene/Constants=L=2;H=1;d=0.02;gap=0.01;U=";
  check("stick-slip", {}, block);
  check("stick-slip", {others + "0.01"}, block);
  check("stick-slip", {others + "0.0277"}, block);
  check("stick-slip", {others + "0.0283"}, block);
  check("stick-slip", {"Scene/Rotation angle=30"}, block);
  check("stick-slip", {"Material/Young's modulus=1e5"}, block);

  const Tensor<1, 3> box({1.5, 1., 1.});
  const std::string  others_3d = "Scene/Constants=L=1.5;W=1;H=1;d=0.02;";
  check("stick-slip", {}, box);
  check("stick-slip", {others_3d + "gap=0; alpha=2.5; U=0.01"}, box);
  check("stick-slip", {others_3d + "gap=0.01; alpha=-1; U=0.0277"}, box);
  check("stick-slip", {others_3d + "gap=0.01; alpha=-1; U=0.0283"}, box);
  check("stick-slip",
        {"Scene/Rotation angle=30", "Material/Young's modulus=1e5"},
        box);

  for (const std::string name : {"hertz", "block", "raous"})
    print<2>(name);
  for (const std::string name :
       {"block", "cylinder", "crossing-rods", "extruded-hertz", "half-ball"})
    print<3>(name);
}

// The scenes that state their exact solution: is it one? Balance of forces
// inside, given tractions and displacements on the boundary, and the law of
// contact and friction at the bottom, all by finite differences.

#include <common/scene/scene.h>

#include <cmath>
#include <functional>
#include <iostream>

using namespace dealii;
using namespace Friction;

namespace
{
  // Stress at a point, by central differences of the displacement.
  Tensor<2, 2>
  stress(const Scene<2> &scene, const Point<2> &p)
  {
    const double h = 1e-4;
    const auto  &u = *scene.exact_displacement();
    Tensor<2, 2> gradient;
    for (unsigned int c = 0; c < 2; ++c)
      for (unsigned int d = 0; d < 2; ++d)
        {
          Point<2> above = p, below = p;
          above[d] += h;
          below[d] -= h;
          gradient[c][d] = (u.value(above, c) - u.value(below, c)) / (2. * h);
        }
    Tensor<2, 2> sigma =
      scene.material().mu() * (gradient + transpose(gradient));
    for (unsigned int d = 0; d < 2; ++d)
      sigma[d][d] += scene.material().lambda() * trace(gradient);
    return sigma;
  }



  // Largest violations at a number of points, relative to the largest stress.
  void
  check(const std::string              &name,
        const std::vector<std::string> &overrides,
        const Tensor<1, 2>             &size)
  {
    const Parameters parameters = read_parameters(
      SOURCE_DIR "/../../step-friction-2d/scenes/" + name + ".prm", overrides);
    const Scene<2> scene(parameters);
    const double   angle = parameters.scene.rotation_angle * numbers::PI / 180.;
    const Tensor<2, 2> Q({{std::cos(angle), -std::sin(angle)},
                          {std::sin(angle), std::cos(angle)}});
    const auto         at = [&](const double x, const double y) {
      return Point<2>(Q * Point<2>(x * size[0], y * size[1]));
    };
    const auto &u = *scene.exact_displacement();

    const unsigned int n       = 29;
    const double       h       = 1e-3;
    double             balance = 0., traction = 0., displacement = 0., law = 0.;
    double             scale  = 0.;
    unsigned int       n_open = 0, n_slip = 0, n_stick = 0;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double s = (i + .5) / n;

        for (const double y : {.2, .7})
          {
            const Point<2> p = at(s, y);
            Tensor<1, 2>   residual;
            if (scene.body_force())
              for (unsigned int c = 0; c < 2; ++c)
                residual[c] = scene.body_force()->value(p, c);
            for (unsigned int d = 0; d < 2; ++d)
              {
                Point<2> above = p, below = p;
                above[d] += h;
                below[d] -= h;
                const Tensor<2, 2> difference =
                  stress(scene, above) - stress(scene, below);
                for (unsigned int c = 0; c < 2; ++c)
                  residual[c] += difference[c][d] / (2. * h);
              }
            balance = std::max(balance, residual.norm());
            scale   = std::max(scale, stress(scene, p).norm());
          }

        // Points and outward normals of the sides, by boundary id.
        const Point<2>     points[4] = {at(0, s), at(1, s), at(s, 0), at(s, 1)};
        const Tensor<1, 2> ex({1., 0.}), ey({0., 1.});
        const Tensor<1, 2> normals[4] = {-Q * ex, Q * ex, -Q * ey, Q * ey};
        for (const auto &condition : scene.traction_conditions())
          {
            const Point<2>     p = points[condition.boundary_id];
            const Tensor<1, 2> t =
              stress(scene, p) * normals[condition.boundary_id];
            for (unsigned int c = 0; c < 2; ++c)
              traction = std::max(
                traction, std::abs(t[c] - condition.traction->value(p, c)));
          }
        for (const auto &condition : scene.dirichlet_conditions())
          {
            const Point<2> p = points[condition.boundary_id];
            for (unsigned int c = 0; c < 2; ++c)
              displacement = std::max(
                displacement,
                std::abs(u.value(p, c) - condition.displacement->value(p, c)));
          }

        // At the bottom.
        const Tensor<1, 2> normal = normals[2], tangent = Q * ex;
        const Point<2>     p   = points[2];
        const Tensor<1, 2> t   = stress(scene, p) * normal;
        const double       gap = scene.obstacle().gap(p, normal);
        const Tensor<1, 2> value({u.value(p, 0), u.value(p, 1)});
        const double       pressure = -(t * normal);
        const double       shear    = t * tangent;
        const double       slip     = value * tangent;
        const double       bound    = scene.friction_coefficient() * pressure;
        const double       distance = gap - value * normal;
        const bool         open     = distance > 1e-9;
        const bool         slipping = std::abs(slip) > 1e-9;
        ++(open ? n_open : slipping ? n_slip : n_stick);
        law = std::max(
          {law,
           -distance,
           -pressure,
           open ? std::abs(pressure) : 0.,
           std::abs(shear) - bound,
           slipping ? std::abs(shear + bound * std::copysign(1., slip)) : 0.});
      }
    const auto small = [&](const double value, const double tolerance) {
      return value < tolerance * scale ? "holds" : "FAILS";
    };
    std::cout << name << ": balance " << small(balance, 1e-3) << ", tractions "
              << small(traction, 1e-5) << ", displacements "
              << small(displacement, 1e-12) << ", law " << small(law, 1e-5)
              << "; open " << n_open << ", slip " << n_slip << ", stick "
              << n_stick << std::endl;
  }
} // namespace

int
main()
{
  const Tensor<1, 2> long_block({3., 1.}), block({2., 1.});
  check("manufactured", {}, long_block);
  check("manufactured", {"Contact/Friction coefficient=0.8"}, long_block);
  check("manufactured",
        {"Material/Poisson ratio=0.45", "Scene/Rotation angle=30"},
        long_block);
  const std::string others = "Scene/Constants=L=2;H=1;d=0.02;gap=0.01;U=";
  check("stick-slip", {}, block);
  check("stick-slip", {others + "0.01"}, block);
  check("stick-slip", {others + "0.0277"}, block);
  check("stick-slip", {others + "0.0283"}, block);
  check("stick-slip", {"Scene/Rotation angle=30"}, block);
  check("stick-slip", {"Material/Young's modulus=1e5"}, block);

  // The others are at least read.
  for (const std::string name : {"hertz", "block", "raous"})
    {
      const Scene<2>   scene(read_parameters(
        SOURCE_DIR "/../../step-friction-2d/scenes/" + name + ".prm"));
      Triangulation<2> mesh;
      scene.make_coarse_mesh(mesh);
      std::cout << name << ": F " << scene.friction_coefficient() << ", "
                << mesh.n_active_cells() << " cells, "
                << scene.dirichlet_conditions().size() << " Dirichlet, "
                << scene.traction_conditions().size() << " traction, "
                << scene.pinned_points().size() << " pinned" << std::endl;
    }
}

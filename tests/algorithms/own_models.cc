// Models as engineers of contact bring them along, each against something that
// is known of it: a block that is dragged up a slope, a ring on a disc, a block
// from a mesh file that a force presses onto a ball, and a block on a rough
// ground that a formula gives. On the slope forces have Coulomb's ratio; ring
// and ball, without friction, have Hertz's pressure for the force that there
// is; and on waves the pressure is Westergaard's.

#include <common/algorithms/nested_iteration.h>
#include <common/contact/force_balance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_own_models
{
  using Entries = std::vector<std::string>;

  const double plane_strain_modulus = 1. / (1. - .3 * .3);



  template <int dim>
  std::unique_ptr<NestedIteration<dim>>
  solved(const Entries &entries)
  {
    const std::string name = "own-models.prm";
    std::ofstream(name) << "# All is said by the overrides.\n";
    Entries all = {"Material/Young's modulus=1", "Material/Poisson ratio=0.3"};
    all.insert(all.end(), entries.begin(), entries.end());
    auto nest = std::make_unique<NestedIteration<dim>>(
      without_safeguards(read_parameters(name, all)));
    nest->begin();
    bool converged = true;
    do
      converged = nest->solve().converged && converged;
    while (nest->advance());
    check(converged, "converges");
    check_below(force_balance(nest->discretization(), nest->report().residual)
                  .imbalance(),
                1e-6,
                "forces balance");
    return nest;
  }



  // What a part of the boundary does to the body.
  template <int dim>
  ForceOnBody<dim>
  force(const NestedIteration<dim> &nest, const std::string &name)
  {
    for (const ForceOnBody<dim> &part :
         force_balance(nest.discretization(), nest.report().residual).forces)
      if (part.name == name)
        return part;
    AssertThrow(false, ExcInternalError());
    return ForceOnBody<dim>();
  }



  template <int dim>
  double
  pressure(const NestedIteration<dim> &nest, const ContactNode<dim> &node)
  {
    return normal_component(node, nest.report().residual) / node.measure;
  }



  template <int dim>
  double
  largest_pressure(const NestedIteration<dim> &nest)
  {
    double largest = 0;
    for (const ContactNode<dim> &node : nest.discretization().contact())
      largest = std::max(largest, pressure(nest, node));
    return largest;
  }



  // A mesh file in Gmsh's format, of hexahedra or quadrilaterals in rows: a
  // grid whose vertices are where a function has them, and the boundary ids at
  // both ends of each direction.
  template <int dim>
  void
  write_mesh(
    const std::string                 &name,
    const std::array<unsigned int, 3> &cells,
    const std::function<Point<3>(unsigned int, unsigned int, unsigned int)>
                                                              &place,
    const std::array<unsigned int, 2 * static_cast<int>(dim)> &ids)
  {
    const std::array<unsigned int, 3> vertices = {
      {cells[0] + 1, cells[1] + 1, dim == 3 ? cells[2] + 1 : 1}};
    const auto number =
      [&](const unsigned int i, const unsigned int j, const unsigned int k) {
        return 1 + i + vertices[0] * (j + vertices[1] * k);
      };
    std::ofstream file(name);
    file.precision(17);
    file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n"
         << vertices[0] * vertices[1] * vertices[2] << '\n';
    for (unsigned int k = 0; k < vertices[2]; ++k)
      for (unsigned int j = 0; j < vertices[1]; ++j)
        for (unsigned int i = 0; i < vertices[0]; ++i)
          file << number(i, j, k) << ' ' << place(i, j, k) << '\n';

    std::ostringstream elements;
    unsigned int       n = 0;
    // A line, a face or a cell that goes from a vertex in some directions.
    const auto add = [&](const unsigned int                 type,
                         const unsigned int                 id,
                         const std::array<unsigned int, 3> &first,
                         const std::vector<unsigned int>   &directions) {
      elements << ++n << ' ' << type << " 2 " << id << " 1";
      constexpr unsigned int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      const unsigned int     n_layers     = directions.size() == 3 ? 2 : 1,
                         n_around         = directions.size() == 1 ? 2 : 4;
      for (unsigned int layer = 0; layer < n_layers; ++layer)
        for (unsigned int v = 0; v < n_around; ++v)
          {
            std::array<unsigned int, 3> at = first;
            at[directions[0]] += around[v][0];
            if (directions.size() > 1)
              at[directions[1]] += around[v][1];
            if (directions.size() > 2)
              at[directions[2]] += layer;
            elements << ' ' << number(at[0], at[1], at[2]);
          }
      elements << '\n';
    };
    const unsigned int layers = dim == 3 ? cells[2] : 1;
    for (unsigned int k = 0; k < layers; ++k)
      for (unsigned int j = 0; j < cells[1]; ++j)
        for (unsigned int i = 0; i < cells[0]; ++i)
          {
            std::vector<unsigned int> all = {0, 1};
            if (dim == 3)
              all.push_back(2);
            const std::array<unsigned int, 3> cell = {{i, j, k}};
            add(dim == 3 ? 5 : 3, 100, cell, all);
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int side = 0; side < 2; ++side)
                if (cell[d] == side * (cells[d] - 1))
                  {
                    std::vector<unsigned int> along;
                    for (const unsigned int e : all)
                      if (e != d)
                        along.push_back(e);
                    std::array<unsigned int, 3> first = cell;
                    first[d] += side;
                    add(dim == 3 ? 3 : 1, ids[2 * d + side], first, along);
                  }
          }
    file << "$EndNodes\n$Elements\n"
         << n << '\n'
         << elements.str() << "$EndElements\n";
  }



  // A block with a lower corner above a slope of 15 degrees is pressed onto it
  // and dragged upwards. All of what touches slides, so that the force of the
  // slope is F down the slope for one across it, whatever its normal has to do
  // with those of the block.
  void
  on_a_slope()
  {
    std::cout << "A block that is dragged up a slope" << std::endl;
    const double alpha = 15 * numbers::PI / 180;
    const auto   nest  = solved<2>({"Scene/Definitions=alpha = 15*pi/180",
                                    "Obstacle/Kind=plane",
                                    "Obstacle/Point=1, -0.003",
                                    "Obstacle/Normal=sin(alpha), -cos(alpha)",
                                    "Boundary conditions/Displacement=3: 0.03, "
                                       "-0.02",
                                    "Contact/Boundary id=2",
                                    "Contact/Friction coefficient=0.3",
                                    "Refinement/Strategy=adaptive",
                                    "Refinement/Initial refinements=3",
                                    "Refinement/Levels=3"});
    check(nest->state().n_contact() > 2 && nest->state().n_sticking() == 0,
          "all that touches slides");
    const Tensor<1, 2> F = force(*nest, "contact").total;
    const double across  = -std::sin(alpha) * F[0] + std::cos(alpha) * F[1];
    const double upwards = std::cos(alpha) * F[0] + std::sin(alpha) * F[1];
    check_below(std::abs(upwards / across + .3), 1e-7, "Coulomb's ratio");
  }



  // Half a ring is pressed onto a disc of the same radius. The force that there
  // is has Hertz's pressure and half-width, since the ring is thick where it
  // touches; the largest pressure is in the middle, and everything symmetric.
  // Nodes lie on the arc, and so close to each other where it touches that it
  // does not matter that a body from a mesh file is a polygon.
  void
  ring_on_disc()
  {
    std::cout << "A ring on a disc" << std::endl;
    const unsigned int n = 64, m = 14;
    const double       thickness = .5;
    write_mesh<2>(
      "own-models.msh",
      {{n, m, 0}},
      [&](const unsigned int i, const unsigned int j, const unsigned int) {
        // Finer and finer towards the lowest point.
        const double s = 2. * i / n - 1.;
        const double angle =
          .5 * numbers::PI * std::sinh(4.5 * s) / std::sinh(4.5);
        const double t = 1. * j / m;
        const double radius =
          1. - thickness * std::expm1(3.5 * t) / std::expm1(3.5);
        return Point<3>(radius * std::sin(angle), -radius * std::cos(angle), 0);
      },
      {{2, 2, 1, 3}});
    const auto   nest = solved<2>({"Scene/Geometry=mesh file",
                                   "Scene/Mesh file=own-models.msh",
                                   "Obstacle/Kind=rods",
                                   "Obstacle/Centers=0, -2",
                                   "Obstacle/Radius=1",
                                   "Boundary conditions/Displacement=2: 0, -0.02",
                                   "Contact/Boundary id=1",
                                   "Contact/Friction law=none",
                                   "Refinement/Levels=0"});
    const double R = .5, P = force(*nest, "contact").total[1];
    const double p = std::sqrt(P * plane_strain_modulus / (numbers::PI * R));
    const double a = 2 * R * p / plane_strain_modulus;
    double       width = 0, spacing = 0, lopsided = 0;
    const auto  &contact = nest->discretization().contact();
    for (unsigned int i = 0; i < contact.size(); ++i)
      {
        if (nest->state().in_contact(i))
          {
            width += contact[i].measure;
            spacing = std::max(spacing, contact[i].measure);
          }
        for (const ContactNode<2> &other : contact)
          if (std::abs(other.point[0] + contact[i].point[0]) < 1e-10)
            lopsided = std::max(
              lopsided,
              std::abs(pressure(*nest, other) - pressure(*nest, contact[i])));
      }
    check_below(std::abs(largest_pressure(*nest) / p - 1),
                .03,
                "the largest pressure is Hertz's");
    check_below(
      std::abs(width / 2 - a), spacing, "the half-width is Hertz's, to a node");
    check_below(lopsided / p, 1e-6, "left and right are the same");
    check_below(std::abs(force(*nest, "contact").total[0]) / P,
                1e-6,
                "nothing pushes sideways");
  }



  // A quarter of a block from a mesh file, with two planes of symmetry, is
  // pressed onto a ball by a given force.
  void
  pressed_onto_a_ball()
  {
    std::cout << "A block from a mesh file that a force presses onto a ball"
              << std::endl;
    const unsigned int n    = 8;
    const auto         grid = [&](const unsigned int i) {
      return .7 * std::expm1(3.2 * i / n) / std::expm1(3.2);
    };
    write_mesh<3>(
      "own-models.msh",
      {{n, n, n}},
      [&](const unsigned int i, const unsigned int j, const unsigned int k) {
        return Point<3>(grid(i), grid(j), grid(k));
      },
      {{1, 4, 2, 4, 3, 5}});
    const auto nest =
      solved<3>({"Scene/Geometry=mesh file",
                 "Scene/Mesh file=own-models.msh",
                 "Obstacle/Kind=balls",
                 "Obstacle/Centers=0, 0, -1",
                 "Obstacle/Radius=1",
                 "Boundary conditions/Displacement=1: 0, free, "
                 "free; 2: free, 0, free; 5: free, free, -0.005",
                 "Boundary conditions/Force=5: free, free, "
                 "-0.0003663",
                 "Contact/Boundary id=3",
                 "Contact/Friction law=none",
                 "Refinement/Levels=0"});
    const double P    = 4 * .0003663;
    const double a    = std::cbrt(3 * P / (4 * plane_strain_modulus));
    const double p    = 1.5 * P / (numbers::PI * a * a);
    double       area = 0, spacing = 0;
    for (unsigned int i = 0; i < nest->state().size(); ++i)
      if (nest->state().in_contact(i))
        {
          const double measure = nest->discretization().contact()[i].measure;
          area += 4 * measure;
          spacing = std::max(spacing, std::sqrt(measure));
        }
    check_below(std::abs(4 * force(*nest, "contact").total[2] / P - 1),
                1e-5,
                "the ball bears the force");
    check_below(std::abs(largest_pressure(*nest) / p - 1),
                .03,
                "the largest pressure is Hertz's");
    check_below(std::abs(std::sqrt(area / numbers::PI) - a),
                spacing,
                "the radius of contact is Hertz's, to a node");
  }



  // A block between planes of symmetry, which waves of the ground touch
  // everywhere: D cos(pi x) cos(pi y). What flattens a wave of a half space is
  // a constant pressure and E* k D/2 times that wave, k^2 = 2 pi^2
  // (Westergaard; K. L. Johnson). A block that is one half of a wave long, wide
  // and high is a half space but for a hundredth.
  void
  on_waves()
  {
    std::cout << "A block on a rough ground" << std::endl;
    const auto   nest = solved<3>({"Scene/Size=1, 1, 1",
                                   "Scene/Constants=D = 0.002",
                                   "Obstacle/Kind=surface",
                                   "Obstacle/Function=z - D*(cos(pi*x)*cos(pi*y) "
                                     "- 1)",
                                   "Boundary conditions/Displacement=0: 0, free, "
                                     "free; 1: 0, free, free; 2: free, 0, free; 3: "
                                     "free, 0, free; 5: 0, 0, -0.01",
                                   "Contact/Boundary id=4",
                                   "Contact/Friction law=none",
                                   "Refinement/Strategy=uniform",
                                   "Refinement/Initial refinements=2",
                                   "Refinement/Levels=1"});
    const double k    = std::sqrt(2.) * numbers::PI;
    const double wave = plane_strain_modulus * k * .002 / 2;
    double       mean = 0, deviation = 0, area = 0, amplitude = 0, norm = 0;
    const auto  &contact = nest->discretization().contact();
    const auto   shape   = [](const Point<3> &x) {
      return std::cos(numbers::PI * x[0]) * std::cos(numbers::PI * x[1]);
    };
    for (const ContactNode<3> &node : contact)
      {
        area += node.measure;
        mean += pressure(*nest, node) * node.measure;
        amplitude += pressure(*nest, node) * node.measure * shape(node.point);
        norm += node.measure * shape(node.point) * shape(node.point);
      }
    mean /= area;
    amplitude /= norm;
    for (const ContactNode<3> &node : contact)
      deviation = std::max(
        deviation,
        std::abs(pressure(*nest, node) - mean - amplitude * shape(node.point)));
    check(nest->state().n_contact() == contact.size() && mean > 1.5 * wave,
          "all touches");
    check_below(std::abs(amplitude / wave - 1), .03, "Westergaard's pressure");
    check_below(deviation / wave, .02, "which is a wave");
  }
} // namespace test_own_models

TEST(own_models)
{
  on_a_slope();
  ring_on_disc();
  pressed_onto_a_ball();
  on_waves();
}

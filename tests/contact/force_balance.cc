// The forces on a body. In patch tests all of them are known in closed form:
// what the obstacle does, what holds the body, the loads. On meshes with
// hanging nodes, with displacements prescribed in whole boundaries, in single
// components and in single points, at nodes of the contact boundary, too, they
// balance to the accuracy of the solver, and known ones are what they should
// be.

#include <common/algorithms/nested_iteration.h>
#include <common/contact/force_balance.h>
#include <common/contact/solution_check.h>
#include <common/parameters/parameters.h>

#include <tests/support/check.h>
#include <tests/support/test.h>

#include <deal.II/base/mpi.h>

#include <fstream>
#include <iostream>
#include <string>
#include <vector>

using namespace dealii;
using namespace Friction;
using Tests::check_everywhere;

namespace test_force_balance
{
  constexpr double rounding = 1e-8;



  template <int dim>
  std::unique_ptr<NestedIteration<dim>>
  solved(const std::string &scene, const std::vector<std::string> &overrides)
  {
    const std::string folder =
      std::string(dim == 2 ? SCENES_DIR : SCENES_3D_DIR) + "/";
    auto nest = std::make_unique<NestedIteration<dim>>(
      read_parameters(folder + scene + ".prm", overrides));
    nest->begin();
    do
      nest->solve();
    while (nest->advance());
    return nest;
  }



  template <int dim>
  ForceOnBody<dim>
  find(const ForceBalance<dim> &balance, const std::string &name)
  {
    for (const ForceOnBody<dim> &force : balance.forces)
      if (force.name == name)
        return force;
    AssertThrow(false, ExcMessage("There is no force " + name));
    return balance.forces[0];
  }



  // All names, which files have.
  template <int dim>
  std::string
  names(const ForceBalance<dim> &balance)
  {
    std::string text;
    for (const ForceOnBody<dim> &force : balance.forces)
      text += ' ' + force.name;
    return text;
  }



  template <int dim>
  void
  check_force(const ForceBalance<dim> &balance,
              const std::string       &name,
              const Tensor<1, dim>    &wanted)
  {
    const Tensor<1, dim> &force = find(balance, name).total;
    std::ostringstream    is;
    if (!((force - wanted).norm() <= rounding * wanted.norm()))
      is << " is (" << force << ") and not (" << wanted << ")";
    check_everywhere(is.str().empty(), name + is.str());
  }



  // Under 'stick-slip' there is a state of constant stress on any mesh.
  void
  patch_test()
  {
    const auto nest = solved<2>("stick-slip", {"Refinement/Levels=1"});
    const ForceBalance<2> balance =
      force_balance(nest->discretization(), nest->report().residual);
    const Parameters &p = nest->parameters();
    const Material   &m = p.material;
    const double      F = p.contact.friction_coefficient;
    const double      L = p.scene.size[0], H = p.scene.size[1];
    const auto        constants = p.expressions.constants();
    const double      U = constants.at("U"), d = constants.at("d");
    const double      pressure = (m.lambda() + 2 * m.mu()) * d / H;
    const double      q        = std::min(m.mu() * U / H, F * pressure);
    check_everywhere(balance.imbalance() < rounding,
                     "patch test:" + names(balance));
    check_force<2>(balance, "contact", Tensor<1, 2>({-q * L, pressure * L}));
    check_force<2>(balance, "held_3", Tensor<1, 2>({q * L, -pressure * L}));
    const ForceOnBody<2> &contact = find(balance, "contact");
    check_everywhere(
      std::abs(contact.normal - pressure * L) < rounding * pressure * L &&
        std::abs(contact.tangential[0] + q * L) < rounding * q * L,
      "its normal and tangential parts");
  }



  // A block under its own weight and a load on top, which nothing but the
  // ground and a pin carries: the forces follow from the loads, whatever the
  // mesh.
  template <int dim>
  void
  weight()
  {
    const std::string top =
      dim == 2 ? "3: 0.001*x, -0.01 - 0.02*x" : "5: 0, 0.001*x, -0.01 - 0.02*x";
    const std::string force = dim == 2 ? "0, -0.03*(1+y)" : "0, 0, -0.03*(1+z)";
    const std::string held  = dim == 2 ? "0: 0, free" : "0: 0, free, free";
    std::vector<std::string> overrides = {
      "Boundary conditions/Displacement=" + held,
      "Boundary conditions/Traction=" + top,
      "Boundary conditions/Body force=" + force,
      "Refinement/Strategy=adaptive",
      "Refinement/Levels=2",
      "Refinement/Initial refinements=2",
      "Contact/Friction coefficient=0.3"};
    if (dim == 3)
      overrides.push_back(
        "Boundary conditions/Pinned points=(1, 1, 0): free, 0, free");
    const auto nest = solved<dim>("block", overrides);

    const ForceBalance<dim> balance =
      force_balance(nest->discretization(), nest->report().residual);
    check_everywhere(balance.imbalance() < rounding,
                     std::to_string(dim) + "D, balance:" + names(balance));
    const unsigned int n_hanging =
      nest->discretization().hanging_nodes().n_constraints();
    check_everywhere(Utilities::MPI::sum(n_hanging, MPI_COMM_WORLD) > 0,
                     "there are hanging nodes");

    // By hand: the mean of x and y over the unit square is 1/2.
    Tensor<1, dim> traction, body_force;
    traction[dim - 2] += .0005;
    traction[dim - 1]   = -.02;
    body_force[dim - 1] = -.045;
    check_force<dim>(balance, dim == 2 ? "traction_3" : "traction_5", traction);
    check_force<dim>(balance, "body_force", body_force);
    const ForceOnBody<dim> &contact = find(balance, "contact");
    check_everywhere(std::abs(contact.normal - .065) < rounding &&
                       std::abs(contact.total[dim - 1] - .065) < rounding,
                     "the ground bears the weight");
    const ForceOnBody<dim> &wall   = find(balance, "held_0");
    double                  across = 0;
    for (unsigned int d = 1; d < dim; ++d)
      across += std::abs(wall.total[d]);
    check_everywhere(across == 0 && std::abs(wall.total[0]) > 1e-5,
                     "what is free along a boundary has no reaction there");
    if (dim == 3)
      {
        const Tensor<1, dim> &pin = find(balance, "pinned").total;
        check_everywhere(pin[0] == 0 && pin[2] == 0 && std::abs(pin[1]) > 1e-6,
                         "the pin bears what is pinned");
      }

    // What a run is told of it; and of multiples of the displacement, whose
    // forces are not those of the loads.
    const auto check_multiple = [&](const double factor) {
      VectorType u = nest->displacement();
      u *= factor;
      return check_solution(nest->discretization(), u, nest->state(), 1e-6);
    };
    const SolutionCheck good = check_multiple(1.), near = check_multiple(1.001),
                        far = check_multiple(1e6);
    check_everywhere(good.is_solution && good.sentence.empty(),
                     "it is a solution");
    check_everywhere(near.is_solution &&
                       near.sentence.find("more exact") != std::string::npos,
                     "a thousandth too much is warned of");
    check_everywhere(!far.is_solution &&
                       far.sentence.find("its size") != std::string::npos,
                     "a million times as much is none");
  }



  // Round bodies: hanging nodes on the contact boundary, normals in all
  // directions, and no load but what holds the body.
  template <int dim>
  void
  pressed(const std::string &scene)
  {
    const auto              nest = solved<dim>(scene,
                                  {"Refinement/Levels=2",
                                                "Refinement/Strategy=adaptive",
                                                "Solver/Inner tolerance=1e-9"});
    const ForceBalance<dim> balance =
      force_balance(nest->discretization(), nest->report().residual);
    check_everywhere(balance.imbalance() < rounding &&
                       balance.forces.size() == 2,
                     scene + ":" + names(balance));

    // Where the obstacle is flat and normals are its own, the normal force is a
    // component of the total one.
    const ForceOnBody<dim> &contact = find(balance, "contact");
    check_everywhere(contact.normal > 0 && contact.total[dim - 1] > 0,
                     "the obstacle pushes");
  }
} // namespace test_force_balance

TEST(force_balance)
{
  patch_test();
  weight<2>();
  weight<3>();
  pressed<2>("hertz");
  pressed<3>("half-ball");
}

// Several contact boundaries, each with its own obstacle, law and coefficient.
// A block is clamped between a floor and a ceiling, and pushed along both: at
// each node friction is that of its boundary, the two normal forces are the
// same, and what pushes is the sum of both frictions. Upside down it is the
// same block. Where the section 'Contact' says nothing and 'Contact 2' all, the
// solution is that of a single boundary. A node on two contact boundaries is
// refused.

#include <common/algorithms/nested_iteration.h>
#include <common/contact/contact_forces.h>
#include <common/contact/force_balance.h>
#include <common/input_error.h>

#include <tests/support/check.h>
#include <tests/support/test.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

using namespace dealii;
using namespace Friction;
using Tests::check_everywhere;

namespace test_several_contacts
{
  using Entries = std::vector<std::string>;

  Entries
  operator+(Entries a, const Entries &b)
  {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }



  template <int dim>
  std::unique_ptr<NestedIteration<dim>>
  solved(const Entries &entries)
  {
    const std::string folder = dim == 2 ? SCENES_DIR : SCENES_3D_DIR;
    auto              nest   = std::make_unique<NestedIteration<dim>>(
      read_parameters(folder + "/block.prm", entries));
    nest->begin();
    do
      nest->solve();
    while (nest->advance());
    return nest;
  }



  // The floor is the bottom of the block, the ceiling comes down by a fiftieth
  // of its height. What is pushed by a fiftieth, too, slides everywhere.
  template <int dim>
  Entries
  clamped()
  {
    const bool plane = dim == 2;
    return {"Refinement/Strategy=adaptive",
            "Refinement/Initial refinements=2",
            plane ? "Refinement/Levels=3" : "Refinement/Levels=1",
            plane ? "Boundary conditions/Displacement=0: 0.02, free"
                  : "Boundary conditions/Displacement=0: 0.02, free, free; 2: "
                    "free, 0, free",
            "Obstacle 2/Kind=plane",
            plane ? "Obstacle 2/Point=0, 0.98" : "Obstacle 2/Point=0, 0, 0.98",
            plane ? "Obstacle 2/Normal=0, 1" : "Obstacle 2/Normal=0, 0, 1",
            plane ? "Contact 2/Boundary id=3" : "Contact 2/Boundary id=5"};
  }



  // At nodes that are free to slide in all directions: by how much friction is
  // not what it should be, relative to the largest. Nothing sticks.
  template <int dim, typename Bound>
  double
  deviation(const NestedIteration<dim> &nest, const Bound &bound)
  {
    const ContactBoundary<dim> &contact    = nest.discretization().contact();
    double                      difference = 0, largest = 0;
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const Tensor<1, dim> R =
          contact_force(contact[p], nest.report().residual);
        const double pressing = -(R * contact[p].normal());
        const double friction = (R + pressing * contact[p].normal()).norm();
        largest               = std::max(largest, friction);
        if (nest.state().sticks(p))
          difference = 1e30;
        else if (contact[p].n_free_tangents == dim - 1)
          difference = std::max(
            difference, std::abs(friction - bound(contact[p], pressing)));
      }
    return Utilities::MPI::max(difference, MPI_COMM_WORLD) /
      Utilities::MPI::max(largest, MPI_COMM_WORLD);
  }



  template <int dim>
  ForceOnBody<dim>
  named(const ForceBalance<dim> &balance, const std::string &name)
  {
    return *std::find_if(balance.forces.begin(),
                         balance.forces.end(),
                         [&](const auto &force) { return force.name == name; });
  }



  bool
  same(const double a, const double b)
  {
    return std::abs(a - b) < 1e-7 * std::max(std::abs(a), std::abs(b));
  }



  template <int dim>
  void
  test_clamped()
  {
    const std::string where = std::to_string(dim) + "D: ";
    const double      floor = .05, ceiling = .2;
    const auto        nest =
      solved<dim>(clamped<dim>() +
                  Entries{"Contact/Friction coefficient=0.05",
                          "Contact 2/Friction coefficient=0.2"});
    check_everywhere(
      deviation(*nest,
                [&](const ContactNode<dim> &p, const double tau) {
                  return (p.point[dim - 1] < .5 ? floor : ceiling) * tau;
                }) < 1e-7,
      where + "friction is that of floor and ceiling");

    const ForceBalance<dim> balance =
      force_balance(nest->discretization(), nest->report().residual);
    const auto &below = named(balance, "contact"),
               &above = named(balance, "contact_2"),
               &push  = named(balance, "held_0");
    check_everywhere(balance.imbalance() < 1e-8, where + "forces balance");
    check_everywhere(same(below.normal, above.normal) &&
                       same(below.total[dim - 1], below.normal) &&
                       same(above.total[dim - 1], -above.normal),
                     where + "the ceiling presses as hard as the floor");
    check_everywhere(
      same(push.total[0], -below.tangential[0] - above.tangential[0]) &&
        push.total[0] > 0,
      where + "what pushes has to overcome both");

    const auto turned =
      solved<dim>(clamped<dim>() +
                  Entries{"Contact/Friction coefficient=0.2",
                          "Contact 2/Friction coefficient=0.05"});
    const ForceBalance<dim> other =
      force_balance(turned->discretization(), turned->report().residual);
    check_everywhere(
      same(turned->report().energy, nest->report().energy) &&
        same(named(other, "contact").normal, above.normal) &&
        same(named(other, "contact").tangential[0], above.tangential[0]),
      where + "upside down it is the same");

    const auto varying =
      solved<dim>(clamped<dim>() +
                  Entries{"Contact/Friction coefficient=0.05",
                          "Contact 2/Friction coefficient=2*F + 0.1*x"});
    check_everywhere(
      deviation(*varying,
                [&](const ContactNode<dim> &p, const double tau) {
                  return (p.point[dim - 1] < .5 ? floor
                                                : 2 * floor + .1 * p.point[0]) *
                    tau;
                }) < 1e-7,
      where + "a coefficient that varies on one of them");

    const auto mixed =
      solved<dim>(clamped<dim>() +
                  Entries{"Contact/Friction coefficient=0.05",
                          "Contact 2/Friction law=Tresca",
                          "Contact 2/Friction bound=0.001 + 0.002*x"});
    check_everywhere(
      deviation(*mixed,
                [&](const ContactNode<dim> &p, const double tau) {
                  return p.point[dim - 1] < .5
                    ? floor * tau
                    : (.001 + .002 * p.point[0]) * p.measure;
                }) < 1e-7,
      where + "Coulomb's law below, Tresca's above");

    const auto smooth =
      solved<dim>(clamped<dim>() +
                  Entries{"Contact/Friction law=none",
                          "Contact 2/Friction coefficient=0.2"});
    check_everywhere(
      deviation(*smooth,
                [&](const ContactNode<dim> &p, const double tau) {
                  return p.point[dim - 1] < .5 ? 0. : ceiling * tau;
                }) < 1e-7,
      where + "friction on one of them only");
  }



  // The same block as ever, on the floor, if another section says so.
  void
  test_renamed()
  {
    const auto one = solved<2>({"Refinement/Levels=2"});
    const auto two = solved<2>({"Refinement/Levels=2",
                                "Contact/Boundary id=-1",
                                "Obstacle/Kind=none",
                                "Contact 2/Boundary id=2",
                                "Contact 2/Friction coefficient=0.4",
                                "Obstacle 2/Kind=plane"});
    VectorType difference(one->displacement());
    difference -= two->displacement();
    check_everywhere(difference.linfty_norm() == 0 &&
                       one->report().cycles.size() ==
                         two->report().cycles.size(),
                     "a second section can do what the first one does");
  }



  void
  test_refused(const std::string &what,
               const Entries     &entries,
               const std::string &words)
  {
    std::string message = "no error";
    try
      {
        solved<2>(Entries{"Refinement/Levels=0"} + entries);
      }
    catch (const InputError &error)
      {
        message = error.what();
      }
    const bool good = message.find(words) != message.npos;
    check_everywhere(good, what + (good ? "" : ": " + message));
  }
} // namespace test_several_contacts

TEST(several_contacts)
{
  test_clamped<2>();
  test_clamped<3>();
  test_renamed();

  const Entries wall = {"Obstacle 2/Kind=plane",
                        "Obstacle 2/Point=1, 0",
                        "Obstacle 2/Normal=1, 0",
                        "Boundary conditions/Displacement=3: 0, -0.02"};
  test_refused("a corner is refused",
               wall + Entries{"Contact 2/Boundary id=1"},
               "the node at (1, 0) lies on two contact boundaries, those of "
               "'Contact' and 'Contact 2'");
  test_refused("a boundary that is given twice",
               wall + Entries{"Contact 2/Boundary id=2"},
               "'Contact 2/Boundary id' is 2, as is that of 'Contact'");
  test_refused("a boundary that is not there",
               wall + Entries{"Contact 2/Boundary id=7"},
               "'Contact 2/Boundary id' names boundary id 7");
}

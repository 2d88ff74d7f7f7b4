// The scene mindlin in three dimensions against Cattaneo and Mindlin: the
// radius c of the zone of stick, that of a disc of the same area. With
// a the radius of contact, it is
//   c = a (1 - Q/(F P))^(1/3)
// where the ball is dragged first, and
//   c = a (1 - |Q - Q_turn|/(2 F P))^(1/3)
// where the drag is taken back. Nodes stick or slide as a whole, so that a
// radius is not known better than to half their distance. The slip is along the
// drag, and the force across it is nothing by symmetry.

#include <common/algorithms/nested_iteration.h>
#include <common/contact/contact_forces.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_mindlin_3d
{
  struct Step
  {
    Tensor<1, 3> force; ///< of the plane on the ball
    double       a = 0, c = 0;
    double       spacing = 0; ///< the largest distance of nodes in contact
  };



  Step
  quantities(const NestedIteration<3> &nest)
  {
    Step        step;
    double      contact_area = 0, stick_area = 0;
    const auto &contact = nest.discretization().contact();
    for (unsigned int p = 0; p < contact.size(); ++p)
      if (nest.state().in_contact(p))
        {
          step.force += contact_force(contact[p], nest.report().residual);
          contact_area += contact[p].measure;
          step.spacing = std::max(step.spacing, std::sqrt(contact[p].measure));
          stick_area += nest.state().sticks(p) ? contact[p].measure : 0.;
        }
    step.a = std::sqrt(contact_area / numbers::PI);
    step.c = std::sqrt(stick_area / numbers::PI);
    return step;
  }
} // namespace test_mindlin_3d

TEST(mindlin_3d)
{
  // Another mesh than that of the test, for more digits.
  const bool        is_finer = !Tests::arguments().empty();
  const std::string size =
    is_finer ? Tests::arguments()[0] : "Refinement/Maximum dofs=5000";
  NestedIteration<3> nest(without_safeguards(read_parameters(
    SCENES_3D_DIR "/mindlin.prm", {size, "Solver/Inner tolerance=1e-9"})));
  nest.begin();
  do
    nest.solve();
  while (nest.advance());

  std::vector<Step> steps     = {quantities(nest)};
  bool              converged = nest.report().converged;
  while (nest.begin_next_load_step())
    {
      converged = nest.solve().converged && converged;
      steps.push_back(quantities(nest));
    }
  check(converged && steps.size() == 5, "five steps");

  const double F     = .3;
  double       error = 0, across = 0, smallest = 1;
  for (unsigned int i = 1; i < steps.size(); ++i)
    {
      const double P    = steps[i].force[2];
      const double from = i <= 2 ? 0. : steps[2].force[0];
      const double c    = std::cbrt(
        1 - std::abs(steps[i].force[0] - from) / ((i <= 2 ? 1 : 2) * F * P));
      if (is_finer)
        std::cout << "t = " << i << ": c/a " << steps[i].c / steps[i].a
                  << ", closed form " << c << std::endl;
      error = std::max(
        error, std::abs(steps[i].c - c * steps[i].a) / steps[i].spacing);
      across   = std::max(across, std::abs(steps[i].force[1]) / (F * P));
      smallest = std::min(smallest, c);
    }
  check(smallest < .75,
        "the zone of stick shrinks to less than three quarters");
  check_below(
    error,
    .5,
    "the zone of stick is that of Cattaneo and Mindlin, to half a node");
  check_below(across, 1e-6, "no force across the drag");
}

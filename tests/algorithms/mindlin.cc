// The scene mindlin against what is known of it: the half-width of the zone of
// stick of Cattaneo and Mindlin, where the disc is dragged first and after each
// turn, and Masing's rule, by which all later branches of the force over the
// displacement are the first one, twice as large. The latter compares forces
// with each other, but not with those of a formula.
//
// And each step takes fewer cycles than it would from nothing, on the same
// mesh.

#include <common/algorithms/nested_iteration.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_mindlin
{
  struct Step
  {
    double time, Q, P, a, c;
  };



  Step
  quantities(const NestedIteration<2> &nest)
  {
    Step step{nest.scene().time(), 0, 0, 0, 0};
    for (unsigned int p = 0; p < nest.discretization().contact().size(); ++p)
      {
        const ContactNode<2> &node = nest.discretization().contact()[p];
        if (!nest.state().in_contact(p))
          continue;
        step.Q += nest.report().residual.local_element(2 * node.node);
        step.P += normal_component(node, nest.report().residual);
        step.a += .5 * node.measure;
        step.c += nest.state().sticks(p) ? .5 * node.measure : 0.;
      }
    return step;
  }



  // From zero, with everything else as it is.
  unsigned int
  cycles_from_nothing(NestedIteration<2> &nest)
  {
    std::vector<VectorType> kept;
    for (VectorType *guess : nest.guess())
      {
        kept.push_back(*guess);
        *guess = 0.;
      }
    VectorType         u;
    ContactState       state(0, false);
    const SolverReport report =
      nest.solve_with(nest.parameters().solver, u, state);
    if (!report.converged)
      check(false, "from nothing converges");
    for (unsigned int i = 0; i < kept.size(); ++i)
      *nest.guess()[i] = kept[i];
    return report.cycles.size();
  }
} // namespace test_mindlin

TEST(mindlin)
{
  // Another mesh than that of the test, for more digits.
  const bool        is_finer = !Tests::arguments().empty();
  const std::string size =
    is_finer ? Tests::arguments()[0] : "Refinement/Maximum dofs=5000";
  NestedIteration<2> nest(without_safeguards(read_parameters(
    SCENES_DIR "/mindlin.prm", {size, "Solver/Inner tolerance=1e-9"})));
  nest.begin();
  do
    nest.solve();
  while (nest.advance());

  std::vector<Step> steps  = {quantities(nest)};
  unsigned int      n_warm = 0, n_cold = 0, worse = 0, n_converged = 0;
  double            certificate = 0;
  while (nest.begin_next_load_step())
    {
      const unsigned int cold = cycles_from_nothing(nest);
      n_converged += nest.solve().converged;
      const unsigned int warm = nest.report().cycles.size();
      if (is_finer)
        std::cout << "t = " << nest.scene().time() << ": " << warm
                  << " cycles, from nothing " << cold << std::endl;
      n_warm += warm;
      n_cold += cold;
      worse += warm > cold;
      certificate = std::max(certificate, nest.report().certificate.largest());
      steps.push_back(quantities(nest));
    }
  check(steps.size() == 13 && n_converged == 12 && certificate < 1e-8,
        "thirteen steps, certified to 1e-8");

  const double F     = .3;
  double       error = 0, masing = 0, smallest = 1;
  for (unsigned int i = 1; i < steps.size(); ++i)
    {
      const Step  &s    = steps[i];
      const double from = i <= 4 ? 0 : i <= 8 ? steps[4].Q : steps[8].Q;
      const double c =
        std::sqrt(1 - std::abs(s.Q - from) / ((i <= 4 ? 1 : 2) * F * s.P));
      error    = std::max(error, std::abs(s.c / s.a - c));
      smallest = std::min(smallest, c);
      // The steps after a turn are twice as long as those before.
      if (i > 4)
        {
          const unsigned int turn = i <= 8 ? 4 : 8;
          const double       half = .5 * std::abs(s.Q - steps[turn].Q);
          masing                  = std::max(
            masing,
            std::abs(half / std::abs(steps[i - turn].Q - steps[0].Q) - 1));
        }
    }
  check(smallest < .5, "the zone of stick shrinks to less than a half");
  check_below(error,
              is_finer ? .008 : .03,
              "c/a is that of Cattaneo and Mindlin, to a node");
  check_below(masing, 1e-3, "Masing's rule holds to a thousandth");
  check_below(std::abs(steps[12].Q / steps[4].Q - 1),
              1e-4,
              "the loop is closed to a ten-thousandth");
  check(worse == 0 && n_warm < .8 * n_cold,
        "all steps take fewer cycles than from nothing");
  if (is_finer)
    std::cout << error << ' ' << masing << ' ' << n_warm << ' ' << n_cold
              << std::endl;
}

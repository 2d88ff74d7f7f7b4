// The half disc on a plane: the published numbers of nodes in contact and of
// sticking ones, cycles of nested iteration, and the static contact law.

#include <common/algorithms/nested_iteration.h>

#include <iomanip>
#include <iostream>

#include <tests/support/check.h>

#include <tests/reference/solutions/half_plane_contact.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_hertz
{
  struct Counts
  {
    unsigned int contact, sticking;
  };

  /** What is known at the end of a run. */
  struct Run
  {
    bool                converged = true;
    unsigned int        cycles    = 0; ///< most of all levels
    std::vector<Counts> counts;        ///< per level

    unsigned int n_contact = 0, n_sticking = 0; ///< on the last level
    double normal_force = 0, peak_pressure = 0, half_width = 0, stick_width = 0;

    /// Largest | |R_T| - F R_n | where it slides, over the largest R_n.
    double cone_deviation = 0;
  };



  Run
  run(const double F, const std::vector<std::string> &more = {})
  {
    std::ostringstream override;
    override << "Contact/Friction coefficient=" << F;
    std::vector<std::string> overrides = {
      override.str(), "Refinement/Marking=0.5", "Refinement/Maximum dofs=3000"};
    overrides.insert(overrides.end(), more.begin(), more.end());

    NestedIteration<2> iteration(
      without_safeguards(read_parameters(SCENES_DIR "/hertz.prm", overrides)));
    iteration.begin();
    Run result;
    do
      {
        iteration.solve();
        result.converged = result.converged && iteration.report().converged;
        result.cycles    = std::max<unsigned int>(
          result.cycles, iteration.report().cycles.size());
        result.counts.push_back(
          {iteration.state().n_contact(), iteration.state().n_sticking()});
    } while (iteration.advance());

    const ContactBoundary<2> &contact  = iteration.discretization().contact();
    const VectorType         &residual = iteration.report().residual;
    double                    largest  = 0;
    for (unsigned int p = 0; p < contact.size(); ++p)
      if (iteration.state().in_contact(p))
        {
          const double force   = normal_component(contact[p], residual);
          const double measure = contact[p].measure;
          largest              = std::max(largest, force);
          result.normal_force += force;
          result.half_width += measure / 2;
          result.peak_pressure =
            std::max(result.peak_pressure, force / measure);
          if (iteration.state().sticks(p))
            result.stick_width += measure / 2;
          else
            result.cone_deviation = std::max(
              result.cone_deviation,
              std::abs(
                std::abs(tangential_components<2>(contact[p], residual)[0]) -
                F * force));
        }
    result.cone_deviation /= largest;
    result.n_contact  = iteration.state().n_contact();
    result.n_sticking = iteration.state().n_sticking();
    return result;
  }



  // Both sides measured against Hertz's half-width and pressure for the normal
  // force that the computation has found.
  //
  // The theory is that of a half-plane. With a/R = 0.06 the disc deviates from
  // it by a small multiple of (a/R)^2 = 0.35 %: without friction, and with h/a
  // down to 0.001, the half-width comes out 1.0 % smaller and the peak 1.0 %
  // higher, opposite since the force ties their product. Friction adds less
  // than that. The mesh adds half a cell at each end of a zone, h/a = 1/57
  // here: 0.9 % of the half-width. The sum, 2 %, is the tolerance of half-width
  // and peak. In the ratio of two widths the effect of the finite disc cancels,
  // and what remains is (1+k) half cells, less than one.
  void
  compare_with_theory(const Run &run, const double F)
  {
    const Reference::HertzFactors theory = Reference::hertz_factors(0.325, F);

    const double half_width = run.half_width /
      Reference::HalfPlaneContact::hertz_width(run.normal_force, 1., 1., 0.325);
    const double peak = run.peak_pressure /
      Reference::HalfPlaneContact::hertz_pressure(
                          run.normal_force, 1., 1., 0.325);
    const double stick_ratio = run.stick_width / run.half_width;

    const bool width_ok = std::abs(half_width / theory.half_width - 1) < 0.02;
    const bool peak_ok  = std::abs(peak / theory.peak_pressure - 1) < 0.02;
    check(width_ok, "half-width to 2 %");
    check(peak_ok, "peak pressure to 2 %");
    const bool ratio_ok = std::abs(stick_ratio - theory.stick_ratio) < 0.0175;
    if (F > 0)
      check(ratio_ok, "stick ratio to one cell");
    if (!width_ok || !peak_ok || !ratio_ok)
      std::cout << "  half-width " << half_width << " instead of "
                << theory.half_width << ", peak " << peak << " instead of "
                << theory.peak_pressure << ", stick ratio " << stick_ratio
                << " instead of " << theory.stick_ratio << std::endl;
  }
} // namespace test_hertz

TEST(hertz)
{
  // The published sequence begins where the mesh resolves the contact zone;
  // from there on each level halves the size of the cells in it.
  const std::vector<Counts> published = {
    {7, 3}, {15, 7}, {29, 13}, {57, 27}, {113, 53}};

  std::cout << "F = 0.4" << std::endl;
  const Run  reference     = run(0.4);
  const auto follows_table = [&](const Run &run) {
    if (run.counts.size() < published.size())
      return false;
    const unsigned int first = run.counts.size() - published.size();
    for (unsigned int i = 0; i < published.size(); ++i)
      if (std::abs(int(run.counts[first + i].contact) -
                   int(published[i].contact)) > 2 ||
          std::abs(int(run.counts[first + i].sticking) -
                   int(published[i].sticking)) > 2)
        return false;
    return true;
  };
  check(reference.converged, "converged");
  check(follows_table(reference), "published node counts within two");
  if (!follows_table(reference))
    for (const Counts &counts : reference.counts)
      std::cout << "  " << counts.contact << '/' << counts.sticking
                << std::endl;
  check(reference.cycles <= 13, "at most 13 cycles per level");
  compare_with_theory(reference, 0.4);

  const Run w = run(0.4, {"Solver/Cycle=W", "Solver/Coarse smoothing steps=3"});
  check(w.converged && follows_table(w) && w.cycles <= 13,
        "W(3,3): the same counts, at most 13 cycles");
  const Run monotone = run(0.4, {"Solver/Coarse correction=monotone"});
  check(monotone.converged && follows_table(monotone) && monotone.cycles <= 20,
        "monotone: the same counts, at most 20 cycles");
  const Run plain = run(
    0.4,
    {"Solver/Coarse correction=monotone", "Solver/Coarse smoothing steps=3"});
  check(plain.converged && follows_table(plain) && plain.cycles <= 20,
        "plain V(3,3), monotone: the same counts, at most 20 cycles");

  std::cout << "F = 0" << std::endl;
  const Run frictionless = run(0.);
  check(frictionless.converged && frictionless.cycles <= 13,
        "converged, at most 13 cycles per level");
  compare_with_theory(frictionless, 0.);

  std::cout << "F = 0.05" << std::endl;
  const Run weak = run(0.05);
  check(weak.converged && weak.cycles <= 13,
        "converged, at most 13 cycles per level");
  check(weak.n_sticking == 1, "one node sticks");
  check(weak.cone_deviation < 1e-6, "full friction wherever it slides");

  std::cout << "F = 1" << std::endl;
  const Run strong = run(1.);
  check(strong.converged && strong.cycles <= 13,
        "converged, at most 13 cycles per level");
  check(strong.cone_deviation < 1e-6,
        "tangential and normal forces coincide where it slides");
  compare_with_theory(strong, 1.);
}

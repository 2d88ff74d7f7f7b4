// Remark 6.7: what truncation must leave to coarse functions in three
// dimensions, and what happens if it does not.
//
// Coulomb friction on a block whose bottom slides, on three meshes, by all
// kinds of truncation and both kinds of coarse correction, each from the
// initial guess that the default has found on the coarser mesh. Some variants
// fail. That is expected, and compared like everything else, so that a change
// is noticed.

#include <common/algorithms/nested_iteration.h>

#include <iostream>
#include <map>
#include <vector>

#include <tests/support/check.h>

#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

TEST(truncation_variants)
{
  const unsigned int limit = 100;
  NestedIteration<3> iteration(
    read_parameters(SCENES_3D_DIR "/block.prm",
                    {"Contact/Friction coefficient=0.2",
                     "Refinement/Initial refinements=1",
                     "Refinement/Levels=2",
                     "Solver/Maximum cycles=" + std::to_string(limit)}));
  iteration.begin();

  // Cycles per level; the limit if that was not enough.
  using Variant = std::pair<TruncationVariant, CoarseCorrection>;
  std::map<Variant, std::vector<unsigned int>> cycles;
  do
    {
      for (const TruncationVariant truncation :
           {TruncationVariant::phases,
            TruncationVariant::contact,
            TruncationVariant::phases_without_second_order})
        for (const CoarseCorrection correction :
             {CoarseCorrection::truncated, CoarseCorrection::monotone})
          {
            SolverSettings settings    = iteration.parameters().solver;
            settings.truncation        = truncation;
            settings.coarse_correction = correction;
            VectorType         u;
            ContactState       state(0, false);
            const SolverReport report =
              iteration.solve_with(without_safeguards(settings), u, state);
            cycles[{truncation, correction}].push_back(
              report.converged ? report.cycles.size() : limit);
          }
      iteration.solve();
  } while (iteration.advance());
  std::cout << iteration.discretization().dof_handler().n_dofs()
            << " degrees of freedom, " << iteration.state().n_contact()
            << " nodes in contact, " << iteration.state().n_sticking()
            << " stick" << std::endl;

  const auto at_most = [&](const Variant &variant, const unsigned int bound) {
    bool result = true;
    for (const unsigned int n : cycles[variant])
      result = result && n <= bound;
    return result;
  };
  const auto of = [&](const TruncationVariant truncation) {
    return std::pair<Variant, Variant>(
      {truncation, CoarseCorrection::truncated},
      {truncation, CoarseCorrection::monotone});
  };

  const auto phases = of(TruncationVariant::phases);
  check(at_most(phases.first, 12) && at_most(phases.second, 12),
        "phases: at most 12 cycles, by either correction");

  // The whole tangential displacement of the sliding nodes is left to the
  // relaxation, which is slower the finer the mesh.
  const auto contact = of(TruncationVariant::contact);
  for (const Variant &variant : {contact.first, contact.second})
    {
      const auto &n = cycles[variant];
      check(n[1] >= 1.5 * n[0] && n[2] >= 1.5 * n[1] && n[2] > 50,
            std::string("contact: the number of cycles grows like 1/h, ") +
              (variant == contact.first ? "truncated" : "monotone"));
    }

  // Without the second derivative a correction turns the direction of slip as
  // if that cost nothing. The line search makes the best of it.
  const auto without = of(TruncationVariant::phases_without_second_order);
  check(at_most(without.first, 20),
        "without second order, truncated: at most 20 cycles");
  check(cycles[without.second].back() == limit,
        "without second order, monotone: more than 100 cycles, as expected");
}

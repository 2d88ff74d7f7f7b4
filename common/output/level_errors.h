#ifndef friction_output_level_errors_h
#define friction_output_level_errors_h

#include <common/output/history.h>

#include <string>
#include <vector>

namespace Friction
{
  /**
   * Fills in the errors of the quantities of a level, from those of the levels
   * before, see error_bars.h. What the certificate says is added, as if all
   * nodes violated their laws by that much.
   *
   * The peak pressure depends on zones: if the contact zone has fewer than five
   * nodes, or if one or two nodes stick, its error is unknown.
   *
   * Later load steps have one mesh only, the last one of the first step, so
   * that their errors are carried over from there:
   * - a width is wrong by as many times its resolution as in the first step;
   * - the error of a force is that of an energy over a displacement.
   *   Relative to the force it changes like the square of the estimated error
   *   in the energy norm over the normal force, which does not depend on the
   *   size of the load; but it does not get smaller. Tangential forces may
   *   begin in a later step, and be taken back: their error is relative to the
   *   largest so far, with the larger relative error of both forces in the
   *   first step, that of a tangential force below a hundredth of the normal
   *   one being relative to this hundredth;
   * - the peak pressure, which is that of a single node, has none: where other
   *   nodes begin to slide, the first step says nothing of it.
   *
   * They are unknown if those of the first step are, and those of forces if
   * errors are not estimated.
   *
   * @param before  the levels before, in their order, with their errors. Those
   *                of other load steps do not count in the first one.
   */
  void set_errors(LevelRecord                    &record,
                  const std::vector<LevelRecord> &before,
                  const unsigned int              dim);

  /** The quantities with their errors, in one line. Those of friction only if
   * there is any. */
  std::string describe_quantities(const LevelRecord &record);
} // namespace Friction

#endif

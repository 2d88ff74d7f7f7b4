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
   * @param before  the levels before, in their order, of which those of other
   *                load steps do not count; their errors are not used.
   */
  void set_errors(LevelRecord                    &record,
                  const std::vector<LevelRecord> &before,
                  const unsigned int              dim);

  /** The quantities with their errors, in one line. Those of friction only if
   * there is any. */
  std::string describe_quantities(const LevelRecord &record);
} // namespace Friction

#endif

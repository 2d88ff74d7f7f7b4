#include <common/estimate/error_bars.h>
#include <common/output/level_errors.h>

namespace Friction
{
  namespace
  {
    using Member = double LevelRecord::*;

    std::vector<ValueOnMesh>
    values_of(const std::vector<LevelRecord> &before,
              const LevelRecord              &last,
              const Member                    value,
              const Member                    resolution)
    {
      std::vector<ValueOnMesh> values;
      const auto               add = [&](const LevelRecord &record) {
        values.push_back({double(record.dofs),
                          record.*value,
                          resolution != nullptr ? record.*resolution : 0.});
      };
      for (const LevelRecord &record : before)
        if (record.level < last.level && record.load_step == last.load_step)
          add(record);
      add(last);
      return values;
    }
  } // namespace



  void
  set_errors(LevelRecord                    &record,
             const std::vector<LevelRecord> &before,
             const unsigned int              dim)
  {
    const auto smooth =
      [&](const Member value, const Member resolution, const double scale) {
        const double error = error_of_smooth_value(
          values_of(before, record, value, resolution), dim);
        return error < 0 ? error : error + record.certificate * scale;
      };
    record.normal_force_error =
      smooth(&LevelRecord::normal_force, nullptr, record.normal_force);
    record.tangential_force_error =
      smooth(&LevelRecord::tangential_force, nullptr, record.normal_force);
    constexpr unsigned int fewest      = 5;
    const bool             is_resolved = record.contact_nodes >= fewest &&
      (record.sticky_nodes == 0 || record.sticky_nodes > 2);
    record.max_pressure_error = is_resolved
      ? smooth(&LevelRecord::max_pressure,
               &LevelRecord::pressure_resolution,
               record.max_pressure)
      : unknown_error;
    record.contact_half_width_error =
      error_of_width(values_of(before,
                               record,
                               &LevelRecord::contact_half_width,
                               &LevelRecord::contact_resolution));
    record.stick_half_width_error =
      error_of_width(values_of(before,
                               record,
                               &LevelRecord::stick_half_width,
                               &LevelRecord::stick_resolution));
  }



  std::string
  describe_quantities(const LevelRecord &record)
  {
    std::string text = "Peak pressure p = " +
      with_error(record.max_pressure, record.max_pressure_error) +
      ", half-width of contact a = " +
      with_error(record.contact_half_width, record.contact_half_width_error);
    if (record.sticky_nodes > 0)
      text += ", of stick c = " +
        with_error(record.stick_half_width, record.stick_half_width_error);
    text += ", normal force P = " +
      with_error(record.normal_force, record.normal_force_error);
    if (record.tangential_force > 1e-10 * record.normal_force)
      text += ", tangential Q = " +
        with_error(record.tangential_force, record.tangential_force_error);
    return text + ".";
  }
} // namespace Friction

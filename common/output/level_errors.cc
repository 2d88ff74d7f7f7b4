#include <common/estimate/error_bars.h>
#include <common/output/level_errors.h>

#include <algorithm>

namespace Friction
{
  namespace
  {
    using Member = double LevelRecord::*;

    std::vector<ValueOnMesh>
    values_of(const std::vector<LevelRecord> &levels,
              const Member                    value,
              const Member                    resolution)
    {
      std::vector<ValueOnMesh> values;
      for (const LevelRecord &record : levels)
        values.push_back({double(record.dofs),
                          record.*value,
                          resolution != nullptr ? record.*resolution : 0.});
      return values;
    }



    // From the levels of the first load step, of which this is the last one.
    void
    set_errors_of_first_step(LevelRecord                    &record,
                             const std::vector<LevelRecord> &levels,
                             const unsigned int              dim)
    {
      const auto smooth =
        [&](const Member value, const Member resolution, const double scale) {
          const double error =
            error_of_smooth_value(values_of(levels, value, resolution), dim);
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
    }



    // On the mesh of @p first, the last level of the first load step.
    // @param largest_tangential_force  of this step and those before.
    void
    set_errors_of_later_step(LevelRecord       &record,
                             const LevelRecord &first,
                             const double       largest_tangential_force)
    {
      record.normal_force_error     = unknown_error;
      record.tangential_force_error = unknown_error;
      record.max_pressure_error     = unknown_error;
      if (!(first.normal_force > 0 && record.normal_force > 0 &&
            first.estimated_error > 0 && record.estimated_error > 0 &&
            first.normal_force_error >= 0))
        return;

      // Of the energy norm of the error, in units that the load does not
      // change.
      const double growth =
        std::max(1.,
                 record.estimated_error / record.normal_force /
                   (first.estimated_error / first.normal_force));
      const double rounding = record.certificate * record.normal_force;

      // What the mesh is to blame for; what the iteration has left is that of
      // each step.
      const auto of_mesh = [&](const double error) {
        return std::max(0., error - first.certificate * first.normal_force);
      };
      const double normal =
        of_mesh(first.normal_force_error) / first.normal_force;
      record.normal_force_error =
        growth * growth * normal * record.normal_force + rounding;

      // A sum of tangential forces that is next to nothing is no scale.
      const double tangential = of_mesh(first.tangential_force_error) /
        std::max(first.tangential_force, .01 * first.normal_force);
      record.tangential_force_error = growth * growth *
          std::max(normal, tangential) * largest_tangential_force +
        rounding;
    }
  } // namespace



  void
  set_errors(LevelRecord                    &record,
             const std::vector<LevelRecord> &before,
             const unsigned int              dim)
  {
    // The meshes are those of the first step.
    std::vector<LevelRecord> meshes;
    double                   largest = record.tangential_force;
    for (const LevelRecord &level : before)
      if (level.level < record.level)
        {
          if (level.load_step == 1)
            meshes.push_back(level);
          else
            largest = std::max(largest, level.tangential_force);
        }
    if (record.load_step == 1)
      {
        meshes.push_back(record);
        set_errors_of_first_step(record, meshes, dim);
      }
    else if (!meshes.empty())
      set_errors_of_later_step(
        record,
        meshes.back(),
        std::max(largest, meshes.back().tangential_force));
    record.contact_half_width_error =
      error_of_width(values_of(meshes,
                               &LevelRecord::contact_half_width,
                               &LevelRecord::contact_resolution),
                     record.contact_resolution);
    record.stick_half_width_error = error_of_width(
      values_of(
        meshes, &LevelRecord::stick_half_width, &LevelRecord::stick_resolution),
      record.stick_resolution);
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

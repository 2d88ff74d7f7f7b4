// The errors of a level's quantities. On the meshes of the first load step they
// are those of error_bars.h. In later steps, on the last of these meshes, they
// - of forces are in proportion to the load if that is all that changes,
// - grow like the square of the estimated error of the step, and do not shrink
//   with it,
// - do not get small where a tangential force is taken back,
// - of widths follow the resolution of zones,
// - do not depend on what has happened in steps between, nor on what the
//   iteration has left in the first one,
// and are unknown where nothing says how large they are.

#include <common/estimate/error_bars.h>
#include <common/output/level_errors.h>

#include <cmath>
#include <iostream>

#include <tests/support/check.h>
#include <tests/support/test.h>

using namespace Friction;
using namespace Tests;

namespace test_level_errors
{
  bool
  equal(const double a, const double b)
  {
    return std::abs(a - b) <= 1e-12 * std::abs(b);
  }



  // A mesh of the first load step: values with an error of second order.
  LevelRecord
  mesh(const unsigned int level)
  {
    const double h2 = std::pow(.25, level);
    LevelRecord  record;
    record.level               = level;
    record.dofs                = 100u << (2 * level);
    record.contact_nodes       = 4u << level;
    record.sticky_nodes        = 3u << level;
    record.normal_force        = 2. + .1 * h2;
    record.tangential_force    = .5 + .1 * h2;
    record.max_pressure        = 3. - .2 * h2;
    record.pressure_resolution = .1 * h2;
    record.contact_resolution  = std::pow(.5, level);
    record.stick_resolution    = .5 * record.contact_resolution;
    record.contact_half_width  = 10. + record.contact_resolution;
    record.stick_half_width    = 6. + 3. * record.stick_resolution;
    record.estimated_error     = std::pow(.5, level);
    return record;
  }



  std::vector<LevelRecord>
  first_step(const unsigned int n_meshes, const bool has_friction = true)
  {
    std::vector<LevelRecord> levels;
    for (unsigned int k = 0; k < n_meshes; ++k)
      {
        levels.push_back(mesh(k));
        if (!has_friction)
          levels.back().tangential_force = 1e-18 * k;
        const std::vector<LevelRecord> before(levels.begin(), levels.end() - 1);
        set_errors(levels.back(), before, 2);
      }
    return levels;
  }



  // Another step, on the last mesh, where all loads are larger by a factor.
  LevelRecord
  later(const LevelRecord &last, const unsigned int step, const double factor)
  {
    LevelRecord record = last;
    record.level       = last.level + step - 1;
    record.load_step   = step;
    for (const auto member : {&LevelRecord::normal_force,
                              &LevelRecord::tangential_force,
                              &LevelRecord::max_pressure,
                              &LevelRecord::pressure_resolution,
                              &LevelRecord::estimated_error})
      record.*member *= factor;
    for (const auto member : {&LevelRecord::normal_force_error,
                              &LevelRecord::tangential_force_error,
                              &LevelRecord::max_pressure_error,
                              &LevelRecord::contact_half_width_error,
                              &LevelRecord::stick_half_width_error})
      record.*member = -7.;
    return record;
  }



  void
  test_meshes()
  {
    const LevelRecord last = first_step(4).back();
    const double      h2   = std::pow(.25, 3);
    check(equal(last.normal_force_error, 1.5 * .1 * h2) &&
            equal(last.tangential_force_error, 1.5 * .1 * h2) &&
            equal(last.max_pressure_error, 1.5 * .2 * h2 + .1 * h2),
          "forces and pressure of the first step");
    check(equal(last.contact_half_width_error, 1.5 * .125) &&
            equal(last.stick_half_width_error, 1.5 * 3. * .0625),
          "half-widths of the first step");
  }



  void
  test_loads()
  {
    const auto        levels = first_step(4);
    const LevelRecord last   = levels.back();
    LevelRecord       record = later(last, 2, 3.);
    set_errors(record, levels, 2);

    // The relative error of the tangential force is the larger one.
    check(
      equal(record.normal_force_error, 3. * last.normal_force_error) &&
        equal(record.tangential_force_error, 3. * last.tangential_force_error),
      "three times the load");
    check(
      equal(record.contact_half_width_error, last.contact_half_width_error) &&
        equal(record.stick_half_width_error, last.stick_half_width_error),
      "half-widths do not know the load");

    LevelRecord smooth = record;
    smooth.estimated_error /= 2.;
    set_errors(smooth, levels, 2);
    check(equal(smooth.normal_force_error, record.normal_force_error) &&
            equal(smooth.tangential_force_error, record.tangential_force_error),
          "half of the estimated error");

    record.estimated_error *= 2.;
    record.contact_resolution *= 5.;
    record.stick_resolution *= 7.;
    set_errors(record, levels, 2);
    check(
      equal(record.normal_force_error, 12. * last.normal_force_error) &&
        equal(record.tangential_force_error, 12. * last.tangential_force_error),
      "twice the estimated error: forces");
    check(record.max_pressure_error == unknown_error,
          "nothing is said of the peak pressure");
    check(
      equal(record.contact_half_width_error,
            5. * last.contact_half_width_error) &&
        equal(record.stick_half_width_error, 7. * last.stick_half_width_error),
      "coarser at the rims");

    LevelRecord rough = record;
    rough.certificate = 1e-3;
    set_errors(rough, levels, 2);
    check(equal(rough.normal_force_error,
                record.normal_force_error + 1e-3 * record.normal_force) &&
            equal(rough.tangential_force_error,
                  record.tangential_force_error + 1e-3 * record.normal_force),
          "what the certificate says");
  }



  void
  test_history()
  {
    auto              levels = first_step(4);
    const LevelRecord last   = levels.back();
    LevelRecord       record = later(last, 2, 1.);
    record.tangential_force *= 2.;
    set_errors(record, levels, 2);
    const double largest = record.tangential_force_error;
    check(equal(largest, 2. * last.tangential_force_error),
          "twice the tangential force");

    levels.push_back(record);
    LevelRecord back      = later(last, 3, 1.);
    back.tangential_force = 1e-3;
    set_errors(back, levels, 2);
    check(equal(back.tangential_force_error, largest) &&
            equal(back.normal_force_error, last.normal_force_error),
          "the tangential force is taken back");

    const auto  oiled     = first_step(4, false);
    LevelRecord drag      = later(oiled.back(), 2, 1.);
    drag.tangential_force = .2 * drag.normal_force;
    set_errors(drag, oiled, 2);
    check(oiled.back().normal_force_error > 0 &&
            equal(drag.tangential_force_error,
                  .2 * oiled.back().normal_force_error),
          "friction begins in a later step");

    // What is less than a hundredth of the normal force is no scale.
    auto faint = first_step(4);
    for (unsigned int k = 0; k < 4; ++k)
      {
        faint[k].normal_force     = 2.;
        faint[k].tangential_force = 1e-3 + 1e-4 * std::pow(.25, k);
        set_errors(faint[k], {faint.begin(), faint.begin() + k}, 2);
      }
    drag                  = later(faint.back(), 2, 1.);
    drag.tangential_force = .4;
    set_errors(drag, faint, 2);
    check(faint.back().tangential_force_error > 0 &&
            equal(drag.tangential_force_error,
                  .4 / .02 * faint.back().tangential_force_error),
          "hardly any friction in the first step");

    // What the iteration has left in the first step is not carried over.
    auto exact = first_step(4), rough = exact;
    for (unsigned int k = 0; k < 4; ++k)
      {
        rough[k].certificate = 1e-2;
        set_errors(rough[k], {rough.begin(), rough.begin() + k}, 2);
      }
    LevelRecord expected = later(exact.back(), 2, 2.),
                found    = later(rough.back(), 2, 2.);
    found.certificate    = 0.;
    set_errors(expected, exact, 2);
    set_errors(found, rough, 2);
    check(
      rough.back().normal_force_error > 2. * exact.back().normal_force_error &&
        equal(found.normal_force_error, expected.normal_force_error) &&
        equal(found.tangential_force_error, expected.tangential_force_error),
      "a first step that is not solved to the end");
  }



  void
  test_unknown()
  {
    const auto  levels  = first_step(4);
    LevelRecord record  = later(levels.back(), 2, 1.);
    const auto  unknown = [](const LevelRecord &r) {
      return r.normal_force_error == unknown_error &&
        r.tangential_force_error == unknown_error &&
        r.max_pressure_error == unknown_error;
    };
    record.estimated_error = 0.;
    set_errors(record, levels, 2);
    check(unknown(record) && record.contact_half_width_error > 0 &&
            record.stick_half_width_error > 0,
          "errors are not estimated");

    const auto  two   = first_step(2);
    LevelRecord third = later(two.back(), 2, 1.);
    set_errors(third, two, 2);
    check(unknown(third) && third.contact_half_width_error == unknown_error &&
            third.stick_half_width_error == unknown_error,
          "two meshes");

    LevelRecord open   = later(levels.back(), 2, 0.);
    open.contact_nodes = 0;
    set_errors(open, levels, 2);
    check(unknown(open), "nothing touches any more");
  }
} // namespace test_level_errors

TEST(level_errors)
{
  test_meshes();
  test_loads();
  test_history();
  test_unknown();
}

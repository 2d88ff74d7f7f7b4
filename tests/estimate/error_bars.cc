// Errors that are estimated from a sequence of meshes: where values converge as
// the estimate assumes, it is the error times the factor of safety, with any
// refinement and of any size; a difference that is small by chance does not
// make it small; and what is printed has the digits that the error leaves.

#include <common/estimate/error_bars.h>

#include <cmath>
#include <iostream>
#include <utility>

#include <tests/support/check.h>
#include <tests/support/test.h>

using namespace Friction;
using namespace Tests;

namespace test_error_bars
{
  constexpr double safety = 1.5;

  // The values 7 + C h^q, where the number of unknowns grows by these factors.
  void
  test_smooth(const unsigned int dim, const double order, const double C)
  {
    std::vector<ValueOnMesh> values;
    double                   dofs = 100;
    bool                     good = true;
    for (const double factor : {1., 4., 1.3, 2., 1.7, 8.})
      {
        dofs *= factor;
        const double error = C * std::pow(dofs, -order / dim);
        values.push_back({dofs, 7. + error, 0.});
        const double estimate = error_of_smooth_value(values, dim);
        good                  = good &&
          (values.size() < 3 ? estimate == unknown_error
                             : std::abs(estimate - safety * std::abs(error)) <
               1e-6 * std::abs(error));
      }
    check(good,
          "order " + std::to_string(int(order)) + " in " + std::to_string(dim) +
            "D");
  }



  // Widths of zones that are wrong by a multiple of their resolution.
  void
  test_width(const double multiple)
  {
    std::vector<ValueOnMesh> values;
    bool                     good = true;
    for (double resolution = .1; resolution > 1e-3; resolution /= 2)
      {
        const double error = multiple * resolution;
        values.push_back({1., 1. + error, resolution});
        const double estimate = error_of_width(values);
        good                  = good &&
          (values.size() < 3 ? estimate == unknown_error
                             : estimate > 1.49 * std::max(error, resolution) &&
               estimate < 1.51 * std::max(error, resolution));
      }
    check(good, "width");
  }
} // namespace test_error_bars

TEST(error_bars)
{
  for (const unsigned int dim : {2, 3})
    for (const double order : {1., 2.})
      for (const double C : {-1., .01})
        test_smooth(dim, order, C);
  for (const double multiple : {0., .5, 1., 3.})
    test_width(multiple);

  // The last two values are equal by chance.
  const std::vector<ValueOnMesh> chance = {
    {100, 1.2, 0}, {400, 1.1, 0}, {1600, 1.05, 0}, {6400, 1.05, 0}};
  check(error_of_smooth_value(chance, 2) > .01, "equal by chance");
  check(error_of_smooth_value({{100, 2, 0}, {400, 2, 0}, {1600, 2, .3}}, 2) ==
          .3,
        "nothing but the resolution");
  check(error_of_width({{1, 2, 0}, {1, 2, 0}, {1, 2, 0}}) == 0,
        "a zone without a rim");

  for (const auto &pair : {std::pair<double, double>(.059814, .00026),
                           {.4383, .96},
                           {12.3456, 2.},
                           {1.9951e6, 1234.},
                           {2.3731e-5, 4.2e-9},
                           {.5, 0.},
                           {.0123456, unknown_error},
                           {3.14159, .0999}})
    std::cout << with_error(pair.first, pair.second) << std::endl;
}

#include <common/estimate/error_bars.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace Friction
{
  namespace
  {
    constexpr double      safety        = 1.5;
    constexpr std::size_t n_differences = 3;

    // The last differences are those of values first-1 and first, and so on.
    std::size_t
    first_difference(const std::vector<ValueOnMesh> &values)
    {
      return values.size() > n_differences ? values.size() - n_differences : 1;
    }



    double
    difference(const std::vector<ValueOnMesh> &values, const std::size_t i)
    {
      return std::abs(values[i].value - values[i - 1].value);
    }
  } // namespace



  double
  error_of_smooth_value(const std::vector<ValueOnMesh> &values,
                        const unsigned int              dim)
  {
    if (values.size() < 3)
      return unknown_error;
    double smallest_spread = 0, error = 0;
    for (const double order : {1., 2.})
      {
        const auto size = [&](const std::size_t i) {
          return std::pow(values[i].dofs, -order / dim);
        };
        double smallest = -1, largest = 0;
        for (std::size_t i = first_difference(values); i < values.size(); ++i)
          {
            // A mesh that is hardly finer says nothing.
            if (!(size(i) < .99 * size(i - 1)))
              continue;
            const double constant =
              difference(values, i) / (size(i - 1) - size(i));
            largest  = std::max(largest, constant);
            smallest = smallest < 0 ? constant : std::min(smallest, constant);
          }
        if (smallest < 0)
          return unknown_error;
        const double spread =
          largest > 0 ? largest / std::max(smallest, 1e-3 * largest) : 1.;
        // With values that are hardly any, both orders have the largest spread,
        // up to rounding, which must not decide.
        if (order == 1 || spread < .999 * smallest_spread)
          {
            smallest_spread = spread;
            error           = largest * size(values.size() - 1);
          }
      }
    return safety * error + values.back().resolution;
  }



  double
  error_of_width(const std::vector<ValueOnMesh> &values)
  {
    return error_of_width(values,
                          values.empty() ? 0. : values.back().resolution);
  }



  double
  error_of_width(const std::vector<ValueOnMesh> &values,
                 const double                    resolution)
  {
    if (values.size() < 3)
      return unknown_error;
    double multiple = 1;
    for (std::size_t i = first_difference(values); i < values.size(); ++i)
      {
        // Where the rim has not been refined, half of it stands for what the
        // next refinement will change.
        const double now = values[i].resolution;
        const double step =
          std::max(std::abs(values[i - 1].resolution - now), .5 * now);
        if (step > 0)
          multiple = std::max(multiple, difference(values, i) / step);
      }
    return safety * multiple * resolution;
  }



  std::string
  with_error(const double value, const double error)
  {
    char text[100];
    if (error < 0)
      std::snprintf(text, sizeof(text), "%.3g ± ?", value);
    else if (error == 0)
      std::snprintf(text, sizeof(text), "%.6g", value);
    else
      {
        // The unit of the last digit, such that the error is 1 to 9 of them.
        int          exponent = std::floor(std::log10(error));
        const double digit    = error * std::pow(10., -exponent);
        double       rounded  = std::ceil(digit - 1e-9);
        if (rounded >= 10)
          {
            rounded = 1;
            ++exponent;
          }
        const double bar = rounded * std::pow(10., exponent);

        // The value keeps two digits, whatever the error.
        const int leading =
          value != 0 ? std::floor(std::log10(std::abs(value))) : exponent;
        const int last = std::min(exponent, leading - 1);
        if (last >= -8 && last <= 0 && leading < 6)
          std::snprintf(
            text, sizeof(text), "%.*f ± %.*f", -last, value, -last, bar);
        else
          std::snprintf(
            text, sizeof(text), "%.*e ± %.0e", leading - last, value, bar);
      }
    return text;
  }
} // namespace Friction

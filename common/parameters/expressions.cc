#include <common/parameters/expressions.h>
#include <common/parameters/parse_function.h>
#include <common/printable.h>

#include <cctype>
#include <cmath>

namespace Friction
{
  Expressions::Expressions(
    const std::map<std::string, double>                    &constants,
    const std::vector<std::pair<std::string, std::string>> &definitions,
    const std::string                                      &where,
    const bool                                              has_time)
    : time_is_known(has_time)
    , named_numbers(constants)
  {
    // In two dimensions there is no z, which is found out by those who use the
    // definition.
    for (const auto &[name, expression] : definitions)
      {
        parse_function<3>(
          {expression}, *this, where + " of '" + excerpt(name) + "'");
        expanded_definitions[name] = expand(expression);
      }
  }



  std::string
  Expressions::expand(const std::string &expression) const
  {
    std::string expanded;
    const auto  is_name = [](const unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '.';
    };
    for (std::size_t i = 0; i < expression.size();)
      {
        // A word starts with its first letter; 2e-3 is a number and no 'e'.
        std::size_t end = i;
        while (end < expression.size() && is_name(expression[end]))
          ++end;
        if (end == i)
          {
            expanded += expression[i++];
            continue;
          }
        const std::string word       = expression.substr(i, end - i);
        const auto        definition = expanded_definitions.find(word);
        expanded += (definition == expanded_definitions.end()
                       ? word
                       : "(" + definition->second + ")");
        i = end;
      }
    return expanded;
  }



  double
  Expressions::evaluate(const std::string &expression,
                        const std::string &where) const
  {
    // There is no coordinate to depend on: no scene file has this name.
    const double value =
      parse_function<1>(
        {expression}, *this, where, "no_coordinate", /*with_time =*/false)
        ->value(dealii::Point<1>());
    if (!std::isfinite(value))
      throw InputError(where + ": '" + excerpt(expression) +
                       "' is not a finite number; correct it.");
    if (std::abs(value) > largest_number)
      throw InputError(where + ": '" + excerpt(expression) +
                       "' is beyond 1e30; choose other units.");
    return value;
  }
} // namespace Friction

#ifndef friction_parameters_parse_function_h
#define friction_parameters_parse_function_h

#include <common/parameters/parameters.h>
#include <common/parameters/scene_file.h>
#include <common/parameters/wrong_number.h>
#include <common/printable.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/base/utilities.h>

#include <deal.II/lac/vector.h>

#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Friction
{
  /**
   * Throws InputError if an expression has several values, separated by commas,
   * of which muParser would take the last one, or an assignment, which it would
   * carry out.
   */
  inline void
  check_is_one_value(const std::string &expression, const std::string &where)
  {
    int depth = 0;
    for (std::size_t i = 0; i < expression.size(); ++i)
      {
        const char c = expression[i];
        depth += (c == '(') - (c == ')');
        if (c == ',' && depth == 0)
          throw InputError(where + ": '" + excerpt(expression) +
                           "' has several values where there should be one; "
                           "correct it.");
        if (c != '=')
          continue;
        const bool first_of_two =
          i + 1 < expression.size() && expression[i + 1] == '=';
        const bool second_of_two = i > 0 &&
          std::string("=<>!").find(expression[i - 1]) != std::string::npos;
        if (!first_of_two && !second_of_two)
          throw InputError(where + ": '" + excerpt(expression) +
                           "' has a '=' in it, but nothing can be assigned "
                           "here; comparisons are written '=='.");
      }
  }

  /**
   * Throws InputError if an expression compares what a comparison says, as
   * '0.5 < x < 1' does: muParser would take it for '(0.5 < x) < 1', which is
   * true on the wrong side. Between two comparisons there must be a logical
   * operator, a condition, a comma, or parentheses around one of them.
   */
  inline void
  check_comparisons(const std::string &expression, const std::string &where)
  {
    // Whether there has been one, at each depth of parentheses.
    std::vector<bool> compares(1, false);
    for (std::size_t i = 0; i < expression.size(); ++i)
      {
        const char c             = expression[i];
        const bool is_comparison = c == '<' || c == '>' || c == '=' || c == '!';
        if (c == '(')
          compares.push_back(false);
        else if (c == ')' && compares.size() > 1)
          compares.pop_back();
        else if (std::string("&|?:,").find(c) != std::string::npos)
          compares.back() = false;
        else if (is_comparison && compares.back())
          throw InputError(where + ": '" + excerpt(expression) +
                           "' has two comparisons in a row, the second of "
                           "which would compare true or false with a number; "
                           "join them by '&&', as in '0.5 < x && x < 1'.");
        else if (is_comparison)
          {
            compares.back() = true;
            // '<=', '>=', '==' and '!=' are one operator each.
            if (i + 1 < expression.size() && expression[i + 1] == '=')
              ++i;
          }
      }
  }

  /** The condition in the name of a region, if it is one: 'where' and an
   * expression. Otherwise the name is what a mesh file calls it. */
  inline std::optional<std::string>
  condition_of_region(const std::string &key)
  {
    const std::string word = "where";
    if (key.compare(0, word.size(), word) != 0 || key.size() == word.size() ||
        std::string(" \t(").find(key[word.size()]) == std::string::npos)
      return {};
    return dealii::Utilities::trim(key.substr(word.size()));
  }

  /** Whether an expression compares anything, at any depth of parentheses. */
  inline bool
  has_comparison(const std::string &expression)
  {
    return expression.find_first_of("<>") != std::string::npos ||
      expression.find("==") != std::string::npos ||
      expression.find("!=") != std::string::npos;
  }

  /**
   * Whether an expression is true or false, that is 1 or 0, since outside of
   * all parentheses but those around all of it there is a comparison or a
   * logical operator.
   */
  inline bool
  is_condition(const std::string &expression)
  {
    std::string text = dealii::Utilities::trim(expression);
    while (true)
      {
        int  depth       = 0;
        bool is_enclosed = text.size() > 2 && text.front() == '(';
        bool found       = false;
        for (std::size_t i = 0; i < text.size(); ++i)
          {
            const char c = text[i];
            depth += (c == '(') - (c == ')');
            if (depth == 0 && i + 1 < text.size())
              is_enclosed = false;
            // A number, chosen by a condition.
            if (depth == 0 && c == '?')
              return false;
            if (depth == 0 &&
                std::string("<>=!&|").find(c) != std::string::npos)
              found = true;
          }
        if (!is_enclosed)
          return found;
        text = dealii::Utilities::trim(text.substr(1, text.size() - 2));
      }
  }

  /**
   * Throws InputError if an expression is another number each time that it is
   * asked for, as those with muParser's 'rand()' are.
   */
  inline void
  check_is_repeatable(const std::string &expression, const std::string &where)
  {
    for (const std::string word : {"rand", "rand_seed"})
      if (n_uses(expression, word) > 0)
        throw InputError(where + ": '" + excerpt(expression) +
                         "' is at random, another number each time that it is "
                         "computed, so that there is nothing to solve; write a "
                         "function of the place, as 'sin(1e4*x)'.");
  }

  /**
   * A function of the coordinates from one expression per component, which may
   * use the given names. With @p with_time and if there is a time, they may use
   * that as well, which set_time() of the function sets. Throws InputError if
   * one of them cannot be understood, with @p where as the beginning of the
   * sentence.
   */
  template <int dim>
  std::shared_ptr<dealii::Function<dim>>
  parse_function(const std::vector<std::string> &components,
                 const Expressions              &expressions,
                 const std::string              &where,
                 const std::string              &coordinates =
                   dealii::FunctionParser<dim>::default_variable_names(),
                 const bool with_time = true)
  {
    std::vector<std::string> expanded;
    for (const std::string &component : components)
      {
        check_is_one_value(component, where);
        check_comparisons(component, where);
        expanded.push_back(expressions.expand(component));
        check_is_repeatable(expanded.back(), where);
      }

    // The parser describes errors on the console before it throws. That is
    // about the expanded expressions, which the user has never seen, so we keep
    // it to ourselves.
    struct SilentErrors
    {
      std::streambuf *const buffer = std::cerr.rdbuf(nullptr);
      ~SilentErrors()
      {
        std::cerr.rdbuf(buffer);
        std::cerr.clear();
      }
    };

    auto function =
      std::make_shared<dealii::FunctionParser<dim>>(components.size());
    try
      {
        const SilentErrors silence;
        const bool         has_time = with_time && expressions.has_time();
        function->initialize(coordinates + (has_time ? ",t" : ""),
                             expanded,
                             expressions.constants(),
                             has_time);
        // Expressions are only parsed when they are first needed.
        dealii::Vector<double> values(components.size());
        function->vector_value(dealii::Point<dim>(), values);
      }
    catch (const std::exception &)
      {
        std::string text;
        for (const std::string &component : components)
          text +=
            (text.empty() ? "" : ", ") + dealii::Utilities::trim(component);
        throw InputError(where + ": '" + excerpt(text) +
                         "' cannot be understood; check its syntax and the "
                         "names in it" +
                         (expressions.has_time() && !with_time
                            ? "; the time t is none of them here."
                            : "."));
      }
    return function;
  }
} // namespace Friction

#endif

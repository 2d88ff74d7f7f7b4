#ifndef friction_parameters_parse_function_h
#define friction_parameters_parse_function_h

#include <common/parameters/parameters.h>
#include <common/parameters/wrong_number.h>
#include <common/printable.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/base/utilities.h>

#include <deal.II/lac/vector.h>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace Friction
{
  /**
   * A function of the coordinates from one expression per component, which may
   * use the given names. Throws InputError if one of them cannot be
   * understood, with @p where as the beginning of the sentence.
   */
  template <int dim>
  std::shared_ptr<dealii::Function<dim>>
  parse_function(const std::vector<std::string> &components,
                 const Expressions              &expressions,
                 const std::string              &where,
                 const std::string              &coordinates =
                   dealii::FunctionParser<dim>::default_variable_names())
  {
    std::vector<std::string> expanded;
    for (const std::string &component : components)
      expanded.push_back(expressions.expand(component));

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
        function->initialize(coordinates, expanded, expressions.constants());
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
                         "names in it.");
      }
    return function;
  }
} // namespace Friction

#endif

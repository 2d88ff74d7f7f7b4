#ifndef friction_parameters_expressions_h
#define friction_parameters_expressions_h

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Friction
{
  /**
   * Whatever the units, a number beyond this is a mistake, and a length, a
   * modulus or a radius below its inverse as well: squares of energies could no
   * longer be represented.
   */
  constexpr double largest_number = 1e30;

  /**
   * The names that the expressions of one scene may use besides the
   * coordinates: constants with a number, and definitions, which are
   * themselves expressions and are put in place of their names.
   */
  class Expressions
  {
  public:
    Expressions() = default;

    /**
     * @param constants names and their numbers
     * @param definitions names and the expressions they stand for, which may
     *   use the constants and the definitions before them
     * @param where the beginning of the sentence if one of them cannot be
     *   understood, which is an InputError
     * @param has_time whether definitions, and expressions with coordinates,
     *   may use the time t
     */
    Expressions(
      const std::map<std::string, double>                    &constants,
      const std::vector<std::pair<std::string, std::string>> &definitions,
      const std::string                                      &where    = "",
      const bool                                              has_time = false);

    /// The expression with every defined name replaced by what it stands for.
    std::string expand(const std::string &expression) const;

    /**
     * The value of an expression that does not depend on the coordinates.
     * Throws InputError when there is none; @p where says in that sentence
     * which parameter is meant.
     */
    double evaluate(const std::string &expression,
                    const std::string &where) const;

    const std::map<std::string, double> &
    constants() const
    {
      return named_numbers;
    }

    bool
    has_time() const
    {
      return time_is_known;
    }

  private:
    bool                               time_is_known = false;
    std::map<std::string, double>      named_numbers;
    std::map<std::string, std::string> expanded_definitions;
  };
} // namespace Friction

#endif

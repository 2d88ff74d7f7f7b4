#ifndef friction_parameters_parameter_entries_h
#define friction_parameters_parameter_entries_h

#include <deal.II/base/patterns.h>

#include <memory>
#include <string>
#include <vector>

namespace Friction
{
  /**
   * One thing that a scene file may say.
   */
  struct ParameterEntry
  {
    std::string                                    section;
    std::string                                    name;
    std::string                                    default_value;
    std::shared_ptr<dealii::Patterns::PatternBase> pattern;
    std::string                                    documentation;

    std::string
    path() const
    {
      return section + "/" + name;
    }
  };

  /** Everything that a scene file may say, in the order of the sections. */
  const std::vector<ParameterEntry> &parameter_entries();

  /**
   * A section that there may be several of: 'Contact 2' and 'Obstacle 2' have
   * the entries of 'Contact' and 'Obstacle', and so have all up to 99.
   */
  struct NumberedSection
  {
    std::string  base;       ///< whose entries it has
    unsigned int number = 1; ///< 1 if it has none
  };

  /** Any other section is its own base. */
  NumberedSection numbered_section(const std::string &section);

  /** The other way round: 'Contact' for 1, 'Contact 2' for 2. */
  std::string section_name(const std::string &base, const unsigned int number);
} // namespace Friction

#endif

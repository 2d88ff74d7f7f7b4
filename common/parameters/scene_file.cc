#include <common/parameters/parameter_entries.h>
#include <common/parameters/parameters.h>
#include <common/parameters/scene_file.h>
#include <common/printable.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    void
    declare_parameters(ParameterHandler &prm)
    {
      for (const ParameterEntry &entry : parameter_entries())
        {
          prm.enter_subsection(entry.section);
          prm.declare_entry(entry.name,
                            entry.default_value,
                            *entry.pattern,
                            entry.documentation);
          prm.leave_subsection();
        }
    }



    // Sections 'Contact 2' and 'Obstacle 2', as far as a scene has any.
    void
    declare_further_contact(ParameterHandler &prm, const unsigned int number)
    {
      for (const ParameterEntry &entry : parameter_entries())
        if (entry.section == "Contact" || entry.section == "Obstacle")
          {
            prm.enter_subsection(section_name(entry.section, number));
            prm.declare_entry(entry.name,
                              entry.default_value,
                              *entry.pattern,
                              entry.documentation);
            prm.leave_subsection();
          }
    }



    // The entry that a path means, or null. 'Contact 2/Boundary id' is that of
    // 'Contact/Boundary id'.
    const ParameterEntry *
    find_entry(const std::string &path)
    {
      const std::string section = path.substr(0, path.find('/'));
      const std::string meant =
        numbered_section(section).base + path.substr(section.size());
      const auto entry = std::find_if(
        parameter_entries().begin(),
        parameter_entries().end(),
        [&](const ParameterEntry &e) { return e.path() == meant; });
      return entry == parameter_entries().end() ? nullptr : &*entry;
    }



    // What a pattern accepts, for the end of a sentence.
    std::string
    wanted(const Patterns::PatternBase &pattern)
    {
      std::string text = pattern.description(Patterns::PatternBase::Text);
      if (text.find("1e-300 <= v <= MAX_DOUBLE") != text.npos)
        return "a positive number";
      // The descriptions begin sentences and name limits that no value meets.
      text[0]            = std::tolower(text[0]);
      const auto replace = [&](const std::string &from, const std::string &to) {
        const auto position = text.find(from);
        if (position != text.npos)
          text.replace(position, from.size(), to);
      };
      replace("floating point number", "number");
      replace(" v such that -MAX_DOUBLE <= v <= MAX_DOUBLE", "");
      replace(" <= 2147483647", "");
      replace("1e-300 <= v", "0 < v");
      return text;
    }



    std::string
    lower_case(std::string s)
    {
      std::transform(s.begin(), s.end(), s.begin(), [](const unsigned char c) {
        return std::tolower(c);
      });
      return s;
    }



    // Number of insertions, deletions and replacements that make one string
    // the other, not looking at upper and lower case.
    unsigned int
    edit_distance(const std::string &first, const std::string &second)
    {
      const std::string         a = lower_case(first), b = lower_case(second);
      std::vector<unsigned int> row(b.size() + 1);
      for (unsigned int j = 0; j <= b.size(); ++j)
        row[j] = j;
      for (unsigned int i = 1; i <= a.size(); ++i)
        {
          unsigned int diagonal = row[0];
          row[0]                = i;
          for (unsigned int j = 1; j <= b.size(); ++j)
            {
              const unsigned int replace =
                diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
              diagonal = row[j];
              row[j]   = std::min({row[j] + 1, row[j - 1] + 1, replace});
            }
        }
      return row[b.size()];
    }



    std::string
    nearest(const std::string &given, const std::vector<std::string> &known)
    {
      // Much longer than what there is, which would take long to find out.
      const std::string name = given.substr(0, 200);
      return *std::min_element(known.begin(),
                               known.end(),
                               [&](const std::string &a, const std::string &b) {
                                 return edit_distance(name, a) <
                                   edit_distance(name, b);
                               });
    }
  } // namespace



  // How often a word is among those of an expression.
  unsigned int
  n_uses(const std::string &expression, const std::string &word)
  {
    unsigned int n       = 0;
    const auto   is_name = [](const unsigned char c) {
      return std::isalnum(c) || c == '_';
    };
    for (std::size_t i = expression.find(word); i != expression.npos;
         i             = expression.find(word, i + 1))
      if ((i == 0 || !is_name(expression[i - 1])) &&
          (i + word.size() == expression.size() ||
           !is_name(expression[i + word.size()])))
        ++n;
    return n;
  }



  SceneFile::SceneFile()
  {
    declare_parameters(prm);
  }



  void
  SceneFile::begin_source()
  {
    set_by_source.clear();
  }



  void
  SceneFile::set(const std::string &path,
                 const std::string &value,
                 const std::string &where)
  {
    const ParameterEntry *const entry = find_entry(path);
    if (entry == nullptr)
      {
        std::vector<std::string> known;
        for (const ParameterEntry &e : parameter_entries())
          known.push_back(e.path());
        throw InputError(where + ": there is no entry '" + excerpt(path) +
                         "'; did you mean '" + nearest(path, known) + "'?");
      }
    if (!set_by_source.insert(path).second)
      throw InputError(where + ": '" + path + "' has been set already, by " +
                       origin[path] + "; remove one of them.");
    if (!entry->pattern->match(value))
      throw InputError(where + ": '" + excerpt(value) + "' is no value for '" +
                       path + "'; give " + wanted(*entry->pattern) + ".");
    const std::string  section = path.substr(0, path.find('/'));
    const unsigned int number  = numbered_section(section).number;
    if (number > 1 && further.insert(number).second)
      declare_further_contact(prm, number);
    prm.enter_subsection(section);
    prm.set(entry->name, value);
    prm.leave_subsection();
    origin[path] = where;
    if (may_use_names(path))
      all_texts.push_back(value);
  }



  const std::set<unsigned int> &
  SceneFile::further_contacts() const
  {
    return further;
  }



  std::string
  SceneFile::get(const std::string &path)
  {
    const auto slash = path.find('/');
    prm.enter_subsection(path.substr(0, slash));
    const std::string value = prm.get(path.substr(slash + 1));
    prm.leave_subsection();
    return value;
  }



  double
  SceneFile::number(const std::string &path)
  {
    // Not string_to_double(), which throws where a number is too small.
    const double value = std::strtod(get(path).c_str(), nullptr);
    if (!(std::abs(value) <= largest_number))
      throw InputError(subject(path) + " is " + excerpt(get(path)) +
                       ", which is beyond 1e30; choose other units.");
    return value;
  }



  double
  SceneFile::positive_number(const std::string &path)
  {
    const double value = number(path);
    if (!(value >= 1. / largest_number))
      throw InputError(subject(path) + " is " + excerpt(get(path)) +
                       ", but it must " +
                       (value > 0. ? "not be below 1e-30; choose other units."
                                   : "be positive."));
    return value;
  }



  unsigned int
  SceneFile::integer(const std::string &path)
  {
    return Utilities::string_to_int(get(path));
  }



  unsigned int
  SceneFile::steps(const std::string &path, const unsigned int automatic)
  {
    return get(path) == "automatic" ? automatic : integer(path);
  }



  bool
  SceneFile::flag(const std::string &path)
  {
    const std::string value = get(path);
    return value == "true" || value == "yes";
  }



  bool
  SceneFile::is_changed(const std::string &path)
  {
    return origin.count(path) > 0 &&
      get(path) != find_entry(path)->default_value;
  }



  unsigned int
  SceneFile::n_uses(const std::string &word)
  {
    unsigned int n = 0;
    for (const auto &[path, where] : origin)
      if (may_use_names(path))
        n += Friction::n_uses(get(path), word);
    return n;
  }



  unsigned int
  SceneFile::n_uses_ever(const std::string &word) const
  {
    unsigned int n = 0;
    for (const std::string &text : all_texts)
      n += Friction::n_uses(text, word);
    return n;
  }



  std::string
  SceneFile::subject(const std::string &path) const
  {
    const auto where = origin.find(path);
    return (where == origin.end() ? std::string("default value")
                                  : where->second) +
      ": '" + path + "'";
  }



  std::string
  SceneFile::text()
  {
    std::ostringstream out;
    prm.print_parameters(
      out, ParameterHandler::ShortPRM | ParameterHandler::KeepDeclarationOrder);
    return out.str();
  }



  bool
  SceneFile::may_use_names(const std::string &path)
  {
    return path != "Scene/Mesh file" && path.compare(0, 7, "Output/") != 0;
  }



  // ParameterHandler could read the file itself, but its messages neither
  // name the nearest entry nor fit one line. The format is simple enough.
  void
  read_file(const std::string &file_name, SceneFile &values)
  {
    std::ifstream file(file_name);
    std::string   line;
    if (!file || file.peek() == std::ifstream::traits_type::eof())
      throw InputError((file.is_open() ? "there is nothing in the scene file '"
                                       : "cannot read the scene file '") +
                       excerpt(file_name, 300) +
                       "'; give the path of an existing, readable scene.");

    std::vector<std::string> sections;
    for (const ParameterEntry &entry : parameter_entries())
      if (sections.empty() || sections.back() != entry.section)
        sections.push_back(entry.section);

    std::string  section;
    unsigned int n_lines = 0, section_line = 0;
    const auto   is_word = [](const std::string &text, const std::string &w) {
      return text.compare(0, w.size(), w) == 0 &&
        (text.size() == w.size() ||
         std::isspace(static_cast<unsigned char>(text[w.size()])));
    };
    while (std::getline(file, line))
      {
        ++n_lines;
        // What some editors begin a file with.
        if (n_lines == 1 && line.rfind("\xef\xbb\xbf", 0) == 0)
          line.erase(0, 3);
        const std::string where =
          file_name + ":" + Utilities::int_to_string(n_lines);

        // A backslash at the end continues the line; '#' starts a comment.
        const auto clean = [](const std::string &raw) {
          return Utilities::trim(raw.substr(0, raw.find('#')));
        };
        line = clean(line);
        std::string more;
        while (!line.empty() && line.back() == '\\')
          {
            line.pop_back();
            if (!std::getline(file, more))
              break;
            ++n_lines;
            line = Utilities::trim(line) + " " + clean(more);
          }
        if (line.empty())
          continue;

        if (is_word(line, "subsection"))
          {
            const std::string name = Utilities::trim(line.substr(10));
            if (!section.empty())
              throw InputError(where + ": section '" + excerpt(name) +
                               "' begins inside section '" + section +
                               "'; close that one with 'end' first.");
            if (std::find(sections.begin(),
                          sections.end(),
                          numbered_section(name).base) == sections.end())
              throw InputError(where + ": there is no section '" +
                               excerpt(name) + "'; did you mean '" +
                               nearest(name, sections) + "'?");
            section      = name;
            section_line = n_lines;
          }
        else if (line == "end")
          {
            if (section.empty())
              throw InputError(where +
                               ": 'end' closes no section; "
                               "remove it.");
            section.clear();
          }
        else if (is_word(line, "set") && line.find('=') != line.npos)
          {
            const auto        equal = line.find('=');
            const std::string name = Utilities::trim(line.substr(3, equal - 3));
            const std::string value = Utilities::trim(line.substr(equal + 1));
            values.set(
              section.empty() ? name : section + "/" + name, value, where);
          }
        else
          throw InputError(where + ": '" + excerpt(line) +
                           "' is neither 'subsection <name>', 'set <entry> = "
                           "<value>' nor 'end'; correct the line.");
      }
    if (!section.empty())
      throw InputError(file_name + ":" +
                       Utilities::int_to_string(section_line) + ": section '" +
                       section + "' is not closed; add a line 'end'.");
  }



  void
  read_override(const std::string &text, SceneFile &values)
  {
    const auto equal = text.find('=');
    const auto slash = text.find('/');
    if (equal == text.npos || slash == text.npos || slash > equal)
      throw InputError("override '" + excerpt(text) +
                       "': this is not of the form Section/Entry=value; "
                       "quote it if it contains blanks.");
    values.set(Utilities::trim(text.substr(0, equal)),
               Utilities::trim(text.substr(equal + 1)),
               "override '" + excerpt(text) + "'");
  }



  std::string
  first_difference(const std::string &text,
                   const std::string &other,
                   const bool         may_be_refined)
  {
    std::set<std::string> may_differ = {"Refinement/Estimate error"};
    if (may_be_refined)
      may_differ.insert({"Refinement/Levels", "Refinement/Maximum dofs"});

    // What one of the two does not mention has its default there.
    std::array<ParameterHandler, 2> handlers;
    std::set<unsigned int>          further;
    for (const std::string *const one : {&text, &other})
      {
        std::istringstream lines(*one);
        for (std::string line; std::getline(lines, line);)
          {
            line = Utilities::trim(line);
            if (line.compare(0, 11, "subsection ") == 0)
              further.insert(
                numbered_section(Utilities::trim(line.substr(11))).number);
          }
      }
    further.erase(1);
    for (ParameterHandler &handler : handlers)
      {
        declare_parameters(handler);
        for (const unsigned int number : further)
          declare_further_contact(handler, number);
      }
    handlers[0].parse_input_from_string(text);
    handlers[1].parse_input_from_string(other);
    const auto value = [&](const unsigned int i,
                           const std::string &section,
                           const std::string &name) {
      handlers[i].enter_subsection(section);
      const std::string value = handlers[i].get(name);
      handlers[i].leave_subsection();
      return value;
    };

    for (const ParameterEntry &entry : parameter_entries())
      {
        std::vector<std::string> sections = {entry.section};
        if (entry.section == "Contact" || entry.section == "Obstacle")
          for (const unsigned int number : further)
            sections.push_back(section_name(entry.section, number));
        for (const std::string &section : sections)
          if (section != "Solver" && section != "Output" &&
              may_differ.count(entry.path()) == 0 &&
              value(0, section, entry.name) != value(1, section, entry.name))
            return section + '/' + entry.name;
      }
    return "";
  }



  void
  print_default_parameters(std::ostream &out)
  {
    ParameterHandler prm;
    declare_parameters(prm);
    prm.print_parameters(
      out, ParameterHandler::PRM | ParameterHandler::KeepDeclarationOrder);
  }
} // namespace Friction

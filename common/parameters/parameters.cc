#include <common/parameters/parameter_entries.h>
#include <common/parameters/parameters.h>
#include <common/parameters/parse_function.h>
#include <common/parameters/scene_file.h>
#include <common/printable.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <set>
#include <sstream>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    // Split at a character, but not inside parentheses, and trim the parts.
    // Nothing makes no part.
    std::vector<std::string>
    split(const std::string &text, const char separator)
    {
      std::vector<std::string> parts;
      if (Utilities::trim(text).empty())
        return parts;
      int         depth = 0;
      std::string part;
      for (const char c : text)
        {
          depth += (c == '(') - (c == ')');
          if (c == separator && depth == 0)
            {
              parts.push_back(Utilities::trim(part));
              part.clear();
            }
          else
            part += c;
        }
      // One separator too many at the end does no harm.
      if (!Utilities::trim(part).empty())
        parts.push_back(Utilities::trim(part));
      return parts;
    }



    std::vector<std::pair<std::string, std::string>>
    read_names(const std::string                   &path,
               const std::map<std::string, double> &taken,
               SceneFile                           &values)
    {
      std::vector<std::pair<std::string, std::string>> names;
      for (const std::string &part : split(values.get(path), ';'))
        {
          const auto        equal = part.find('=');
          const std::string name  = Utilities::trim(part.substr(0, equal));
          const bool good_name    = !name.empty() && !std::isdigit(name[0]) &&
            std::all_of(name.begin(), name.end(), [](const unsigned char c) {
              return std::isalnum(c) || c == '_';
            });
          if (equal == part.npos || !good_name)
            throw InputError(values.subject(path) + ": '" + excerpt(part) +
                             "' is not of the form 'name = expression'; "
                             "correct it.");
          if (taken.count(name) > 0)
            throw InputError(values.subject(path) + ": '" + excerpt(name) +
                             "' is a constant already; choose another name.");
          for (const auto &other : names)
            if (other.first == name)
              throw InputError(values.subject(path) + " says twice what '" +
                               excerpt(name) + "' is; remove one of them.");
          if (name == "x" || name == "y" || name == "z")
            throw InputError(values.subject(path) + ": '" + name +
                             "' is a coordinate; choose another name.");
          if (name.compare(0, 3, "no_") == 0)
            throw InputError(values.subject(path) + ": '" + excerpt(name) +
                             "' begins like names that the program needs for "
                             "itself; choose another name.");
          if (name == "t" && !values.get("Load steps/Times").empty())
            throw InputError(values.subject(path) +
                             ": 't' is the time of load steps; choose another "
                             "name.");
          names.emplace_back(name, Utilities::trim(part.substr(equal + 1)));
        }
      return names;
    }



    std::vector<ConditionText>
    read_conditions(const std::string &path,
                    const std::string &form,
                    SceneFile         &values)
    {
      std::vector<ConditionText> conditions;
      for (const std::string &part : split(values.get(path), ';'))
        {
          const auto colon = part.find(':');
          if (colon == part.npos || colon == 0)
            throw InputError(values.subject(path) + ": '" + excerpt(part) +
                             "' is not of the form '" + form +
                             "'; correct it.");
          conditions.push_back({Utilities::trim(part.substr(0, colon)),
                                split(part.substr(colon + 1), ',')});
        }
      return conditions;
    }



    std::vector<double>
    read_vector(const std::string &text,
                const std::string &subject,
                const Expressions &expressions)
    {
      std::vector<double> numbers;
      for (const std::string &part : split(text, ','))
        numbers.push_back(expressions.evaluate(part, subject));
      return numbers;
    }



    void
    check_poisson_ratio(const double nu, const std::string &sentence)
    {
      if (!(nu > -1. && nu < .5))
        throw InputError(sentence +
                         ", but it must lie strictly between -1 and 1/2.");
      // Against one of shear and volume the body is then ten thousand million
      // times as stiff as against the other, of which few digits are left.
      constexpr double closest = 5e-11;
      if (nu < -1. + closest || nu > .5 - closest)
        throw InputError(sentence + ", which is so close to " +
                         (nu > 0. ? "1/2" : "-1") +
                         " that few digits of stresses would be left; take one "
                         "that is farther from it than 5e-11.");
    }



    VolumetricStrain
    volumetric_strain(const std::string &name)
    {
      return name == "mean" ? VolumetricStrain::mean
                            : VolumetricStrain::pointwise;
    }



    // Other materials in parts of the body.
    void
    read_regions(const std::string &usual_kind,
                 SceneFile         &values,
                 Parameters        &parameters)
    {
      const std::string path    = "Material/Regions";
      const std::string subject = values.subject(path);
      for (const ConditionText &text :
           read_conditions(path, "region: E, nu", values))
        {
          const auto       &numbers = text.components;
          const std::string here =
            subject + ": region '" + excerpt(text.key) + "' has ";
          if (numbers.size() != 2 && numbers.size() != 3)
            throw InputError(here +
                             counted(numbers.size(), "number", "numbers") +
                             ", where 'E, nu' is wanted; correct it.");
          if (numbers.size() == 3 && numbers[2] != "mean" &&
              numbers[2] != "pointwise")
            throw InputError(here + "'" + excerpt(numbers[2]) +
                             "' as volumetric strain; take 'mean' or "
                             "'pointwise'.");
          const auto condition = condition_of_region(text.key);
          if (condition &&
              !has_comparison(parameters.expressions.expand(*condition)))
            throw InputError(subject + ": '" + excerpt(*condition) +
                             "' compares nothing, and would be true "
                             "wherever it is not zero; write a condition, "
                             "as in 'where y > 0.9: 100*E, nu'.");
          const double E = parameters.expressions.evaluate(numbers[0], subject);
          const double nu =
            parameters.expressions.evaluate(numbers[1], subject);
          if (!(E >= 1. / largest_number && E <= largest_number))
            throw InputError(here + excerpt(numbers[0]) +
                             " as Young's modulus, which must be positive and "
                             "between 1e-30 and 1e30.");
          check_poisson_ratio(nu,
                              here + excerpt(numbers[1]) + " as Poisson ratio");
          parameters.regions.push_back(
            {text.key,
             Material(E,
                      nu,
                      volumetric_strain(numbers.size() == 3 ? numbers[2]
                                                            : usual_kind))});
        }
    }



    // Which increase, and may use the constants.
    std::vector<double>
    read_times(SceneFile                           &values,
               const std::map<std::string, double> &constants)
    {
      const std::string         path  = "Load steps/Times";
      const std::vector<double> times = read_vector(
        values.get(path), values.subject(path), Expressions(constants, {}));
      for (unsigned int i = 1; i < times.size(); ++i)
        if (!(times[i] > times[i - 1]))
          throw InputError(values.subject(path) +
                           " is not increasing: time number " +
                           std::to_string(i + 1) +
                           " is not after the one before; correct it.");
      return times;
    }



    // 'length: mm, force: N', each at most once.
    Parameters::UnitNames
    read_units(SceneFile &values)
    {
      const std::string     path = "Output/Units";
      Parameters::UnitNames names;
      for (const std::string &part : split(values.get(path), ','))
        {
          const auto        colon = part.find(':');
          const std::string key   = Utilities::trim(part.substr(0, colon));
          const std::string name =
            colon == part.npos ? "" : Utilities::trim(part.substr(colon + 1));
          std::string *const target = key == "length" ? &names.length
            : key == "force"                          ? &names.force
                                                      : nullptr;
          if (target == nullptr || name.empty())
            throw InputError(values.subject(path) + ": '" + excerpt(part) +
                             "' is not understood; write it like "
                             "'length: mm, force: N'.");
          if (!target->empty())
            throw InputError(values.subject(path) + " names the unit of " +
                             key + " twice; keep one.");
          if (name.size() > 20 || printable(name) != name ||
              name.find_first_of("\"[]") != name.npos)
            throw InputError(values.subject(path) + ": '" + excerpt(name) +
                             "' is no name of a unit; take up to 20 letters.");
          *target = name;
        }
      return names;
    }



    // A coefficient of friction that is not a number is a definition of F. It
    // may use the definitions before the first one that uses it, and comes
    // right after them.
    void
    define_varying_coefficient(
      SceneFile                                        &values,
      const std::map<std::string, double>              &constants,
      std::vector<std::pair<std::string, std::string>> &definitions,
      Parameters                                       &parameters)
    {
      Parameters::Contact &contact = parameters.contact;
      const std::string    name    = "Contact/Friction coefficient";
      contact.varying_coefficient  = values.get(name);
      const auto first_use         = std::find_if(
        definitions.begin(), definitions.end(), [](const auto &definition) {
          return n_uses(definition.second, "F") > 0;
        });
      const Expressions before(constants,
                               {definitions.begin(), first_use},
                               values.subject("Scene/Definitions"),
                               !parameters.load_steps.times.empty());
      parse_function<3>(
        {contact.varying_coefficient}, before, values.subject(name));
      definitions.insert(first_use, {"F", contact.varying_coefficient});
    }



    // A number, or the word that leaves it to the estimated error.
    void
    read_inner_tolerance(SceneFile &values, Parameters &parameters)
    {
      const std::string name   = "Solver/Inner tolerance";
      const std::string text   = values.get(name);
      SolverSettings   &solver = parameters.solver;
      if (text != "discretisation")
        {
          if (!Patterns::Double(1e-300).match(text))
            throw InputError(values.subject(name) + " is '" + excerpt(text) +
                             "'; take a positive number, or 'discretisation'.");
          solver.inner_tolerance = std::strtod(text.c_str(), nullptr);
          return;
        }
      if (solver.algorithm == Algorithm::fixed_point)
        throw InputError(values.subject(name) +
                         " is 'discretisation', which is for the algorithm "
                         "'Gauss-Seidel like' only; take that or a number.");
      if (!parameters.refinement.estimate_error)
        throw InputError(values.subject(name) +
                         " is 'discretisation', but errors are not estimated; "
                         "set 'Refinement/Estimate error' or take a number.");
      solver.stop_at_discretization = true;
    }



    std::vector<std::vector<double>>
    read_vectors(const std::string &path,
                 SceneFile         &values,
                 const Expressions &expressions)
    {
      std::vector<std::vector<double>> vectors;
      for (const std::string &part : split(values.get(path), ';'))
        vectors.push_back(read_vector(part, values.subject(path), expressions));
      return vectors;
    }



    // What is in the way, from a section of that name.
    void
    read_obstacle(const std::string    &section,
                  SceneFile            &values,
                  const Expressions    &expressions,
                  Parameters::Obstacle &obstacle)
    {
      const auto path = [&](const std::string &name) {
        return section + '/' + name;
      };
      const auto vector_of = [&](const std::string &name) {
        return read_vector(
          values.get(path(name)), values.subject(path(name)), expressions);
      };

      const std::string kind = values.get(path("Kind"));
      obstacle.kind          = (kind == "none"      ? ObstacleKind::none
                                  : kind == "plane" ? ObstacleKind::plane
                                  : kind == "rods"  ? ObstacleKind::rods
                                  : kind == "balls" ? ObstacleKind::balls
                                                    : ObstacleKind::surface);
      obstacle.point         = vector_of("Point");
      obstacle.normal        = vector_of("Normal");
      obstacle.centers  = read_vectors(path("Centers"), values, expressions);
      obstacle.axes     = read_vectors(path("Axes"), values, expressions);
      obstacle.is_hole  = values.get(path("Side")) == "inside";
      obstacle.function = values.get(path("Function"));
      check_is_one_value(obstacle.function, values.subject(path("Function")));
      if (obstacle.kind == ObstacleKind::surface &&
          is_condition(expressions.expand(obstacle.function)))
        throw InputError(values.subject(path("Function")) + ": '" +
                         excerpt(obstacle.function) +
                         "' is a condition, true or false; write what is "
                         "positive where the body may be and grows away from "
                         "the surface, as 'y + 1' in place of 'y > -1'.");
      for (const auto &radius :
           read_vectors(path("Radius"), values, expressions))
        {
          if (radius.size() != 1 ||
              !(radius[0] >= 1. / largest_number &&
                radius[0] <= largest_number))
            throw InputError(values.subject(path("Radius")) + " is '" +
                             excerpt(values.get(path("Radius"))) +
                             "', but radii must be positive numbers between "
                             "1e-30 and 1e30, separated by ';'.");
          obstacle.radii.push_back(radius[0]);
        }
      if (!values.get(path("Length")).empty())
        {
          obstacle.length = expressions.evaluate(
            values.get(path("Length")), values.subject(path("Length")));
          if (!(obstacle.length > 0.))
            throw InputError(values.subject(path("Length")) + " is '" +
                             excerpt(values.get(path("Length"))) +
                             "', but it must be positive.");
        }
      const bool is_round = obstacle.kind == ObstacleKind::rods ||
        obstacle.kind == ObstacleKind::balls;
      if (is_round && obstacle.centers.empty())
        throw InputError(values.subject(path("Kind")) + " is '" + kind +
                         "', but there are none; set '" + path("Centers") +
                         "'.");
      if (is_round && obstacle.radii.size() != 1 &&
          obstacle.radii.size() != obstacle.centers.size())
        throw InputError(values.subject(path("Radius")) + " has " +
                         counted(obstacle.radii.size(), "number", "numbers") +
                         ", but there are " +
                         std::to_string(obstacle.centers.size()) + " " + kind +
                         "; give one for each, or one for all.");
      if (obstacle.kind == ObstacleKind::surface && obstacle.function.empty())
        throw InputError(values.subject(path("Kind")) +
                         " is 'surface', but there is none; set '" +
                         path("Function") + "'.");
      const auto is_zero = [](const std::vector<double> &v) {
        return std::all_of(v.begin(), v.end(), [](const double c) {
          return std::abs(c) < 1. / largest_number;
        });
      };
      if (!obstacle.normal.empty() && is_zero(obstacle.normal))
        throw InputError(values.subject(path("Normal")) +
                         " is zero, or below 1e-30; give a direction.");
      if (std::any_of(obstacle.axes.begin(), obstacle.axes.end(), is_zero))
        throw InputError(values.subject(path("Axes")) +
                         " contains a vector that is zero, or below 1e-30; "
                         "give directions.");
    }



    // How a body may touch an obstacle. The coefficient of the first section is
    // read before all else.
    void
    read_contact(const std::string   &section,
                 SceneFile           &values,
                 Parameters::Contact &contact)
    {
      const auto path = [&](const std::string &name) {
        return section + '/' + name;
      };

      const std::string law = values.get(path("Friction law"));
      contact.boundary      = values.get(path("Boundary id"));
      if (contact.boundary == "-1")
        contact.boundary.clear();
      contact.friction_law   = (law == "none"       ? FrictionLaw::none
                                  : law == "Tresca" ? FrictionLaw::tresca
                                                    : FrictionLaw::coulomb);
      contact.friction_bound = values.get(path("Friction bound"));
      contact.ignore_prescribed_penetration =
        values.flag(path("Ignore prescribed penetration"));
      contact.normal = (values.get(path("Contact normal")) == "body"
                          ? ContactNormal::body
                          : ContactNormal::obstacle);
    }



    Parameters::FurtherContact
    read_further_contact(const unsigned int number,
                         SceneFile         &values,
                         const Expressions &expressions)
    {
      Parameters::FurtherContact result;
      result.number = number;
      read_obstacle(
        section_name("Obstacle", number), values, expressions, result.obstacle);
      const std::string section = section_name("Contact", number);
      read_contact(section, values, result.contact);

      const std::string name = section + "/Friction coefficient";
      if (Patterns::Double().match(values.get(name)))
        {
          result.contact.friction_coefficient = values.number(name);
          if (!(result.contact.friction_coefficient >= 0.))
            throw InputError(values.subject(name) + " is " +
                             excerpt(values.get(name)) +
                             ", but it must not be negative.");
        }
      else
        {
          result.contact.varying_coefficient = values.get(name);
          parse_function<3>({result.contact.varying_coefficient},
                            expressions,
                            values.subject(name));
        }
      return result;
    }



    // The sentence on an entry that has been set in vain, and why it is in
    // vain.
    std::string
    not_used(const SceneFile   &values,
             const std::string &path,
             const std::string &reason)
    {
      return "Warning: " + values.subject(path) + " is not used, since " +
        reason + ".";
    }



    // Entries that have been set, and that nothing uses in this scene: most
    // likely another entry is not what it should be.
    std::vector<std::string>
    unused_entries(SceneFile &values)
    {
      std::vector<std::string> warnings;
      const auto               is_one_of = [&](const std::string              &path,
                                 const std::vector<std::string> &choices) {
        return std::find(choices.begin(), choices.end(), values.get(path)) !=
          choices.end();
      };
      const auto only_with = [&](const std::string              &path,
                                 const std::string              &other,
                                 const std::vector<std::string> &choices) {
        if (!values.is_changed(path) || is_one_of(other, choices))
          return;
        std::string wanted;
        for (const std::string &choice : choices)
          wanted += (wanted.empty() ? "'" : " or '") + choice + "'";
        warnings.push_back(not_used(values,
                                    path,
                                    "'" + other + "' is '" + values.get(other) +
                                      "' and not " + wanted));
      };

      const std::string geometry = "Scene/Geometry";
      for (const std::string name : {"Size", "Subdivisions", "Distortion"})
        only_with("Scene/" + name, geometry, {"rectangle"});
      only_with("Scene/Radius",
                geometry,
                {"half disc", "cylinder", "half cylinder", "half ball"});
      for (const std::string name : {"Length", "Layers"})
        only_with("Scene/" + name, geometry, {"cylinder", "half cylinder"});
      only_with("Scene/Coarse grid", geometry, {"cylinder"});
      if (is_one_of(geometry, {"cylinder"}))
        only_with("Scene/Layers", "Scene/Coarse grid", {"O-grid"});
      std::vector<unsigned int> numbers = {1};
      numbers.insert(numbers.end(),
                     values.further_contacts().begin(),
                     values.further_contacts().end());
      for (const unsigned int number : numbers)
        {
          const std::string obstacle = section_name("Obstacle", number) + '/';
          const std::string contact  = section_name("Contact", number) + '/';
          const std::string kind     = obstacle + "Kind";
          for (const std::string name : {"Point", "Normal"})
            only_with(obstacle + name, kind, {"plane"});
          for (const std::string name : {"Centers", "Radius", "Side"})
            only_with(obstacle + name, kind, {"rods", "balls"});
          for (const std::string name : {"Axes", "Length"})
            only_with(obstacle + name, kind, {"rods"});
          only_with(obstacle + "Function", kind, {"surface"});
          only_with(contact + "Contact normal",
                    kind,
                    {"plane", "rods", "balls", "surface"});
          const std::string law = contact + "Friction law";
          only_with(contact + "Friction bound", law, {"Tresca"});
          // Expressions may use the first one as F.
          if (number > 1 || values.n_uses("F") == 0)
            only_with(contact + "Friction coefficient", law, {"Coulomb"});
        }
      for (const std::string name : {"Marking", "Contact zone"})
        only_with("Refinement/" + name, "Refinement/Strategy", {"adaptive"});
      if (split(values.get("Load steps/Times"), ',').size() > 1 &&
          values.n_uses("t") == 0)
        warnings.push_back(
          "Warning: " + values.subject("Load steps/Times") +
          " has several times, but nothing in the scene depends on t.");
      // Safeguards may come to use the other entries of Algorithm 2, too.
      const std::vector<std::string> yes = {"true", "yes"};
      for (const std::string name : {"Outer damping", "Mixed outer iterations"})
        only_with("Solver/" + name, "Solver/Algorithm", {"fixed point"});
      if (!values.flag("Solver/Safeguards"))
        for (const std::string name :
             {"Outer tolerance", "Maximum outer iterations"})
          only_with("Solver/" + name, "Solver/Algorithm", {"fixed point"});
      only_with("Solver/Total cycles", "Solver/Safeguards", yes);
      only_with("Solver/Recombined steps",
                "Solver/Coarse correction",
                {"truncated", "aggregates", "algebraic"});
      only_with("Output/Format", "Output/Fields", yes);
      only_with("Output/Principal stresses", "Output/Fields", yes);
      // Where it is defined it is used once.
      for (const std::string path : {"Scene/Constants", "Scene/Definitions"})
        for (const std::string &part : split(values.get(path), ';'))
          {
            const std::string name =
              Utilities::trim(part.substr(0, part.find('=')));
            if (values.n_uses_ever(name) < 2)
              warnings.push_back("Warning: " + values.subject(path) +
                                 " says what '" + excerpt(name) +
                                 "' is, which nothing uses.");
          }
      return warnings;
    }



    // Those that have a meaning in three dimensions only. A scene file does not
    // say how many there are.
    std::vector<std::string>
    entries_of_three_dimensions(SceneFile &values)
    {
      std::vector<std::string> names    = {"Solver/Local solver"};
      const auto               add_rods = [&](const unsigned int number) {
        const std::string section = section_name("Obstacle", number);
        if (values.get(section + "/Kind") == "rods")
          for (const std::string name : {"/Axes", "/Length"})
            names.push_back(section + name);
      };
      add_rods(1);
      for (const unsigned int number : values.further_contacts())
        add_rods(number);

      std::vector<std::string> warnings;
      for (const std::string &name : names)
        if (values.is_changed(name))
          warnings.push_back(
            not_used(values, name, "the scene is one of two dimensions"));
      return warnings;
    }



    // Friction feels what the body does, and not what the obstacle does.
    void
    warn_of_moving_obstacles(SceneFile &values, Parameters &parameters)
    {
      const auto warn = [&](const unsigned int          number,
                            const Parameters::Obstacle &obstacle,
                            const Parameters::Contact  &contact) {
        const bool has_friction = contact.friction_law == FrictionLaw::tresca ||
          (contact.friction_law == FrictionLaw::coulomb &&
           (contact.friction_coefficient > 0. ||
            !contact.varying_coefficient.empty()));
        if (parameters.load_steps.times.size() > 1 && has_friction &&
            obstacle.kind == ObstacleKind::surface &&
            n_uses(parameters.expressions.expand(obstacle.function), "t") > 0)
          parameters.warnings.push_back(
            "Warning: " +
            values.subject(section_name("Obstacle", number) + "/Function") +
            " depends on t, but slip is that of the body alone: where the "
            "obstacle moves along its own surface, friction takes no notice.");
      };
      warn(1, parameters.obstacle, parameters.contact);
      for (const auto &further : parameters.further_contacts)
        warn(further.number, further.obstacle, further.contact);
    }

  } // namespace



  Parameters
  read_parameters(const std::string              &scene_file,
                  const std::vector<std::string> &overrides)
  {
    SceneFile values;
    read_file(scene_file, values);
    for (const std::string &override_text : overrides)
      {
        values.begin_source();
        read_override(override_text, values);
      }

    Parameters parameters;

    const auto        slash  = scene_file.find_last_of('/');
    const std::string folder = scene_file.substr(0, slash + 1);
    const std::string leaf   = scene_file.substr(slash + 1);
    parameters.name          = leaf.substr(0, leaf.find_last_of('.'));
    parameters.text          = values.text();

    // The material and the coefficient of friction come first, since
    // expressions may use them.
    const double E  = values.positive_number("Material/Young's modulus");
    const double nu = values.number("Material/Poisson ratio");
    const bool   F_varies =
      !Patterns::Double().match(values.get("Contact/Friction coefficient"));
    const double F =
      F_varies ? 0. : values.number("Contact/Friction coefficient");
    check_poisson_ratio(nu,
                        values.subject("Material/Poisson ratio") + " is " +
                          excerpt(values.get("Material/Poisson ratio")));
    if (!(F >= 0.))
      throw InputError(values.subject("Contact/Friction coefficient") + " is " +
                       excerpt(values.get("Contact/Friction coefficient")) +
                       ", but it must not be negative.");
    const std::string kind = values.get("Material/Volumetric strain");
    parameters.material    = Material(E, nu, volumetric_strain(kind));

    std::map<std::string, double> constants = {
      {"E", E},
      {"nu", nu},
      {"lambda", parameters.material.lambda()},
      {"mu", parameters.material.mu()},
      {"F", F},
      {"pi", numbers::PI}};
    const auto named_constants =
      read_names("Scene/Constants", constants, values);
    if (F_varies)
      constants.erase("F");
    for (const auto &[name, expression] : named_constants)
      constants[name] =
        Expressions(constants, {})
          .evaluate(expression, values.subject("Scene/Constants"));
    parameters.load_steps.times = read_times(values, constants);
    auto taken                  = constants;
    taken["F"]                  = F;
    auto definitions = read_names("Scene/Definitions", taken, values);
    if (F_varies)
      define_varying_coefficient(values, constants, definitions, parameters);
    parameters.expressions = Expressions(constants,
                                         definitions,
                                         values.subject("Scene/Definitions"),
                                         !parameters.load_steps.times.empty());

    read_regions(kind, values, parameters);

    const auto vector_of = [&](const std::string &path) {
      return read_vector(
        values.get(path), values.subject(path), parameters.expressions);
    };

    {
      const std::string geometry = values.get("Scene/Geometry");
      auto             &scene    = parameters.scene;
      scene.geometry =
        (geometry == "half disc"         ? GeometryKind::half_disc
           : geometry == "rectangle"     ? GeometryKind::rectangle
           : geometry == "cylinder"      ? GeometryKind::cylinder
           : geometry == "half cylinder" ? GeometryKind::half_cylinder
           : geometry == "half ball"     ? GeometryKind::half_ball
                                         : GeometryKind::mesh_file);
      scene.size = vector_of("Scene/Size");
      for (const double length : scene.size)
        if (!(length >= 1. / largest_number))
          throw InputError(values.subject("Scene/Size") + " is '" +
                           excerpt(values.get("Scene/Size")) +
                           "', but all lengths must be positive" +
                           (length > 0. ? ", and 1e-30 at least; choose other "
                                          "units."
                                        : "."));
      for (const double n : vector_of("Scene/Subdivisions"))
        {
          if (!(n >= 1. && n <= 1e6 && n == std::floor(n)))
            throw InputError(values.subject("Scene/Subdivisions") + " is '" +
                             excerpt(values.get("Scene/Subdivisions")) +
                             "', but it must consist of positive integers.");
          scene.subdivisions.push_back(static_cast<unsigned int>(n));
        }
      scene.radius = values.positive_number("Scene/Radius");
      scene.length = values.positive_number("Scene/Length");
      scene.layers = values.integer("Scene/Layers");
      scene.coarse_grid =
        (values.get("Scene/Coarse grid") == "O-grid" ? CoarseGrid::o_grid
                                                     : CoarseGrid::one_cell);
      scene.mesh_file = values.get("Scene/Mesh file");
      if (scene.geometry == GeometryKind::mesh_file)
        {
          if (scene.mesh_file.empty())
            throw InputError(values.subject("Scene/Geometry") +
                             " is 'mesh file', but none is given; set "
                             "'Scene/Mesh file'.");
          if (scene.mesh_file[0] != '/')
            scene.mesh_file = folder + scene.mesh_file;
        }
      else if (!scene.mesh_file.empty())
        throw InputError(values.subject("Scene/Mesh file") + " is '" +
                         excerpt(scene.mesh_file) +
                         "', but 'Scene/Geometry' is '" + geometry +
                         "'; set that to 'mesh file', or remove the file.");
      scene.distortion         = values.number("Scene/Distortion");
      scene.rotation_angle     = values.number("Scene/Rotation angle");
      scene.exact_displacement = values.get("Scene/Exact displacement");
    }

    read_obstacle(
      "Obstacle", values, parameters.expressions, parameters.obstacle);

    {
      auto &conditions        = parameters.boundary_conditions;
      conditions.displacement = read_conditions(
        "Boundary conditions/Displacement", "id: u_x, u_y[, u_z]", values);
      conditions.force = read_conditions(
        "Boundary conditions/Force", "id: F_x, F_y[, F_z]", values);
      conditions.traction = read_conditions(
        "Boundary conditions/Traction", "id: t_x, t_y[, t_z]", values);
      conditions.pinned_points =
        read_conditions("Boundary conditions/Pinned points",
                        "(x, y[, z]): u_x, u_y[, u_z]",
                        values);
      conditions.body_force = values.get("Boundary conditions/Body force");
    }

    read_contact("Contact", values, parameters.contact);
    parameters.contact.friction_coefficient = F;
    for (const unsigned int number : values.further_contacts())
      parameters.further_contacts.push_back(
        read_further_contact(number, values, parameters.expressions));

    {
      auto &refinement    = parameters.refinement;
      refinement.strategy = (values.get("Refinement/Strategy") == "uniform"
                               ? RefinementStrategy::uniform
                               : RefinementStrategy::adaptive);
      refinement.initial_refinements =
        values.integer("Refinement/Initial refinements");
      refinement.levels         = values.integer("Refinement/Levels");
      refinement.maximum_dofs   = values.integer("Refinement/Maximum dofs");
      refinement.marking        = values.number("Refinement/Marking");
      refinement.contact_zone   = values.flag("Refinement/Contact zone");
      refinement.estimate_error = values.flag("Refinement/Estimate error");
    }

    {
      const std::string truncation = values.get("Solver/Truncation");
      SolverSettings   &solver     = parameters.solver;
      solver.algorithm = (values.get("Solver/Algorithm") == "fixed point"
                            ? Algorithm::fixed_point
                            : Algorithm::gauss_seidel_like);
      const std::string correction = values.get("Solver/Coarse correction");
      solver.coarse_correction =
        (correction == "truncated"      ? CoarseCorrection::truncated
           : correction == "monotone"   ? CoarseCorrection::monotone
           : correction == "aggregates" ? CoarseCorrection::aggregates
                                        : CoarseCorrection::algebraic);
      solver.cycle = (values.get("Solver/Cycle") == "V" ? Cycle::V : Cycle::W);
      solver.truncation = (truncation == "phases" ? TruncationVariant::phases
                             : truncation == "contact"
                             ? TruncationVariant::contact
                             : TruncationVariant::phases_without_second_order);
      const std::string coarsest = values.get("Solver/Coarsest solver");
      solver.coarsest_method =
        (coarsest == "automatic"  ? CoarsestMethod::automatic
           : coarsest == "direct" ? CoarsestMethod::direct
                                  : CoarsestMethod::algebraic_multigrid);
      solver.local_solver =
        (values.get("Solver/Local solver") == "secular equation"
           ? LocalSolver::secular_equation
           : LocalSolver::uzawa);
      const auto lame_ratio = [](const Material &material) {
        return material.lambda() / material.mu();
      };
      solver.lame_ratio = lame_ratio(parameters.material);
      for (const auto &region : parameters.regions)
        solver.lame_ratio =
          std::max(solver.lame_ratio, lame_ratio(region.material));
      const unsigned int sweeps = enough_smoothing_steps(
        solver.lame_ratio, parameters.material.volumetric_strain());
      solver.smoothing_steps = values.steps("Solver/Smoothing steps", sweeps);
      solver.coarse_smoothing_steps =
        values.steps("Solver/Coarse smoothing steps", std::max(6u, sweeps));
      read_inner_tolerance(values, parameters);
      solver.outer_tolerance = values.number("Solver/Outer tolerance");
      solver.certificate_tolerance =
        values.number("Solver/Certificate tolerance");
      solver.maximum_cycles = values.integer("Solver/Maximum cycles");
      solver.total_cycles   = values.integer("Solver/Total cycles");
      solver.maximum_outer_iterations =
        values.integer("Solver/Maximum outer iterations");
      solver.maximum_step_length = values.number("Solver/Maximum step length");
      solver.recombined_steps    = values.steps(
        "Solver/Recombined steps", enough_recombined_steps(solver.lame_ratio));
      solver.outer_damping = values.number("Solver/Outer damping");
      solver.mixed_outer_iterations =
        values.integer("Solver/Mixed outer iterations");
      solver.safeguards              = values.flag("Solver/Safeguards");
      const std::string condensation = values.get("Solver/Condensation");
      solver.condensation = (condensation == "never" ? CondensationUse::never
                               : condensation == "where quicker"
                               ? CondensationUse::where_quicker
                               : CondensationUse::where_cycles_are_many);
    }

    {
      const std::string verbosity = values.get("Output/Verbosity");
      auto             &output    = parameters.output;
      output.directory            = values.get("Output/Directory");
      output.fields               = values.flag("Output/Fields");
      output.format =
        (values.get("Output/Format") == "vtu" ? FieldFormat::vtu
                                              : FieldFormat::hdf5);
      output.principal_stresses = values.flag("Output/Principal stresses");
      output.units              = read_units(values);
      output.forces             = values.flag("Output/Forces");
      output.checkpoint         = values.flag("Output/Checkpoint");
      output.verification       = values.flag("Output/Verification");
      output.times              = values.flag("Output/Times");
      output.profile            = values.flag("Output/Profile");
      output.verbosity          = (verbosity == "quiet"      ? Verbosity::quiet
                                     : verbosity == "levels" ? Verbosity::levels
                                                             : Verbosity::cycles);
      if (output.directory.empty())
        throw InputError(values.subject("Output/Directory") +
                         " is empty; name a directory.");
    }

    parameters.warnings                   = unused_entries(values);
    parameters.warnings_in_two_dimensions = entries_of_three_dimensions(values);
    warn_of_moving_obstacles(values, parameters);
    return parameters;
  }
} // namespace Friction

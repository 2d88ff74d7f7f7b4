#ifndef friction_parameters_scene_file_h
#define friction_parameters_scene_file_h

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <ostream>
#include <set>
#include <string>
#include <vector>

namespace Friction
{
  using namespace dealii;

  /**
   * What a scene file and the overrides of a command line say: the values of
   * all entries as text, and where each was set, so that an error found later
   * can still point to the place. What the text means is up to
   * read_parameters(). All errors are of type InputError.
   */
  class SceneFile
  {
  public:
    /** All entries have their defaults. */
    SceneFile();

    /** What is set from now on comes from another source, a file or an
     * override, and has the last word. Within one source an entry is set once.
     */
    void begin_source();

    /** @param path   <tt>Section/Entry</tt>.
     * @param where  a file and line, or an override: for messages. */
    void set(const std::string &path,
             const std::string &value,
             const std::string &where);

    /** The numbers of sections 'Contact 2', ... or 'Obstacle 2', ... in which
     * something has been set. */
    const std::set<unsigned int> &further_contacts() const;

    /** The text of an entry, which is its default if nothing has set it. */
    std::string get(const std::string &path);

    /** The same as a number, of at most largest_number. */
    double number(const std::string &path);

    /** The same as a positive number. */
    double positive_number(const std::string &path);

    /** The same as a number that is not negative. */
    unsigned int integer(const std::string &path);

    /** The same, where the word 'automatic' stands for a number. */
    unsigned int steps(const std::string &path, const unsigned int automatic);

    /** The same as a truth value. */
    bool flag(const std::string &path);

    /** Whether it has been set, to something else than its default. */
    bool is_changed(const std::string &path);

    /** How often values that have been set use a word, as expressions do. */
    unsigned int n_uses(const std::string &word);

    /** The same with values in whose place an override has put others. */
    unsigned int n_uses_ever(const std::string &word) const;

    /** "where: 'Section/Entry'", the beginning of a sentence. */
    std::string subject(const std::string &path) const;

    /** All entries, in the format of a scene file and without comments. */
    std::string text();

  private:
    ParameterHandler                   prm;
    std::map<std::string, std::string> origin;
    std::set<std::string>              set_by_source;
    std::set<unsigned int>             further;
    std::vector<std::string>           all_texts;

    // Names of files are no expressions.
    static bool may_use_names(const std::string &path);
  };

  /**
   * Sets what a scene file says. ParameterHandler could read the file itself,
   * but its messages neither name the nearest entry nor fit one line. The
   * format is simple enough.
   */
  void read_file(const std::string &file_name, SceneFile &values);

  /** Sets what an override says, of the form <tt>Section/Entry=value</tt>. */
  void read_override(const std::string &text, SceneFile &values);

  /** How often a word is among those of an expression. */
  unsigned int n_uses(const std::string &expression, const std::string &word);

  /**
   * Compares the parameters of two runs, each given as in Parameters::text, one
   * of which is to continue the other.
   *
   * @return the first entry that would make it another problem or another
   *   sequence of meshes, as <tt>Section/Entry</tt>; empty if there is none.
   * How to solve and what to write or print may differ, and so may how far to
   * go (number of levels, limit on unknowns), if there is a choice.
   *
   * @param may_be_refined  whether there is; in later load steps the mesh is
   *   what it is.
   */
  std::string first_difference(const std::string &text,
                               const std::string &other,
                               const bool         may_be_refined = true);

  /**
   * Print all entries with their defaults and documentation, in the format of
   * a scene file.
   */
  void print_default_parameters(std::ostream &out);
} // namespace Friction

#endif

#ifndef friction_output_left_overs_h
#define friction_output_left_overs_h

#include <common/output/run_directory.h>

#include <functional>
#include <optional>
#include <string>

namespace Friction
{
  /**
   * A file that a run may have written into its directory, as its name tells:
   * `body-05.0001.vtu` is a `body` of level 5 in a `vtu`. The history and
   * checkpoints are not among these.
   */
  struct RunFile
  {
    std::string what;               ///< `body`, `contact` or `verify`.
    std::string ending;             ///< Without the dot.
    int         level      = -1;    ///< Or -1 for a file about all levels.
    bool        unfinished = false; ///< What a run left that was killed.
  };

  /**
   * What a file is by its name, or nothing if no run makes a file of this name.
   * A history is something only if it is unfinished.
   */
  std::optional<RunFile> run_file(const std::string &name);

  /**
   * Remove files that earlier runs have left in a directory. Other files, and
   * what is no file but has its name, stay.
   *
   * Files that name others go before those, so that a run which is killed in
   * between leaves no list with something missing.
   *
   * To be called by a single process.
   *
   * @param is_left_over  says which of the files of runs.
   * @return a sentence if some could not be removed, or nothing.
   */
  std::string
  remove_left_overs(const RunDirectory                         &directory,
                    const std::function<bool(const RunFile &)> &is_left_over);
} // namespace Friction

#endif

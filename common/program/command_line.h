#ifndef friction_program_command_line_h
#define friction_program_command_line_h

#include <common/parameters/parameters.h>

#include <functional>
#include <string>

namespace Friction
{
  /// Where a run begins.
  enum class Start
  {
    anew,           ///< with the coarse mesh
    from_checkpoint ///< with the last one in the output directory
  };

  /** What a program says about itself. */
  struct Program
  {
    std::string name;
    std::string dimensions; ///< "two" or "three"
    std::string example;    ///< of a command line, without the program
  };

  /**
   * What every step program does around its work: starts MPI, answers `--help`
   * and `--parameters`, reads the scene file with `--restart` or `--check` and
   * the overrides that follow it, and turns errors into one sentence without a
   * stack trace.
   *
   * The return value is the exit status, which is part of the result:
   * - 0: all levels have been solved and certified;
   * - 1: some level has not, or the last one is no solution, see
   *   check_solution(); its results are there to be looked at, but not to be
   *   believed;
   * - 2: the input was at fault, or what it asks for cannot be written;
   * - 3: what should never happen.
   *
   * With several processes only the first one prints. An InputError has to
   * reach all of them, see on_all_processes(). Any other exception may be that
   * of one process while the others wait for its data, so that it ends all of
   * them at once, with the same status 3.
   *
   * @param run  does the work and says whether there is a solution.
   */
  int
  run_program(int            argc,
              char         **argv,
              const Program &program,
              const std::function<bool(const Parameters &, const Start)> &run);
} // namespace Friction

#endif

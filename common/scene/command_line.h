#ifndef friction_scene_command_line_h
#define friction_scene_command_line_h

#include <common/scene/parameters.h>

#include <functional>
#include <string>

namespace Friction
{
  /**
   * What every step program does around its work: starts MPI, answers `--help`
   * and `--parameters`, reads the scene file with the overrides that follow it,
   * and turns errors into one sentence without a stack trace.
   *
   * The return value is the exit status, which is part of the result:
   * - 0: all levels have been solved and certified;
   * - 1: some level has not; its results are there to be looked at, but not to
   *   be believed;
   * - 2: the input was at fault;
   * - 3: what should never happen.
   *
   * @param program     the name of the program.
   * @param dimensions  "two" or "three".
   * @param example     an example of a command line, without the program.
   * @param run         does the work and says whether all levels were solved.
   */
  int run_program(int                                            argc,
                  char                                         **argv,
                  const std::string                             &program,
                  const std::string                             &dimensions,
                  const std::string                             &example,
                  const std::function<bool(const Parameters &)> &run);
} // namespace Friction

#endif

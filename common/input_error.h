#ifndef friction_input_error_h
#define friction_input_error_h

#include <stdexcept>
#include <string>

namespace Friction
{
  /**
   * Something is wrong with what the user gave us: a scene file, a command
   * line override, a mesh, a disk that is full. what() is one sentence for the
   * user, saying what is wrong, where, and what to do about it. Everything else
   * that goes wrong is an error of the program and is reported in another way.
   *
   * With several processes, see on_all_processes().
   */
  class InputError : public std::runtime_error
  {
  public:
    explicit InputError(const std::string &sentence)
      : std::runtime_error(sentence)
    {}
  };
} // namespace Friction

#endif

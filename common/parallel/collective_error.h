#ifndef friction_parallel_collective_error_h
#define friction_parallel_collective_error_h

#include <common/input_error.h>

#include <deal.II/base/mpi.h>

#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace Friction
{
  /**
   * Agree on whether some process has met an error, and if so throw the
   * InputError of the lowest of these processes on all of them. A collective
   * operation.
   *
   * @param sentence  the error of this process, or nothing.
   */
  void throw_if_any(const MPI_Comm                    communicator,
                    const std::optional<std::string> &sentence);

  /**
   * What one process meets in the middle of a collective operation of another
   * library, an MPI file for example, cannot be agreed on, because the others
   * wait there. Prints the sentence and ends all processes, with the exit
   * status of bad input. With one process an InputError is thrown.
   */
  [[noreturn]] void throw_or_abort(const MPI_Comm     communicator,
                                   const std::string &sentence);

  /**
   * Run @p f on all processes. An InputError that it throws on some of them is
   * thrown on all, with the same sentence. Without this the others would go on
   * to their next exchange of data, and wait there forever.
   *
   * This is a collective operation, but @p f must not be one: a process that
   * throws halfway would never get to the exchanges that the others are waiting
   * in. Exceptions of other kinds are passed on at once, by the one process
   * that meets them; they end the whole program, see run_program().
   *
   * @return what @p f returns.
   */
  template <typename F>
  std::invoke_result_t<F>
  on_all_processes(const MPI_Comm communicator, F &&f)
  {
    using Result = std::invoke_result_t<F>;
    std::optional<std::string> error;
    if constexpr (std::is_void_v<Result>)
      {
        try
          {
            f();
          }
        catch (const InputError &exception)
          {
            error = exception.what();
          }
        throw_if_any(communicator, error);
      }
    else
      {
        std::optional<Result> result;
        try
          {
            result.emplace(f());
          }
        catch (const InputError &exception)
          {
            error = exception.what();
          }
        throw_if_any(communicator, error);
        return std::move(*result);
      }
  }

  /**
   * The same for what only the first process does, writing a file that all of
   * them share for example. The others wait until it is done.
   */
  template <typename F>
  void
  on_first_process(const MPI_Comm communicator, F &&f)
  {
    on_all_processes(communicator, [&]() {
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
        f();
    });
  }
} // namespace Friction

#endif

// An InputError that one process meets is met by all, with the same sentence,
// and no process waits for another: what comes after it is collective again.

#include <common/parallel/collective_error.h>

#include <iostream>

#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;

namespace test_collective_error
{
  // What each process has caught, in the order of their ranks.
  template <typename Function>
  void
  try_to(const std::string &name, const Function &function)
  {
    std::string caught = "nothing";
    try
      {
        function();
      }
    catch (const InputError &error)
      {
        caught = error.what();
      }
    const auto all = Utilities::MPI::gather(MPI_COMM_WORLD, caught);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      {
        std::cout << name << std::endl;
        for (const std::string &sentence : all)
          std::cout << "  " << sentence << std::endl;
      }
  }
} // namespace test_collective_error



TEST(collective_error)
{
  const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int last = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) - 1;

  try_to("no error", [&]() { on_all_processes(MPI_COMM_WORLD, []() {}); });
  try_to("an error of the last process", [&]() {
    on_all_processes(MPI_COMM_WORLD, [&]() {
      if (rank == last)
        throw InputError("The disk of process " + std::to_string(rank) +
                         " is full.");
    });
  });
  try_to("an error of all processes", [&]() {
    on_all_processes(MPI_COMM_WORLD, [&]() {
      throw InputError("The disk of process " + std::to_string(rank) +
                       " is full.");
    });
  });
  try_to("an error of the first process", [&]() {
    on_first_process(MPI_COMM_WORLD, []() {
      throw InputError("The only file is write-protected.");
    });
  });

  // What was computed is returned, by each process its own.
  const unsigned int sum = Utilities::MPI::sum(
    on_all_processes(MPI_COMM_WORLD, [&]() { return rank + 1; }),
    MPI_COMM_WORLD);
  if (rank == 0)
    std::cout << "sum of what was returned " << sum << std::endl;
}

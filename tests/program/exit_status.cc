// A program that does nothing but end in the way that MODE says, on its last
// process; the others wait for it. See exit_status.sh.

#include <common/parallel/collective_error.h>
#include <common/program/command_line.h>

#include <cstdlib>
#include <string>

int
main(int argc, char *argv[])
{
  using namespace Friction;
  return run_program(
    argc,
    argv,
    {"exit_status", "two", "block.prm"},
    [](const Parameters &, const Start start) {
      const std::string mode = std::getenv("MODE");
      const bool        last =
        dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) + 1 ==
        dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
      if (mode == "restart")
        return start == Start::from_checkpoint;
      if (mode == "input")
        on_all_processes(MPI_COMM_WORLD, [&]() {
          if (last)
            throw InputError("The last process cannot read its file.");
        });
      if (mode == "unexpected" && last)
        throw std::runtime_error("the last process is lost");
      MPI_Barrier(MPI_COMM_WORLD);
      return mode == "solved";
    });
}

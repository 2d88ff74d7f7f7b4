// A program with three checks. If it is told so, the second fails, or the third
// for the last of several processes only. See failed_check.sh.

#include <deal.II/base/mpi.h>

#include <tests/support/check.h>

#include <string>

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int                       n =
    dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const unsigned int rank =
    dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const std::string wrong = argc > 1 ? argv[1] : "";
  Tests::check(true, "one is one");
  Tests::check_below(wrong == "own" && rank == n - 1 ? 3e-13 : 1e-13,
                     2e-13,
                     "rounding of the last process");
  Tests::check_everywhere(!(wrong == "everywhere" && rank == n - 1),
                          "what all processes have to agree on");
  return 0;
}

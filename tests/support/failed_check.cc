// A program with two checks, of which the second fails, in one process only if
// it is told so. See failed_check.sh.

#include <deal.II/base/mpi.h>

#include <tests/support/check.h>

int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int                       n =
    dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const unsigned int rank =
    dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  Tests::check(true, "one is one");
  Tests::check_below(argc > 1 && rank == n - 1 ? 3e-13 : 1e-13,
                     2e-13,
                     "rounding of the last process");
  return 0;
}

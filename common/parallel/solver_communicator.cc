#include <common/parallel/solver_communicator.h>

#include <exception>

namespace Friction
{
  SolverCommunicator::SolverCommunicator(const MPI_Comm original)
  {
    MPI_Comm_dup(original, &communicator);
    account.attach(communicator);
  }



  SolverCommunicator::~SolverCommunicator()
  {
    if (std::uncaught_exceptions() == 0)
      MPI_Comm_free(&communicator);
  }
} // namespace Friction

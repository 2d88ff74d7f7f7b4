#ifndef friction_parallel_solver_communicator_h
#define friction_parallel_solver_communicator_h

#include <common/parallel/phase_costs.h>

#include <deal.II/base/mpi.h>

namespace Friction
{
  /**
   * The communicator of one discrete problem: a duplicate of that of the mesh,
   * so that the library's messages never meet those of the program around it,
   * and an account of what is sent.
   *
   * The account travels with the communicator, as an attribute of MPI. Whatever
   * gets the communicator, an exchange of ghosts or a sum over all processes,
   * counts what it sends without being handed anything else; see
   * phase_costs.h. Communicators without an account can be used as well, and
   * then nothing is counted.
   */
  class SolverCommunicator
  {
  public:
    /** Collective. */
    explicit SolverCommunicator(const MPI_Comm original);

    /** Collective, but for a process on which an exception is on its way: it
     * does not wait for the others. */
    ~SolverCommunicator();

    SolverCommunicator(const SolverCommunicator &)            = delete;
    SolverCommunicator &operator=(const SolverCommunicator &) = delete;

    MPI_Comm
    get() const
    {
      return communicator;
    }

  private:
    MPI_Comm    communicator;
    CostAccount account;
  };
} // namespace Friction

#endif

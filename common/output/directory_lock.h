#ifndef friction_output_directory_lock_h
#define friction_output_directory_lock_h

#include <deal.II/base/mpi.h>

#include <common/output/run_directory.h>

#include <string>

namespace Friction
{
  /**
   * As long as an object of this class exists, its run is the only one that
   * writes into a directory. What other runs ask is the operating system, which
   * forgets about the lock of a process that has ended, in whatever way: a run
   * that was killed keeps no other out by its file `.lock`. The file says which
   * run has it, for the sentence that another run then ends with.
   */
  class DirectoryLock
  {
  public:
    /**
     * Lock a directory on behalf of all processes; the first one does it.
     * Collective. Throws an InputError that says who has it if another run
     * does, on this or another machine.
     */
    DirectoryLock(const RunDirectory &directory, const MPI_Comm communicator);

    /// Removes the file.
    ~DirectoryLock();

    DirectoryLock(const DirectoryLock &)            = delete;
    DirectoryLock &operator=(const DirectoryLock &) = delete;

    /**
     * On the first process a sentence if the file system knows no locks, as
     * some network file systems do: then runs have to keep out of each other's
     * way by themselves. Otherwise nothing.
     */
    const std::string &warning() const;

  private:
    void lock(const std::string &directory);

    const std::string file;
    int               descriptor = -1;
    std::string       sentence;
  };
} // namespace Friction

#endif

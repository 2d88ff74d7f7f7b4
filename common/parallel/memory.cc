#include <common/parallel/memory.h>

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace Friction
{
  namespace
  {
    // The first number of a file, or none.
    double
    number_in(const std::string &file_name)
    {
      std::ifstream file(file_name);
      double        value = 0;
      return file >> value ? value : -1.;
    }



    double
    free_memory()
    {
      std::ifstream file("/proc/meminfo");
      std::string   name, unit;
      double        value = 0, free = 0;
      while (file >> name >> value)
        {
          std::getline(file, unit);
          if (name == "MemAvailable:")
            free = 1024. * value;
        }
      // Containers and job schedulers set limits of their own.
      const double limit = number_in("/sys/fs/cgroup/memory.max");
      const double used  = number_in("/sys/fs/cgroup/memory.current");
      if (free > 0 && limit > 0 && used >= 0)
        free = std::min(free, std::max(0., limit - used));
      return free;
    }



    double
    own_memory()
    {
      std::ifstream file("/proc/self/statm");
      double        total = 0, resident = 0;
      file >> total >> resident;
      return resident * ::sysconf(_SC_PAGESIZE);
    }
  } // namespace



  double
  memory_within_reach(const MPI_Comm communicator)
  {
    // One process of each machine asks what is free there.
    MPI_Comm machine;
    MPI_Comm_split_type(
      communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    const bool is_first =
      dealii::Utilities::MPI::this_mpi_process(machine) == 0;
    MPI_Comm_free(&machine);

    const double free    = is_first ? free_memory() : 0.;
    const bool   unknown = dealii::Utilities::MPI::max(
                           is_first && free == 0. ? 1 : 0, communicator) > 0;
    const double sum =
      dealii::Utilities::MPI::sum(free + own_memory(), communicator);
    return unknown ? 0. : sum;
  }
} // namespace Friction

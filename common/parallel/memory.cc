#include <common/parallel/memory.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

namespace Friction
{
  namespace
  {
    // The first number of a file, or none; "max" is none.
    double
    number_in(const std::string &file_name)
    {
      std::ifstream file(file_name);
      double        value = 0;
      return file >> value ? value : -1.;
    }



    // The number after a name at the beginning of a line, or none.
    double
    number_after(const std::string &name, const std::string &file_name)
    {
      std::ifstream file(file_name);
      std::string   line;
      while (std::getline(file, line))
        {
          std::istringstream words(line);
          std::string        first;
          double             value = 0;
          if (words >> first >> value && first == name)
            return value;
        }
      return -1.;
    }



    // Infinite if the system does not say.
    double
    free_memory()
    {
      std::ifstream file("/proc/meminfo");
      std::string   name, unit;
      double        value = 0, free = std::numeric_limits<double>::infinity();
      while (file >> name >> value)
        {
          std::getline(file, unit);
          if (name == "MemAvailable:")
            free = 1024. * value;
        }
      // Containers and job schedulers set limits of their own.
      return std::min(free, memory_left_to_group("/sys/fs/cgroup"));
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
  memory_left_to_group(const std::string &folder)
  {
    double left = std::numeric_limits<double>::infinity();
    for (const bool is_first_version : {false, true})
      {
        const std::string here = folder + (is_first_version ? "/memory/" : "/");
        const double      limit = number_in(
          here + (is_first_version ? "memory.limit_in_bytes" : "memory.max"));
        const double used = number_in(
          here +
          (is_first_version ? "memory.usage_in_bytes" : "memory.current"));
        const double unused_files = number_after(
          is_first_version ? "total_inactive_file" : "inactive_file",
          here + "memory.stat");
        if (limit <= 0.)
          continue;
        const bool is_known = used >= 0. && unused_files >= 0.;
        left                = std::min(
          left,
          is_known ? std::max(0., limit - std::max(0., used - unused_files))
                                  : limit);
      }
    return left;
  }



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

    const double free = is_first ? free_memory() : 0.;
    const bool   unknown =
      dealii::Utilities::MPI::max(std::isinf(free) ? 1 : 0, communicator) > 0;
    const double sum =
      dealii::Utilities::MPI::sum(free + own_memory(), communicator);
    return unknown ? 0. : sum;
  }
} // namespace Friction

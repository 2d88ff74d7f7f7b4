#include <common/parallel/reductions.h>

#include <deal.II/base/exceptions.h>

#include <limits>
#include <numeric>

namespace Friction
{
  std::vector<char>
  gather_bytes_from_all(const char       *own,
                        const std::size_t size,
                        const MPI_Comm    comm)
  {
    // MPI counts with integers. Where that is not enough, all processes find
    // it out, or one would wait for another.
    const unsigned long long        n_own = size;
    std::vector<unsigned long long> all_sizes(
      dealii::Utilities::MPI::n_mpi_processes(comm));
    MPI_Allgather(&n_own,
                  1,
                  MPI_UNSIGNED_LONG_LONG,
                  all_sizes.data(),
                  1,
                  MPI_UNSIGNED_LONG_LONG,
                  comm);
    AssertThrow(std::accumulate(all_sizes.begin(), all_sizes.end(), 0ULL) <=
                  static_cast<unsigned int>(std::numeric_limits<int>::max()),
                dealii::ExcMessage("This is too much for one message."));
    const std::vector<int> sizes(all_sizes.begin(), all_sizes.end());
    std::vector<int>       starts(sizes.size(), 0);
    std::partial_sum(sizes.begin(), sizes.end() - 1, starts.begin() + 1);
    std::vector<char> all(starts.back() + sizes.back());
    MPI_Allgatherv(own,
                   int(size),
                   MPI_CHAR,
                   all.data(),
                   sizes.data(),
                   starts.data(),
                   MPI_CHAR,
                   comm);
    return all;
  }
} // namespace Friction

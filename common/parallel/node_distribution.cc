#include <common/parallel/node_distribution.h>

#include <algorithm>
#include <numeric>

namespace Friction
{
  NodeDistribution::NodeDistribution(
    const unsigned int                               n_owned,
    const std::shared_ptr<const SolverCommunicator> &communicator)
    : shared_comm(communicator)
    , my_rank(Utilities::MPI::this_mpi_process(communicator->get()))
    , starts(1, 0)
  {
    for (const unsigned int n :
         Utilities::MPI::all_gather(communicator->get(), n_owned))
      starts.push_back(starts.back() + n);
  }



  unsigned int
  NodeDistribution::owner(const GlobalNode node) const
  {
    return std::upper_bound(starts.begin(), starts.end(), node) -
      starts.begin() - 1;
  }



  unsigned int
  NodeNumbering::add(const GlobalNode node)
  {
    if (nodes.is_owned(node))
      return nodes.local(node);
    const auto entry = local_of_ghost.emplace(node, size());
    if (entry.second)
      ghosts.push_back(node);
    return entry.first->second;
  }



  std::vector<unsigned int>
  NodeNumbering::all_ghosts() const
  {
    std::vector<unsigned int> numbers(ghosts.size());
    std::iota(numbers.begin(), numbers.end(), nodes.n_owned());
    return numbers;
  }
} // namespace Friction

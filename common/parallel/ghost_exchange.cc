#include <common/parallel/ghost_exchange.h>
#include <common/parallel/phase_costs.h>

#include <algorithm>
#include <map>
#include <utility>

namespace Friction
{
  namespace
  {
    // Messages between the same two processes keep their order, so that one tag
    // is enough on a communicator that only the discrete problem uses.
    constexpr int tag = 4711;
  } // namespace



  GhostExchange::GhostExchange(const NodeNumbering             &numbering,
                               const std::vector<unsigned int> &ghosts)
    : comm(numbering.distribution().communicator())
  {
    const NodeDistribution &distribution = numbering.distribution();
    if (distribution.n_processes() == 1)
      return;

    std::map<unsigned int, std::vector<GlobalNode>> wanted;
    std::map<unsigned int, Neighbour>               by_rank;
    for (const unsigned int ghost : ghosts)
      {
        const GlobalNode   node = numbering.global(ghost);
        const unsigned int rank = distribution.owner(node);
        Assert(rank != distribution.rank(), ExcInternalError());
        wanted[rank].push_back(node);
        by_rank[rank].ghosts.push_back(ghost);
      }
    for (const auto &request : Utilities::MPI::some_to_some(comm, wanted))
      for (const GlobalNode node : request.second)
        by_rank[request.first].owned.push_back(distribution.local(node));

    for (auto &entry : by_rank)
      {
        entry.second.rank = entry.first;
        neighbours.push_back(std::move(entry.second));
      }
  }



  GhostExchange::GhostExchange(GhostExchange &&other) noexcept
  {
    *this = std::move(other);
  }



  GhostExchange &
  GhostExchange::operator=(GhostExchange &&other) noexcept
  {
    Assert(requests.empty() && other.requests.empty(),
           ExcMessage("An exchange cannot be moved while it is under way."));
    comm       = other.comm;
    neighbours = std::move(other.neighbours);
    n_values   = other.n_values;
    return *this;
  }



  // Sends the values of one list of nodes, and gets ready for those of the
  // other.
  void
  GhostExchange::communicate(const double      *values,
                             const unsigned int values_per_node,
                             const bool         to_owners)
  {
    Assert(requests.empty(), ExcMessage("The last exchange is not finished."));
    n_values = values_per_node;
    for (Neighbour &n : neighbours)
      {
        const auto &expected = to_owners ? n.owned : n.ghosts;
        n.received.resize(n_values * expected.size());
        if (!n.received.empty())
          {
            requests.emplace_back();
            MPI_Irecv(n.received.data(),
                      n.received.size(),
                      MPI_DOUBLE,
                      n.rank,
                      tag,
                      comm,
                      &requests.back());
          }
      }
    for (Neighbour &n : neighbours)
      {
        const auto &nodes = to_owners ? n.ghosts : n.owned;
        n.to_send.resize(n_values * nodes.size());
        double *target = n.to_send.data();
        for (const unsigned int node : nodes)
          target =
            std::copy_n(values + static_cast<std::size_t>(n_values) * node,
                        n_values,
                        target);
        if (!n.to_send.empty())
          {
            count_message(comm, n.to_send.size() * sizeof(double));
            requests.emplace_back();
            MPI_Isend(n.to_send.data(),
                      n.to_send.size(),
                      MPI_DOUBLE,
                      n.rank,
                      tag,
                      comm,
                      &requests.back());
          }
      }
  }



  void
  GhostExchange::wait()
  {
    if (!requests.empty())
      {
        const WaitingScope waiting(comm);
        MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
      }
    requests.clear();
  }



  void
  GhostExchange::start(const double *values, const unsigned int values_per_node)
  {
    communicate(values, values_per_node, false);
  }



  bool
  GhostExchange::arrived()
  {
    int flag = 1;
    if (!requests.empty())
      MPI_Testall(requests.size(), requests.data(), &flag, MPI_STATUSES_IGNORE);
    return flag != 0;
  }



  void
  GhostExchange::finish(double *values)
  {
    wait();
    for (const Neighbour &n : neighbours)
      {
        const double *source = n.received.data();
        for (const unsigned int node : n.ghosts)
          {
            std::copy_n(source,
                        n_values,
                        values + static_cast<std::size_t>(n_values) * node);
            source += n_values;
          }
      }
  }



  void
  GhostExchange::collect(double            *values,
                         const unsigned int values_per_node,
                         const Combine      combine)
  {
    communicate(values, values_per_node, true);
    wait();
    for (const Neighbour &n : neighbours)
      {
        const double *source = n.received.data();
        for (const unsigned int node : n.owned)
          for (unsigned int d = 0; d < n_values; ++d, ++source)
            {
              double &value =
                values[static_cast<std::size_t>(n_values) * node + d];
              value = combine == Combine::add ? value + *source
                : combine == Combine::minimum ? std::min(value, *source)
                                              : std::max(value, *source);
            }
      }
  }
} // namespace Friction

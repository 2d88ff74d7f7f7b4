#ifndef friction_parallel_node_distribution_h
#define friction_parallel_node_distribution_h

#include <common/parallel/solver_communicator.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/types.h>

#include <memory>
#include <unordered_map>
#include <vector>

namespace Friction
{
  using namespace dealii;

  /** The number of a node among those of all processes. */
  using GlobalNode = types::global_dof_index;

  /**
   * Which process owns which nodes: each a range of consecutive numbers, in the
   * order of the processes.
   */
  class NodeDistribution
  {
  public:
    NodeDistribution() = default;

    /** Collective: each process says how many it owns. */
    NodeDistribution(
      const unsigned int                               n_owned,
      const std::shared_ptr<const SolverCommunicator> &communicator);

    MPI_Comm
    communicator() const
    {
      return shared_comm ? shared_comm->get() : MPI_COMM_SELF;
    }

    /** For other distributions of the same problem. */
    const std::shared_ptr<const SolverCommunicator> &
    shared_communicator() const
    {
      return shared_comm;
    }

    unsigned int
    rank() const
    {
      return my_rank;
    }

    unsigned int
    n_processes() const
    {
      return starts.size() - 1;
    }

    unsigned int
    n_owned() const
    {
      return starts[my_rank + 1] - starts[my_rank];
    }

    /** The number of nodes of all processes. */
    GlobalNode
    n_global() const
    {
      return starts.back();
    }

    bool
    is_owned(const GlobalNode node) const
    {
      return node >= starts[my_rank] && node < starts[my_rank + 1];
    }

    /** The local number of an owned node. */
    unsigned int
    local(const GlobalNode node) const
    {
      return node - starts[my_rank];
    }

    GlobalNode
    global(const unsigned int owned_node) const
    {
      return starts[my_rank] + owned_node;
    }

    /** The rank of the process that owns a node. */
    unsigned int owner(const GlobalNode node) const;

  private:
    std::shared_ptr<const SolverCommunicator> shared_comm;
    unsigned int                              my_rank = 0;
    std::vector<GlobalNode>                   starts  = {0, 0};
  };



  /**
   * Local numbers of nodes: those of the process come first, and then ghosts,
   * nodes of others of which it holds a copy, in the order in which they
   * were asked for.
   */
  class NodeNumbering
  {
  public:
    NodeNumbering() = default;

    explicit NodeNumbering(const NodeDistribution &distribution)
      : nodes(distribution)
    {}

    const NodeDistribution &
    distribution() const
    {
      return nodes;
    }

    unsigned int
    n_owned() const
    {
      return nodes.n_owned();
    }

    /** Owned nodes and ghosts. */
    unsigned int
    size() const
    {
      return nodes.n_owned() + ghosts.size();
    }

    /** The local number of a node; if need be the node becomes a ghost. */
    unsigned int add(const GlobalNode node);

    /** The local numbers of all ghosts. */
    std::vector<unsigned int> all_ghosts() const;

    GlobalNode
    global(const unsigned int node) const
    {
      return node < nodes.n_owned() ? nodes.global(node)
                                    : ghosts[node - nodes.n_owned()];
    }

    std::size_t
    memory_consumption() const
    {
      return ghosts.capacity() * sizeof(GlobalNode) +
        local_of_ghost.size() * 4 * sizeof(GlobalNode);
    }

  private:
    NodeDistribution                             nodes;
    std::vector<GlobalNode>                      ghosts;
    std::unordered_map<GlobalNode, unsigned int> local_of_ghost;
  };
} // namespace Friction

#endif

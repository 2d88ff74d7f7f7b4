#ifndef friction_parallel_ghost_exchange_h
#define friction_parallel_ghost_exchange_h

#include <common/parallel/node_distribution.h>

#include <vector>

namespace Friction
{
  /**
   * Keeps copies of other processes' nodes up to date: one message to each
   * neighbour and one from it, of the values of all nodes that it has asked
   * for.
   *
   * Vectors enter as plain pointers to their local values, node by node, owned
   * nodes first. The exchange can be split in two, so that there is work to be
   * done while messages are on their way. With one process, or without ghosts,
   * nothing happens.
   *
   * Why not the vectors' own update_ghost_values()? Different parts of the
   * method need different ghosts of the same vector: a sweep those that a row
   * couples to, a transfer the parents. And communication is to be counted.
   */
  class GhostExchange
  {
  public:
    GhostExchange() = default;

    // A message on its way has an address to go to.
    GhostExchange(const GhostExchange &)            = delete;
    GhostExchange &operator=(const GhostExchange &) = delete;
    GhostExchange(GhostExchange &&other) noexcept;
    GhostExchange &operator=(GhostExchange &&other) noexcept;

    /**
     * Collective.
     * @param numbering  gives ghosts their places in vectors.
     * @param ghosts     local numbers of the ghosts to be kept up to date.
     */
    GhostExchange(const NodeNumbering             &numbering,
                  const std::vector<unsigned int> &ghosts);

    /** Sends the values of owned nodes, which may change after that. */
    void start(const double *values, const unsigned int values_per_node);

    /** Whether finish() would not have to wait. */
    bool arrived();

    /** Waits for the values of the ghosts and puts them into their places. */
    void finish(double *values);

    /** Both at once. */
    void
    update(double *values, const unsigned int values_per_node)
    {
      start(values, values_per_node);
      finish(values);
    }

    /** How values that several processes have for a node become one. */
    enum class Combine
    {
      add,
      minimum,
      maximum
    };

    /** The way back: values at ghosts are combined with those of their owners,
     * in the order of the processes. Values at ghosts stay as they are. */
    void collect(double            *values,
                 const unsigned int values_per_node,
                 const Combine      combine);

    /** No ghosts on this process, and no process has its nodes as ghosts. */
    bool
    is_empty() const
    {
      return neighbours.empty();
    }

  private:
    struct Neighbour
    {
      unsigned int              rank;
      std::vector<unsigned int> owned;  ///< nodes that it wants from us
      std::vector<unsigned int> ghosts; ///< nodes that we want from it
      std::vector<double>       to_send, received;
    };

    MPI_Comm                 comm = MPI_COMM_SELF;
    std::vector<Neighbour>   neighbours;
    std::vector<MPI_Request> requests;
    unsigned int             n_values = 0;

    void communicate(const double      *values,
                     const unsigned int values_per_node,
                     const bool         to_owners);

    void wait();
  };
} // namespace Friction

#endif

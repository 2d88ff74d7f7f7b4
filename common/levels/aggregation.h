#ifndef friction_levels_aggregation_h
#define friction_levels_aggregation_h

#include <cstddef>
#include <limits>
#include <vector>

namespace Friction
{
  /** Which nodes are strongly coupled, in compressed row storage: the
   * neighbours of node i are neighbours[starts[i]], ..., without itself. */
  struct StrongCouplings
  {
    std::vector<std::size_t>  starts = {0}; ///< n_nodes + 1 of them
    std::vector<unsigned int> neighbours;

    unsigned int
    n_nodes() const
    {
      return starts.size() - 1;
    }
  };



  /**
   * Nodes in groups of strongly coupled neighbours, each of which becomes one
   * node of a coarser level.
   */
  struct Aggregation
  {
    static constexpr unsigned int none =
      std::numeric_limits<unsigned int>::max();

    std::vector<unsigned int> group_of; ///< of each node, or none
    unsigned int              n_groups = 0;
  };

  /**
   * The groups of Vanek, Mandel and Brezina (1996): first whole neighbourhoods
   * that do not overlap, then what is left goes to a group beside it, and then
   * into groups of its own. Nodes without strong couplings are in none.
   */
  Aggregation aggregate(const StrongCouplings &couplings);
} // namespace Friction

#endif

#ifndef friction_nodes_elimination_tree_h
#define friction_nodes_elimination_tree_h

#include <common/nodes/node_block_matrix.h>
#include <common/nodes/places.h>

#include <vector>

namespace Friction
{
  /**
   * In which order nodes are eliminated from a sparse matrix, and what that
   * makes dense: nested dissection (George 1973) for the multifrontal method
   * (Duff and Reid 1983).
   *
   * The nodes are divided again and again by a plane through their middle,
   * across one of the coordinates. Those on one side of it that are coupled to
   * the other side are the separator, which is eliminated after both parts. Of
   * the three planes that one is taken whose separator has the fewest nodes.
   * Chosen nodes are not eliminated at all.
   *
   * A front is what is eliminated together: its own nodes, and its border,
   * those nodes that they, or the fronts below, are coupled to by then, to be
   * eliminated later or never.
   */
  class EliminationTree
  {
  public:
    struct Front
    {
      /// Both are sorted by the order of elimination.
      std::vector<unsigned int> nodes, border;

      /// Fronts whose borders are to be added to this one.
      std::vector<unsigned int> children;
    };

    /**
     * @param pattern    of the matrix, all of whose rows are there.
     * @param positions  of the nodes; in two dimensions the third coordinate
     *                   is zero.
     * @param is_kept    the nodes that are not eliminated.
     * @param is_absent  nodes that take no part: they are held, or have no
     *                   couplings.
     */
    EliminationTree(const NodePattern       &pattern,
                    const Places            &positions,
                    const std::vector<char> &is_kept,
                    const std::vector<char> &is_absent);

    /** In the order of elimination, children before parents. The last one is
     * that of the nodes that are kept; it has no border. */
    const std::vector<Front> &
    fronts() const
    {
      return all_fronts;
    }

    /** How many multiplications it takes to eliminate the nodes, of
     * @p n_components unknowns each. */
    double cost(const unsigned int n_components) const;

  private:
    const NodePattern &pattern;
    const Places      &positions;
    std::vector<Front> all_fronts;

    // Which part of the body a node belongs to, while that is divided.
    std::vector<unsigned int> part;
    unsigned int              n_parts = 0;

    struct Division
    {
      std::vector<unsigned int> below, above, between;
    };

    std::vector<unsigned int> dissect(const std::vector<unsigned int> &nodes);

    Division divide(const std::vector<unsigned int> &nodes,
                    const unsigned int               along);

    unsigned int add_front(std::vector<unsigned int> nodes,
                           std::vector<unsigned int> children);

    void find_borders();
  };
} // namespace Friction

#endif

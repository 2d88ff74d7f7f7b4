#ifndef friction_nodes_leaf_node_h
#define friction_nodes_leaf_node_h

#include <deal.II/base/types.h>

namespace Friction
{
  /**
   * The local number of a node of the leaf mesh, where numbers of level nodes
   * are at hand as well: neither turns into the other without being told to.
   */
  class LeafNode
  {
  public:
    /** No node. */
    LeafNode() = default;

    explicit LeafNode(const unsigned int number)
      : the_number(number)
    {}

    bool
    exists() const
    {
      return the_number != dealii::numbers::invalid_unsigned_int;
    }

    unsigned int
    number() const
    {
      return the_number;
    }

  private:
    unsigned int the_number = dealii::numbers::invalid_unsigned_int;
  };
} // namespace Friction

#endif

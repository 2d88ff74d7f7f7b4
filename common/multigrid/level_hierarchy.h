#ifndef friction_multigrid_level_hierarchy_h
#define friction_multigrid_level_hierarchy_h

#include <common/contact/nodal_constraints.h>
#include <common/multigrid/node_block_matrix.h>

#include <deal.II/dofs/dof_handler.h>

#include <vector>

namespace Friction
{
  /**
   * A sparse matrix of scalar weights between nodes, in compressed row storage;
   * it acts on each component of the node values alike.
   */
  class NodeWeights
  {
  public:
    struct Entry
    {
      unsigned int node;
      double       weight;
    };

    NodeWeights() = default;

    explicit NodeWeights(const std::vector<std::vector<Entry>> &rows);

    /** The same weights with rows and columns exchanged. */
    NodeWeights transposed(const unsigned int n_columns) const;

    unsigned int
    n_rows() const
    {
      return starts.size() - 1;
    }

    const Entry *
    begin(const unsigned int row) const
    {
      return row < n_rows() ? entries.data() + starts[row] : nullptr;
    }

    const Entry *
    end(const unsigned int row) const
    {
      return row < n_rows() ? entries.data() + starts[row + 1] : nullptr;
    }

    std::size_t
    memory_consumption() const
    {
      return starts.capacity() * sizeof(unsigned int) +
        entries.capacity() * sizeof(Entry);
    }

  private:
    std::vector<unsigned int> starts = {0};
    std::vector<Entry>        entries;
  };



  /**
   * The levels of a DoFHandler, seen nodewise.
   *
   * The leaf mesh with its hanging nodes is one space, the level meshes are
   * others; a node of one is the same vertex as a node of the other. For each
   * leaf node, @p finest_level is the finest level that has it as a node,
   * called $f(p)$ below: that is where its residual enters the levels and where
   * its correction is read off.
   *
   * The leaf space has its own smoother, the leading relaxation. Correction
   * levels are therefore only 0,...,n_levels()-2; the finest level merely
   * passes residuals down and corrections up.
   */
  template <int dim>
  class LevelHierarchy
  {
  public:
    /** One level; all node numbers not said to be leaf nodes are level nodes.
     */
    class Level
    {
    public:
      unsigned int
      n_nodes() const
      {
        return leaf_nodes.size();
      }

      /** The leaf node at the same vertex. */
      unsigned int
      leaf_node(const unsigned int node) const
      {
        return leaf_nodes[node];
      }

      /** The node at the same vertex as a leaf node, or invalid_unsigned_int.
       */
      unsigned int
      node_of_leaf(const unsigned int leaf_node) const
      {
        return nodes_of_leaf[leaf_node];
      }

      /** Nodes whose finest level this is, and which do not hang. */
      const std::vector<unsigned int> &
      own_nodes() const
      {
        return own;
      }

      /** The weights of the next coarser nodes in the value at each node. */
      const NodeWeights &
      parents() const
      {
        return parent_weights;
      }

      /** The transpose: the next finer nodes that each node has a share in. */
      const NodeWeights &
      children() const
      {
        return child_weights;
      }

      /**
       * The nodes to be relaxed: not at the refinement edge, where the level's
       * functions do not belong to the leaf space; touching a refined cell,
       * since otherwise the function is one of the leaf space and has been
       * relaxed there; and not entirely prescribed.
       */
      const NodeRanges &
      relaxed_nodes() const
      {
        return relaxed;
      }

      bool
      is_refinement_edge(const unsigned int node) const
      {
        return edge[node];
      }

    private:
      std::vector<unsigned int> leaf_nodes, nodes_of_leaf, own;
      NodeWeights               parent_weights, child_weights;
      NodeRanges                relaxed;
      std::vector<char>         edge;

      friend class LevelHierarchy<dim>;
    };

    /**
     * @param dof_handler  with leaf and level degrees of freedom.
     */
    LevelHierarchy(const DoFHandler<dim>       &dof_handler,
                   const NodalConstraints<dim> &constraints);

    unsigned int
    n_levels() const
    {
      return levels.size();
    }

    const Level &
    level(const unsigned int k) const
    {
      return levels[k];
    }

    /** The finest level $f$ that a leaf node is a node of. */
    unsigned int
    finest_level(const unsigned int leaf_node) const
    {
      return finest_levels[leaf_node];
    }

    std::size_t memory_consumption() const;

  private:
    std::vector<Level>         levels;
    std::vector<unsigned char> finest_levels;
  };
} // namespace Friction

#endif

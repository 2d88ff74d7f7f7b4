#ifndef friction_levels_level_hierarchy_h
#define friction_levels_level_hierarchy_h

#include <common/nodes/leaf_node.h>
#include <common/nodes/nodal_constraints.h>
#include <common/nodes/node_block_matrix.h>
#include <common/nodes/node_weights.h>
#include <common/parallel/node_distribution.h>

#include <deal.II/dofs/dof_handler.h>

#include <map>
#include <memory>
#include <vector>

namespace Friction
{
  /**
   * The levels of a DoFHandler, seen nodewise.
   *
   * The leaf mesh with its hanging nodes is one space, the level meshes are
   * others; a node of one is the same vertex as a node of the other. For each
   * leaf node, @p finest_level is the finest level that has it as a node,
   * called $\ell(p)$ below: that is where its residual enters the levels and
   * where its correction is read off.
   *
   * The leaf space has its own smoother, the leading relaxation. Correction
   * levels are therefore only 0,...,n_levels()-2; the finest level merely
   * passes residuals down and corrections up.
   *
   * With several processes a level has its own distribution, that of deal.II's
   * level degrees of freedom: a refined cell belongs to the process that owns
   * its first child. So the same vertex may belong to different processes on
   * the leaf mesh and on a level, and a node's parents may be, too. What a
   * process needs of others it numbers as ghosts: parents of its nodes, nodes
   * of its leaf nodes, and nodes that the rows of its own nodes couple to.
   * Which these are depends on the graph of the matrices, which is therefore
   * found here.
   */
  template <int dim>
  class LevelHierarchy
  {
  public:
    /** One level; numbers of nodes that are not of type LeafNode are local
     * numbers of level nodes, owned nodes first, then ghosts. */
    class Level
    {
    public:
      /** A node of the leaf mesh and the level node at the same vertex. */
      struct OwnNode
      {
        LeafNode     leaf;
        unsigned int node;
      };

      /** Rows of a matrix of which another process computes a part. */
      struct IncomingRow
      {
        unsigned int              row;
        std::vector<unsigned int> columns; ///< in the order they are sent in
      };

      const NodeNumbering &
      numbering() const
      {
        return nodes;
      }

      /** The layout of vectors: the degrees of freedom of owned nodes, then of
       * ghosts. These have the order of numbering(), which is not ascending as
       * deal.II's is; only their number is that of the partitioner. */
      const std::shared_ptr<const Utilities::MPI::Partitioner> &
      partitioner() const
      {
        return layout;
      }

      /** The number of owned nodes. */
      unsigned int
      n_nodes() const
      {
        return nodes.n_owned();
      }

      /** The number of owned nodes and ghosts. */
      unsigned int
      n_local_nodes() const
      {
        return nodes.size();
      }

      /** The owned leaf node at a node's vertex if there is one, and if this
       * level is its finest or the one below; otherwise none. */
      LeafNode
      leaf_node(const unsigned int node) const
      {
        return leaf_nodes[node];
      }

      /** The leaf nodes of this process whose finest level this is, and which
       * do not hang: here their residuals enter, and here they get their
       * corrections. They touch no refined cell and are not relaxed. Their
       * level nodes may be ghosts. */
      const std::vector<OwnNode> &
      own_nodes() const
      {
        return own;
      }

      /** The weights of the next coarser nodes in the value at each node; known
       * for owned nodes and for ghosts that something couples to. */
      const NodeWeights<unsigned int> &
      parents() const
      {
        return parent_weights;
      }

      /** The transpose: which owned nodes of the next finer level each node,
       * ghosts included, has a share in. Not if that level is the finest, which
       * has no unknowns of its own. */
      const NodeWeights<unsigned int> &
      children() const
      {
        Assert(!has_leaf_children(), dealii::ExcInvalidState());
        return child_weights;
      }

      /** Whether the next finer level is the finest. */
      bool
      has_leaf_children() const
      {
        return finer_is_last;
      }

      /** If it is: the same for the leaf nodes of that level, of which those
       * that this process owns and that do not hang have parents. */
      const NodeWeights<LeafNode> &
      leaf_children() const
      {
        Assert(has_leaf_children(), dealii::ExcInvalidState());
        return leaf_child_weights;
      }

      /**
       * The owned nodes to be relaxed: not at the refinement edge, where the
       * level's functions do not belong to the leaf space; touching a refined
       * cell, since otherwise the function is one of the leaf space and has
       * been relaxed there; and not entirely prescribed.
       */
      const NodeRanges &
      relaxed_nodes() const
      {
        return relaxed;
      }

      /** Of an owned node. */
      bool
      is_refinement_edge(const unsigned int node) const
      {
        return edge[node];
      }

      /** Of an owned node: hangs on the leaf mesh. */
      bool
      is_hanging(const unsigned int node) const
      {
        return flags[node] & hanging_bit;
      }

      /** Of an owned node. */
      bool
      is_prescribed(const unsigned int node, const unsigned int component) const
      {
        return flags[node] & (1u << component);
      }

      /** The pattern of the level matrix: the rows of owned nodes. */
      const std::shared_ptr<const NodePattern> &
      couplings() const
      {
        return owned_pattern;
      }

      /** The ghosts whose rows this process computes a part of, from its leaf
       * nodes and its nodes of the next finer level. */
      const std::vector<unsigned int> &
      outgoing_rows() const
      {
        return outgoing;
      }

      /** Their patterns, in the same order. */
      const std::shared_ptr<const NodePattern> &
      outgoing_couplings() const
      {
        return outgoing_pattern;
      }

      /** For each process that computes a part of our rows: these rows, in the
       * order of its outgoing ones. */
      const std::map<unsigned int, std::vector<IncomingRow>> &
      incoming_rows() const
      {
        return incoming;
      }

      /** The ghosts that owned rows couple to: what a sweep needs. */
      const std::vector<unsigned int> &
      coupled_ghosts() const
      {
        return coupled;
      }

      /** The ghosts that are parents of what this process owns, or at its own
       * leaf nodes: what the restriction of bounds needs. */
      const std::vector<unsigned int> &
      transfer_ghosts() const
      {
        return transferred;
      }

    private:
      static constexpr unsigned char hanging_bit = 0x80;

      NodeNumbering                                      nodes;
      std::shared_ptr<const Utilities::MPI::Partitioner> layout;
      std::vector<LeafNode>                              leaf_nodes;
      std::vector<OwnNode>                               own;
      NodeWeights<unsigned int>          parent_weights, child_weights;
      NodeWeights<LeafNode>              leaf_child_weights;
      bool                               finer_is_last = false;
      NodeRanges                         relaxed;
      std::vector<char>                  edge;
      std::vector<unsigned char>         flags;
      std::shared_ptr<const NodePattern> owned_pattern, outgoing_pattern;
      std::vector<unsigned int>          outgoing, coupled, transferred;
      std::map<unsigned int, std::vector<IncomingRow>> incoming;

      friend class LevelHierarchy<dim>;
    };

    /**
     * Collective.
     * @param dof_handler  with leaf and level degrees of freedom.
     * @param constraints  as they are now, is what levels go by.
     * @param leaf_matrix  whose pattern determines that of the level matrices;
     *                     not kept.
     */
    LevelHierarchy(const DoFHandler<dim>       &dof_handler,
                   const NodalConstraints<dim> &constraints,
                   const NodeBlockMatrix<dim>  &leaf_matrix);

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

    /** The finest level $\ell$ that a leaf node is a node of. */
    unsigned int
    finest_level(const LeafNode leaf_node) const
    {
      return finest_levels[leaf_node.number()];
    }

    /** The level node at the vertex of a leaf node that does not hang, where
     * @p k is its finest level or the one below; invalid_unsigned_int if that
     * level does not have the vertex. */
    unsigned int
    node_of_leaf(const unsigned int k, const LeafNode leaf_node) const
    {
      const unsigned int i = leaf_node.number();
      return k == finest_levels[i] ? finest_nodes[i] : nodes_below[i];
    }

    std::size_t memory_consumption() const;

  private:
    std::vector<Level> levels;

    // Of each local leaf node, ghosts included: its finest level, its nodes on
    // that level and on the next coarser one.
    std::vector<unsigned char> finest_levels;
    std::vector<unsigned int>  finest_nodes, nodes_below;

    // What is known before any node gets a local number.
    struct LeafInformation;
    struct GlobalParents;

    void collect_leaf_information(const DoFHandler<dim>       &dof_handler,
                                  const NodalConstraints<dim> &constraints,
                                  LeafInformation             &leaf);

    void find_parents(const DoFHandler<dim> &dof_handler,
                      const unsigned int     k,
                      GlobalParents         &parents) const;

    void number_leaf_nodes(const NodalConstraints<dim> &constraints,
                           const LeafInformation       &leaf,
                           const unsigned int           k);

    void find_couplings(const NodalConstraints<dim> &constraints,
                        const NodeBlockMatrix<dim>  &leaf_matrix,
                        const unsigned int           k);

    void number_parents(const unsigned int k, GlobalParents &parents);

    void find_children(const unsigned int k);

    void make_layouts();

    void classify_nodes(const NodalConstraints<dim> &constraints,
                        const LeafInformation       &leaf);
  };
} // namespace Friction

#endif

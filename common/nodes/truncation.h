#ifndef friction_nodes_truncation_h
#define friction_nodes_truncation_h

#include <common/nodes/nodal_constraints.h>
#include <common/nodes/node_block.h>

#include <vector>

namespace Friction
{
  /**
   * The free subspaces of the leaf nodes: at each node $p$ the orthogonal
   * projector $T_p$ onto the displacements that a coarse correction may change,
   * and the second derivative $\omega''_p$ of friction on that subspace.
   *
   * Away from contact $T_p$ only reflects prescribed components. At a node in
   * contact the phase decides: a sliding node keeps its tangential plane, a
   * sticking one nothing. Multiplying all functions of all levels by $T$ at the
   * nodes of the leaf mesh truncates them: they cannot disturb what the fine
   * grid relaxation has found.
   */
  template <int dim>
  class Truncation
  {
  public:
    /** No node in contact: only prescribed components are held. */
    explicit Truncation(const NodalConstraints<dim> &constraints);

    /**
     * Sets subspace and second derivative of a node.
     * @param projector  symmetric, idempotent.
     * @param curvature  $\omega''_p$ with $T\omega''T=\omega''$.
     */
    void set(const unsigned int    node,
             const NodeBlock<dim> &projector,
             const NodeBlock<dim> &curvature);

    /** The node has always been free in all directions: a quick test that lets
     * most blocks pass without a product. A node that was given a subspace once
     * may have become free again and still say no. */
    bool
    is_identity(const unsigned int node) const
    {
      return slot[node] == identity_slot;
    }

    const NodeBlock<dim> &
    projector(const unsigned int node) const
    {
      return projectors[slot[node]];
    }

    const NodeBlock<dim> &
    curvature(const unsigned int node) const
    {
      return curvatures[slot[node]];
    }

    /** v := T v at all owned nodes. */
    void apply(double *v) const;

    /** The truncated block $T_i A_{ij} T_j$ of a leaf block. */
    NodeBlock<dim> truncated_block(const unsigned int i,
                                   const double      *block,
                                   const unsigned int j) const;

    /** The same with the second derivative: that of
     * $T(A+\omega'')T$. */
    NodeBlock<dim> linearized_block(const unsigned int i,
                                    const double      *block,
                                    const unsigned int j) const;

    /** Both subspace and second derivative of a node agree with another's. */
    bool agrees(const Truncation &other, const unsigned int node) const;

    /** The nodes at which it does not agree with another, ghosts included, in
     * ascending order. */
    std::vector<unsigned int> differences(const Truncation &other) const;

    /** The nodes, ghosts included, that were ever given a subspace other than
     * everything. */
    const std::vector<unsigned int> &
    changed_nodes() const
    {
      return specials;
    }

    /** The number of displacement components that are held at contact nodes of
     * this process. */
    unsigned int n_truncated_components() const;

  private:
    static constexpr unsigned int identity_slot = 0;
    static constexpr unsigned int zero_slot     = 1;

    unsigned int                n_owned;
    unsigned int                held_by_constraints = 0;
    std::vector<unsigned int>   slot;
    std::vector<NodeBlock<dim>> projectors, curvatures;
    std::vector<unsigned int>   specials;

    unsigned int n_held_components() const;
  };
} // namespace Friction

#endif

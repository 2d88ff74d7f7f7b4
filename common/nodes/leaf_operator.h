#ifndef friction_nodes_leaf_operator_h
#define friction_nodes_leaf_operator_h

#include <common/nodes/nodal_constraints.h>
#include <common/nodes/node_block_matrix.h>
#include <common/parallel/ghost_exchange.h>

#include <memory>

namespace Friction
{
  /**
   * The stiffness matrix $A$ of the leaf mesh as an operator on vectors: the
   * blocks of this process' rows, and the exchange of the values of other
   * processes' nodes that these rows couple to.
   *
   * Vectors have the layout of NodalConstraints::partitioner(), which
   * assertions check. Ghost values of an argument are brought up to date by the
   * operator itself, so that a product is right whatever has been done to the
   * vector before. As in deal.II, ghosts are not considered part of a vector's
   * value, and change in a `const` one.
   */
  template <int dim>
  class LeafOperator
  {
  public:
    LeafOperator() = default;

    /**
     * Collective.
     * @param blocks       rows of this process' nodes; columns are local
     *                     numbers, owned nodes first, then ghosts.
     * @param constraints  gives the layout; not kept.
     */
    LeafOperator(NodeBlockMatrix<dim>       &&blocks,
                 const NodalConstraints<dim> &constraints);

    const NodeBlockMatrix<dim> &
    blocks() const
    {
      return matrix;
    }

    /** The diagonal block of an owned node that does not hang. */
    const double *
    diagonal_block(const unsigned int node) const
    {
      return matrix.diagonal(node);
    }

    /** Brings the values of the nodes that owned rows couple to up to date.
     * Collective. */
    void update_ghosts(const VectorType &v) const;

    /** Av := A v. Collective. */
    void vmult(VectorType &Av, const VectorType &v) const;

    /** The share of this process in $v^TAv$, which is to be summed over all.
     * Takes less than vmult(). Collective. */
    double energy_product(const VectorType &v) const;

    /** r := f - A v. Collective. */
    void
    residual(VectorType &r, const VectorType &f, const VectorType &v) const;

    /** For sweeps, which change values and exchange them as they go. */
    GhostExchange &
    ghosts() const
    {
      return *exchange;
    }

    /** In bytes, on this process. */
    std::size_t
    memory_consumption() const
    {
      return matrix.memory_consumption();
    }

    /** Asserts that a vector has the layout of this operator. */
    void check_layout(const VectorType &v) const;

  private:
    NodeBlockMatrix<dim>                               matrix;
    std::shared_ptr<const Utilities::MPI::Partitioner> partitioner;

    // Its buffers change while it works.
    std::unique_ptr<GhostExchange> exchange;
  };
} // namespace Friction

#endif

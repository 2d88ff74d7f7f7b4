#ifndef friction_levels_level_transfer_h
#define friction_levels_level_transfer_h

#include <common/compatibility.h>
#include <common/levels/level_hierarchy.h>
#include <common/parallel/ghost_exchange.h>

#include <vector>

namespace Friction
{
  /**
   * How residuals come down and corrections go up.
   *
   * Between two levels this is deal.II's MGTransferMatrixFree, as in step-50
   * and step-75. Between the leaf mesh and the levels, add_from_leaf() and
   * copy_to_leaf() take the place of its copy_to_mg() and copy_from_mg(), for
   * two reasons. deal.II's copy_to_mg() puts the residual of a node at the
   * boundary of a refined region on the coarser of its levels, where its
   * function is smooth; here it enters on the finest level $\ell(p)$ that has
   * the node, since the level matrices are Galerkin products of the leaf
   * matrix, and the leaf function is among those of level $\ell(p)$. And what
   * moves up and down here is not $Au$ but a truncated residual, zero at nodes
   * that hang.
   *
   * Vectors of a level have the layout of Level::partitioner(). Of those of
   * deal.II's functions only owned values are read and written, so that the
   * ghosts may be those that our own sweeps need.
   */
  template <int dim>
  class LevelTransfer
  {
  public:
    /** Collective.
     * @param hierarchy    kept by reference.
     * @param constraints  for the layout of vectors of the leaf mesh. */
    LevelTransfer(const DoFHandler<dim>       &dof_handler,
                  const LevelHierarchy<dim>   &hierarchy,
                  const NodalConstraints<dim> &constraints);

    /** coarse += P^T fine, from level @p k to the next coarser one.
     * Collective. */
    void restrict_and_add(const unsigned int k,
                          VectorType        &coarse,
                          const VectorType  &fine) const;

    /** fine += P coarse, from level @p k - 1 to level @p k. The ghosts of
     * @p fine are zero on return. Collective. */
    void prolongate_and_add(const unsigned int k,
                            VectorType        &fine,
                            const VectorType  &coarse) const;

    /** Adds the values of the leaf nodes whose finest level is @p k to those of
     * their level nodes. Collective. */
    void add_from_leaf(const unsigned int k,
                       VectorType        &level,
                       const VectorType  &leaf) const;

    /** The way back: sets the values of the leaf nodes whose finest level is
     * @p k; other leaf nodes stay as they are. Collective. */
    void copy_to_leaf(const unsigned int k,
                      VectorType        &leaf,
                      const VectorType  &level) const;

    /** From the leaf nodes of the finest level straight to the next coarser
     * one: coarse += P^T leaf. Collective. */
    void restrict_from_leaf(VectorType &coarse, const VectorType &leaf) const;

    /** The way back: sets the values of these leaf nodes to those of P coarse.
     * Collective.
     * @param leaf  zero there. */
    void prolongate_to_leaf(VectorType &leaf, const VectorType &coarse) const;

    std::size_t
    memory_consumption() const
    {
      return transfer.memory_consumption() + finest.memory_consumption();
    }

  private:
    const LevelHierarchy<dim>                &hierarchy;
    Compatibility::TransferWithoutCopies<dim> transfer;

    // On a mesh without local refinement the finest level is the leaf mesh,
    // node by node, and no vector of its own is needed in between.
    bool               finest_is_leaf_mesh;
    mutable VectorType finest;

    // Level nodes of other processes at this process' leaf nodes; buffers
    // change.
    mutable std::vector<GhostExchange> ghosts_at_leaf_nodes;
  };
} // namespace Friction

#endif

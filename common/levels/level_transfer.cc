#include <common/levels/level_transfer.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <memory>

namespace Friction
{
  template <int dim>
  LevelTransfer<dim>::LevelTransfer(const DoFHandler<dim>       &dof_handler,
                                    const LevelHierarchy<dim>   &hierarchy,
                                    const NodalConstraints<dim> &constraints)
    : hierarchy(hierarchy)
  {
    const unsigned int last_level = hierarchy.n_levels() - 1;
    const auto        &last       = hierarchy.level(last_level);
    bool               differs    = last.own_nodes().size() != last.n_nodes() ||
      last.own_nodes().size() != constraints.n_owned_nodes();
    for (const auto &own : last.own_nodes())
      differs = differs || own.node != own.leaf.number();
    finest_is_leaf_mesh =
      !true_on_any_process(differs, constraints.communicator());
    if (!finest_is_leaf_mesh)
      finest.reinit(last.partitioner());

    // With one process deal.II can work in our vectors as they are. With
    // several it copies to vectors of its own, which have other ghosts.
    std::vector<std::shared_ptr<const Utilities::MPI::Partitioner>> layouts;
    const unsigned int n_processes =
      hierarchy.level(0).numbering().distribution().n_processes();
    for (unsigned int k = 0; k < hierarchy.n_levels() && n_processes == 1; ++k)
      layouts.push_back(k == last_level && finest_is_leaf_mesh
                          ? constraints.partitioner()
                          : hierarchy.level(k).partitioner());
    // Without MGConstrainedDoFs, which step-50 has: truncation holds what is
    // prescribed, and nodes at the boundary of a refined region matter only to
    // copy_to_mg() and its like, which are not called here.
    transfer.build(dof_handler, layouts);
    transfer.release_copies();

    for (unsigned int k = 0; k < hierarchy.n_levels(); ++k)
      {
        const auto               &level = hierarchy.level(k);
        std::vector<unsigned int> ghosts;
        for (const auto &own : level.own_nodes())
          if (own.node >= level.n_nodes())
            ghosts.push_back(own.node);
        std::sort(ghosts.begin(), ghosts.end());
        ghosts_at_leaf_nodes.emplace_back(level.numbering(), ghosts);
      }
  }



  template <int dim>
  void
  LevelTransfer<dim>::restrict_and_add(const unsigned int k,
                                       VectorType        &coarse,
                                       const VectorType  &fine) const
  {
    transfer.restrict_and_add(k, coarse, fine);
  }



  template <int dim>
  void
  LevelTransfer<dim>::prolongate_and_add(const unsigned int k,
                                         VectorType        &fine,
                                         const VectorType  &coarse) const
  {
    // deal.II adds to owned values, and from 9.7 on refuses to where ghosts
    // hold values of which it does not know.
    fine.zero_out_ghost_values();
    transfer.prolongate_and_add(k, fine, coarse);
  }



  template <int dim>
  void
  LevelTransfer<dim>::add_from_leaf(const unsigned int k,
                                    VectorType        &level,
                                    const VectorType  &leaf) const
  {
    double            *values  = level.begin();
    const unsigned int n_owned = dim * hierarchy.level(k).n_nodes();
    std::fill(
      values + n_owned, values + dim * hierarchy.level(k).n_local_nodes(), 0.);
    for (const auto &own : hierarchy.level(k).own_nodes())
      for (unsigned int d = 0; d < dim; ++d)
        values[dim * own.node + d] +=
          leaf.local_element(dim * own.leaf.number() + d);
    ghosts_at_leaf_nodes[k].collect(values, dim, GhostExchange::Combine::add);
  }



  template <int dim>
  void
  LevelTransfer<dim>::copy_to_leaf(const unsigned int k,
                                   VectorType        &leaf,
                                   const VectorType  &level) const
  {
    double *values = const_cast<double *>(level.begin());
    ghosts_at_leaf_nodes[k].update(values, dim);
    for (const auto &own : hierarchy.level(k).own_nodes())
      for (unsigned int d = 0; d < dim; ++d)
        leaf.local_element(dim * own.leaf.number() + d) =
          values[dim * own.node + d];
  }



  template <int dim>
  void
  LevelTransfer<dim>::restrict_from_leaf(VectorType       &coarse,
                                         const VectorType &leaf) const
  {
    const unsigned int k = hierarchy.n_levels() - 1;
    if (finest_is_leaf_mesh)
      restrict_and_add(k, coarse, leaf);
    else
      {
        finest = 0.;
        add_from_leaf(k, finest, leaf);
        restrict_and_add(k, coarse, finest);
      }
  }



  template <int dim>
  void
  LevelTransfer<dim>::prolongate_to_leaf(VectorType       &leaf,
                                         const VectorType &coarse) const
  {
    const unsigned int k = hierarchy.n_levels() - 1;
    if (finest_is_leaf_mesh)
      prolongate_and_add(k, leaf, coarse);
    else
      {
        finest = 0.;
        prolongate_and_add(k, finest, coarse);
        copy_to_leaf(k, leaf, finest);
      }
  }



  template class LevelTransfer<2>;
  template class LevelTransfer<3>;
} // namespace Friction

#include <common/levels/level_transfer.h>

#include <algorithm>
#include <memory>

namespace Friction
{
  template <int dim>
  LevelTransfer<dim>::LevelTransfer(const DoFHandler<dim>     &dof_handler,
                                    const LevelHierarchy<dim> &hierarchy)
    : hierarchy(hierarchy)
  {
    // With one process deal.II can work in our vectors as they are. With
    // several it copies to vectors of its own, which have other ghosts.
    std::vector<std::shared_ptr<const Utilities::MPI::Partitioner>> layouts;
    const unsigned int n_processes =
      hierarchy.level(0).numbering().distribution().n_processes();
    for (unsigned int k = 0; k < hierarchy.n_levels() && n_processes == 1; ++k)
      layouts.push_back(hierarchy.level(k).partitioner());
    mg_constrained_dofs.initialize(dof_handler);
    transfer.initialize_constraints(mg_constrained_dofs);
    transfer.build(dof_handler, layouts);

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



  template class LevelTransfer<2>;
  template class LevelTransfer<3>;
} // namespace Friction

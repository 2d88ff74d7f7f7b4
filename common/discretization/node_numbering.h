#ifndef friction_discretization_node_numbering_h
#define friction_discretization_node_numbering_h

#include <deal.II/dofs/dof_handler.h>

#include <functional>

namespace Friction
{
  using namespace dealii;

  /**
   * Renumbers the nodes of the leaf mesh and of all levels by breadth-first
   * search from a node at the rim of the mesh (Cuthill and McKee, 1969),
   * keeping the degrees of freedom of a node together. Neighbours then are
   * close to each other in memory, which is what lets one relaxation sweep
   * follow another through the cache; see SweepSchedule.
   *
   * Of each chunk of nodes that a sweep takes at once, those on the contact
   * boundary of the leaf mesh come last, and on a level those that are not
   * relaxed, so that there are long ranges of others before them. Without local
   * refinement the finest level is the leaf mesh, and has its numbers.
   *
   * To be called after distribute_dofs() and distribute_mg_dofs(). Each process
   * renumbers the nodes it owns. Where it has neighbours, the search starts
   * from all nodes at the interfaces to them: a sweep then relaxes these first,
   * and their new values can travel while it is busy with the rest.
   *
   * @param has_contact  whether the boundary with an id is contact boundary.
   */
  template <int dim>
  void renumber_nodes(
    DoFHandler<dim>                                     &dof_handler,
    const std::function<bool(const types::boundary_id)> &has_contact);
} // namespace Friction

#endif

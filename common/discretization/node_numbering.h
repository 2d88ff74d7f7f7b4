#ifndef friction_discretization_node_numbering_h
#define friction_discretization_node_numbering_h

#include <deal.II/dofs/dof_handler.h>

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
   * To be called after distribute_dofs() and distribute_mg_dofs(). Each process
   * renumbers the nodes it owns. Where it has neighbours, the search starts
   * from all nodes at the interfaces to them: a sweep then relaxes these first,
   * and their new values can travel while it is busy with the rest.
   */
  template <int dim>
  void renumber_nodes(DoFHandler<dim> &dof_handler);
} // namespace Friction

#endif

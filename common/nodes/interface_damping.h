#ifndef friction_nodes_interface_damping_h
#define friction_nodes_interface_damping_h

#include <common/nodes/node_block_matrix.h>

namespace Friction
{
  /**
   * A majorant of what a node couples to at other processes. If all processes
   * change their nodes by $\delta$ at once, each with the values of the others
   * as they were, the energy contains terms $\delta_i^TA_{ij}\delta_j$ that
   * no process has reckoned with, where $i$ and $j$ belong to different
   * processes. With the singular value decomposition $A_{ij}=U\Sigma V^T$,
   * @f[ |\delta_i^TA_{ij}\delta_j| \le
   *     \tfrac12\delta_i^T(U\Sigma U^T)\delta_i +
   *     \tfrac12\delta_j^T(V\Sigma V^T)\delta_j, @f]
   * so that $\tfrac12\sum_i\delta_i^TL_i\delta_i$ bounds them all, where
   * $L_i=\sum_jU_{ij}\Sigma_{ij}U_{ij}^T$ over the neighbours $j$ that belong
   * to others. For one component per node this is the row sum of the $\ell_1$
   * Gauss-Seidel method of Baker, Falgout, Kolev and Yang (2011).
   *
   * Being made of $A_{ij}A_{ij}^T$, it vanishes in directions in which the row
   * does, so that truncated directions stay what they are.
   *
   * @return  $L_i$; zero if the row couples to no ghost.
   */
  template <int dim>
  NodeBlock<dim> interface_majorant(const NodeBlockMatrix<dim> &A,
                                    const unsigned int          row);

  /**
   * What has to be added to a diagonal block so that relaxation may ignore that
   * other processes relax at the same time, if the local problems are solved
   * exactly:
   * @f[ E_i = \tfrac12\big(L_i-\tfrac34A_{ii}\big)_+ @f]
   * with the majorant $L_i$ and the positive part of a symmetric matrix.
   *
   * To minimise exactly pays: with $A_{ii}+E_i$ in place of $A_{ii}$, the step
   * $\delta_i$ lowers the energy, with the values of other processes frozen, by
   * at least $\tfrac12\delta_i^T(A_{ii}+2E_i)\delta_i$, convex friction and
   * obstacle included. What the others do at the same time can raise it by
   * $\tfrac12\delta_i^TL_i\delta_i$. So the energy falls, by a quarter of what
   * the diagonal alone would give at least, if $2E_i\ge L_i-\tfrac34A_{ii}$;
   * see doc/parallel.md. Within the faces of a regular mesh usually nothing
   * has to be added, for most of what a node couples to is its own process'.
   */
  template <int dim>
  NodeBlock<dim> interface_damping(const NodeBlockMatrix<dim> &A,
                                   const unsigned int          row);
} // namespace Friction

#endif

#ifndef friction_multigrid_leaf_matrix_h
#define friction_multigrid_leaf_matrix_h

#include <common/contact/nodal_constraints.h>
#include <common/multigrid/node_block_matrix.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>

namespace Friction
{
  /**
   * Copies an assembled matrix into node blocks. Trilinos is good at gathering
   * contributions from all processes, node blocks are good at being relaxed;
   * the former is no longer needed after this.
   *
   * Rows and columns of hanging nodes, which are condensed and hold but a
   * number on the diagonal, are left empty.
   */
  template <int dim>
  NodeBlockMatrix<dim>
  make_node_block_matrix(const TrilinosWrappers::SparseMatrix &matrix,
                         const NodalConstraints<dim>          &constraints);
} // namespace Friction

#endif

#ifndef friction_discretization_leaf_matrix_h
#define friction_discretization_leaf_matrix_h

#include <common/nodes/nodal_constraints.h>
#include <common/nodes/node_block_matrix.h>

#include <deal.II/base/index_set.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

namespace Friction
{
  /**
   * The sparsity pattern of the stiffness matrix: all rows of locally owned
   * nodes, complete also where cells of other processes contribute. Hanging
   * nodes are condensed. Collective.
   */
  template <int dim>
  void make_stiffness_pattern(const DoFHandler<dim>           &dof_handler,
                              const AffineConstraints<double> &hanging,
                              DynamicSparsityPattern          &pattern);

  /** The degrees of freedom that the locally owned rows couple to. */
  template <int dim>
  IndexSet coupled_dofs(const DoFHandler<dim>        &dof_handler,
                        const DynamicSparsityPattern &pattern);

  /**
   * Copies an assembled matrix into node blocks. Trilinos is good at gathering
   * contributions from all processes, node blocks are good at being relaxed;
   * the former is no longer needed after this.
   *
   * The pattern that the matrix was made from is needed once more, since
   * TrilinosWrappers::SparseMatrix allows to look up entries quickly, but not
   * to iterate over a row in time independent of the size of the matrix.
   *
   * Rows and columns of hanging nodes, which are condensed and hold but a
   * number on the diagonal, are left empty.
   */
  template <int dim>
  NodeBlockMatrix<dim>
  make_node_block_matrix(const TrilinosWrappers::SparseMatrix &matrix,
                         const DynamicSparsityPattern         &pattern,
                         const NodalConstraints<dim>          &constraints);
} // namespace Friction

#endif

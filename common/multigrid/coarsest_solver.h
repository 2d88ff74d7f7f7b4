#ifndef friction_multigrid_coarsest_solver_h
#define friction_multigrid_coarsest_solver_h

#include <common/multigrid/level_hierarchy.h>
#include <common/multigrid/level_matrices.h>

#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <memory>

namespace Friction
{
  /**
   * Solves the truncated problem of the coarsest level directly, by Trilinos.
   *
   * Directions in which a coarse function has vanished by truncation, or which
   * are prescribed, are taken out of the matrix and replaced by a multiple of
   * the identity, so that it stays positive definite. The factorisation is
   * renewed only when the coarsest matrix has changed.
   */
  template <int dim>
  class CoarsestSolver
  {
  public:
    /** The arguments are kept by reference. Collective. */
    CoarsestSolver(const LevelHierarchy<dim> &hierarchy,
                   const LevelMatrices<dim>  &level_matrices);

    /** c = B_0^{-1} r at the nodes that the process owns, with zero in all
     * directions that cannot move. Collective. */
    void solve(double *c, const double *r);

  private:
    const LevelHierarchy<dim>                      &hierarchy;
    const LevelMatrices<dim>                       &level_matrices;
    TrilinosWrappers::SparseMatrix                  matrix;
    SolverControl                                   control;
    std::unique_ptr<TrilinosWrappers::SolverDirect> solver;
    VectorType                                      rhs, solution;
    unsigned int                                    version = 0;

    void factorize();

    void project(VectorType &v) const;

    // The number of a component of a node among all unknowns.
    types::global_dof_index dof(const unsigned int node,
                                const unsigned int component) const;
  };
} // namespace Friction

#endif

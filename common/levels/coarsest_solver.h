#ifndef friction_levels_coarsest_solver_h
#define friction_levels_coarsest_solver_h

#include <common/levels/algebraic_solver.h>
#include <common/levels/level_hierarchy.h>
#include <common/levels/level_matrices.h>
#include <common/parallel/ghost_exchange.h>

#include <deal.II/lac/la_parallel_vector.h>

#include <memory>
#include <vector>

namespace Friction
{
  /**
   * Solves the truncated problem of the coarsest level, by AlgebraicSolver.
   *
   * Directions in which a coarse function has vanished by truncation, or which
   * are prescribed, are taken out of the matrix and replaced by a multiple of
   * the identity, so that it stays positive definite. It is set up anew only
   * when the coarsest matrix has changed.
   */
  template <int dim>
  class CoarsestSolver
  {
  public:
    /** Arguments given by reference are kept. Collective. */
    CoarsestSolver(const LevelHierarchy<dim> &hierarchy,
                   const LevelMatrices<dim>  &level_matrices,
                   const CoarsestMethod       method);
    ~CoarsestSolver();

    /** c = B_0^{-1} r at the nodes that the process owns, with zero in all
     * directions that cannot move. Collective. */
    void solve(double *c, const double *r);

    /**
     * The same among those c that vanish in all components with @p is_fixed,
     * one flag per owned degree of freedom. Where in addition some
     * direction of a node cannot move, nothing of this node does: c is a
     * direction of descent, but near such nodes not the best one.
     */
    void solve_on_face(double                  *c,
                       const double            *r,
                       const std::vector<char> &is_fixed);

    const AlgebraicSolver &
    algebraic_solver() const
    {
      return solver;
    }

  private:
    const LevelHierarchy<dim>                      &hierarchy;
    const LevelMatrices<dim>                       &level_matrices;
    std::unique_ptr<TrilinosWrappers::SparseMatrix> matrix;
    AlgebraicSolver                                 solver;
    GhostExchange                                   ghosts;
    VectorType                                      rhs, solution;
    unsigned int                                    version = 0;

    void set_up();

    void project(VectorType &v) const;

    // The number of a component of a node among all unknowns.
    types::global_dof_index dof(const unsigned int node,
                                const unsigned int component) const;
  };
} // namespace Friction

#endif

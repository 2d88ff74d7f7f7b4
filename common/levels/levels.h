#ifndef friction_levels_levels_h
#define friction_levels_levels_h

#include <common/discretization/discrete_problem.h>
#include <common/levels/coarsest_solver.h>
#include <common/levels/level_hierarchy.h>
#include <common/levels/level_matrices.h>
#include <common/levels/level_transfer.h>
#include <common/nodes/gauss_seidel.h>
#include <common/nodes/stretched_relaxation.h>
#include <common/parallel/ghost_exchange.h>
#include <common/parallel/run_clock.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace Friction
{
  /**
   * All that belongs to the levels below the leaf mesh, made once per mesh and
   * shared by all corrections:
   * - LevelHierarchy: which nodes a level has, which of them are relaxed, and
   *   how they hang together with those of the next levels and of the leaf
   *   mesh;
   * - LevelTransfer: residuals down, corrections up;
   * - LevelMatrices: the Galerkin matrices, which follow the truncation;
   * - relaxation, and the solver of the coarsest level;
   * - lines or planes of strongly coupled nodes, if there are any.
   *
   * A correction adds vectors to this, and the order in which levels are
   * visited.
   *
   * They are made by make_now(), or when they are needed first: a small problem
   * may be solved without them, see SafeguardedSolver. Each function may be the
   * first one, and is collective then.
   */
  template <int dim>
  class Levels
  {
  public:
    /**
     * @param dof_handler  with leaf and level degrees of freedom; kept by
     *                     reference.
     * @param problem      on its leaf mesh; kept by reference, as is what it
     *                     refers to.
     */
    Levels(const DoFHandler<dim>      &dof_handler,
           const DiscreteProblem<dim> &problem,
           const CoarsestMethod coarsest_method = CoarsestMethod::automatic);
    Levels(const DoFHandler<dim> &,
           DiscreteProblem<dim> &&,
           const CoarsestMethod = {}) = delete;

    ~Levels();

    /** Makes them, unless they are there. Collective. */
    void make_now() const;

    const DoFHandler<dim> &
    dof_handler() const
    {
      return leaf_and_levels;
    }

    const LevelHierarchy<dim> &
    hierarchy() const
    {
      return parts().hierarchy;
    }

    const LevelTransfer<dim> &
    transfer() const
    {
      return parts().transfer;
    }

    const LevelMatrices<dim> &
    matrices() const
    {
      return parts().matrices;
    }

    CoarsestSolver<dim> &
    coarsest_solver()
    {
      return parts().coarsest;
    }

    MPI_Comm
    communicator() const
    {
      return problem.communicator();
    }

    /** The number of correction levels, which have matrices. */
    unsigned int
    n_correction_levels() const
    {
      return parts().matrices.n_levels();
    }

    /** A vector of zeros for level @p k, with the ghosts of Level. */
    VectorType
    vector(const unsigned int k) const
    {
      return VectorType(parts().hierarchy.level(k).partitioner());
    }

    /** The values that owned rows of level @p k couple to. */
    GhostExchange &
    coupled_ghosts(const unsigned int k)
    {
      return parts().coupled[k];
    }

    /** Has the matrices follow a change of phases; see
     * LevelMatrices::update(). */
    void update(const Truncation<dim> &truncation);

    /** Block rows of matrices that this process has computed anew in all
     * updates: a measure of their work. */
    std::size_t
    n_updated_rows() const
    {
      return updated_rows;
    }

    /**
     * Gauss-Seidel sweeps for B_k c = b at the nodes of a level that are to be
     * relaxed: first at those that belong to no line or plane, then over these,
     * if there are any. The ghosts of @p c must be valid, and are on return.
     * @param defect  if not null, b - B_k c on return.
     */
    void relax(const unsigned int k,
               VectorType        &c,
               const VectorType  &b,
               const unsigned int n_sweeps,
               VectorType        *defect = nullptr);

    /** The share of nodes in lines or planes of strong couplings, which are
     * there where cells are stretched, on a correction level, or with
     * n_correction_levels() in place of a level on the leaf mesh. relax() knows
     * of those of its level; on the leaf mesh, where the leading relaxation
     * goes node by node, a correction has to. */
    double
    share_relaxed_together(const unsigned int k) const
    {
      return stretched(k).share();
    }

    /** The same, in lines only. */
    double
    share_in_lines(const unsigned int k) const
    {
      return stretched(k).share_in_lines();
    }

    /** The number of unknowns of a correction level, or likewise of the leaf
     * mesh, on all processes. */
    types::global_dof_index
    n_dofs(const unsigned int k) const
    {
      return k < n_correction_levels()
        ? parts().hierarchy.level(k).partitioner()->size()
        : problem.constraints.partitioner()->size();
    }

    /**
     * Sweeps over lines or planes of the leaf mesh for $T(A+\omega'')T\,v=r$.
     * @param v       truncated. Its ghosts need not be valid.
     * @param r       truncated.
     * @param defect  if not null, the truncated residual on return.
     */
    void relax_leaf(VectorType        &v,
                    const VectorType  &r,
                    const unsigned int n_sweeps,
                    VectorType        *defect = nullptr);

    std::size_t memory_consumption() const;

  private:
    // What there is once they have been made.
    struct Parts
    {
      Parts(const DoFHandler<dim>      &dof_handler,
            const DiscreteProblem<dim> &problem,
            const CoarsestMethod        coarsest_method);

      const LevelHierarchy<dim>     hierarchy;
      const LevelTransfer<dim>      transfer;
      LevelMatrices<dim>            matrices;
      CoarsestSolver<dim>           coarsest;
      std::vector<GaussSeidel<dim>> relaxations;

      // Where cells are stretched: the lines or planes of the levels, and then
      // those of the leaf mesh. They are factorised when they are needed, and
      // then kept until rows of the level matrices change.
      std::vector<StretchedRelaxation<dim>> stretched;
      unsigned int                          version = 1; // of the matrices
      std::vector<unsigned int>             factorised;  // which; none if zero

      bool needs_factorisation(const unsigned int k);

      std::vector<GhostExchange> coupled;
    };

    const DoFHandler<dim>         &leaf_and_levels;
    const DiscreteProblem<dim>    &problem;
    const CoarsestMethod           coarsest_method;
    mutable std::unique_ptr<Parts> made;
    std::size_t                    updated_rows = 0;

    Parts &
    parts() const
    {
      if (!made)
        make_now();
      return *made;
    }

    const StretchedRelaxation<dim> &
    stretched(const unsigned int k) const
    {
      return parts().stretched[std::min(k, n_correction_levels())];
    }
  };
} // namespace Friction

#endif

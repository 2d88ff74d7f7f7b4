#ifndef friction_iteration_monotone_multigrid_h
#define friction_iteration_monotone_multigrid_h

#include <common/contact/contact_state.h>
#include <common/iteration/algebraic_correction.h>
#include <common/iteration/coarse_cycle.h>
#include <common/iteration/linearization.h>
#include <common/iteration/monotone_smoother.h>
#include <common/parameters/solver_settings.h>
#include <common/discretization/discrete_problem.h>
#include <common/iteration/recombination.h>
#include <common/iteration/tresca_functional.h>

#include <functional>
#include <memory>
#include <vector>

namespace Friction
{
  /** What happened in one multigrid cycle. */
  struct CycleInfo
  {
    double increment; ///< energy norm of the increment, relative to u's
    double energy;    ///< of the smoothed iterate
    double damping;   ///< step length of the coarse correction
    double truncated; ///< components held at all contact nodes
    double residual;  ///< Euclidean norm of the truncated residual
  };

  /** What a multigrid iteration has come to. */
  struct MultigridResult
  {
    bool                   converged = false;
    std::vector<CycleInfo> cycles;

    /// Energy norm of the error of the last iterate, extrapolated from the last
    /// increments.
    double algebraic_error = 0;

    /** Mean contraction of the increments, per cycle; zero if there were fewer
     * than two. */
    double contraction() const;

    /**
     * Whether the iteration is getting nowhere: at the pace of the last twenty
     * cycles, measured against the twenty before, the increments would not come
     * down to @p tolerance within @p maximum_cycles altogether. Says no as long
     * as there are fewer than fifty cycles; contact zones may take that many to
     * grow into place.
     */
    bool stalls(const double       tolerance,
                const unsigned int maximum_cycles) const;
  };

  /** Seconds of this process' wall time by part, and sizes of work; summed over
   * all calls. */
  struct MultigridCost
  {
    double       leading_sweeps    = 0;
    double       coarse_correction = 0;
    double       matrix_updates    = 0;
    double       line_search       = 0;
    double       total             = 0;
    std::size_t  n_updated_rows    = 0;
    unsigned int n_leading_sweeps  = 0;
  };



  /**
   * The monotone multigrid iteration for contact with friction. One step runs
   * - the leading relaxation, MonotoneSmoother,
   * - phases, truncation and constrained Newton terms, Linearization,
   * - the coarse correction, CoarseCycle or AlgebraicCorrection,
   * - its recombination with the last steps, Recombination,
   * - projection to what is admissible and reverses no slip, and line search,
   *   TrescaFunctional,
   *
   * and the relaxation once more, backwards. With given normal forces (Tresca)
   * the iterates stay admissible and the energy never increases. The exception
   * is CoarseCorrection::monotone in three dimensions: it has no line search,
   * and a correction that lowers the linearised energy lowers the true one only
   * where friction is piecewise linear, in two.
   */
  template <int dim>
  class MonotoneMultigrid
  {
  public:
    /** Is told the number of cycles done and the last relative increment. */
    using Progress = std::function<void(const unsigned int, const double)>;

    /** What the references in @p problem refer to, and @p hierarchy, must
     * outlive the object. */
    MonotoneMultigrid(const LevelHierarchy<dim>  &hierarchy,
                      const DiscreteProblem<dim> &problem,
                      const SolverSettings       &settings);

    /**
     * Iterates until the relative increment is at most the inner tolerance, or
     * until the error itself is at most the energy tolerance. An
     * iteration that would not get there within the maximum number of cycles
     * is given up early if the settings allow for it, see
     * MultigridResult::stalls().
     *
     * @param u  initial guess and solution; must be admissible and have the
     *           prescribed values. Values at hanging nodes are not touched. On
     *           return its ghosts are valid, see MonotoneSmoother::ghosts().
     * @param state  likewise.
     * @param update_normal_forces  Algorithm 3: Coulomb friction, whose normal
     *           forces are updated inside the leading relaxation. Otherwise
     * they stay as they are.
     */
    MultigridResult solve(VectorType     &u,
                          ContactState   &state,
                          const bool      update_normal_forces,
                          const Progress &progress = {});

    /** Sets the normal forces of @p state to those of @p u, whose ghosts must
     * be valid, at nodes in contact and to zero elsewhere; returns the residual
     * f - A u. */
    VectorType update_normal_forces(ContactState     &state,
                                    const VectorType &u) const;

    const MultigridCost &
    cost() const
    {
      return costs;
    }

    const MonotoneSmoother<dim> &
    leading_smoother() const
    {
      return smoother;
    }

    std::size_t memory_consumption() const;

  private:
    const DiscreteProblem<dim>  problem;
    const SolverSettings        settings;
    const TrescaFunctional<dim> functional;
    const MonotoneSmoother<dim> smoother;
    Linearization<dim>          linearization;
    MultigridCost               costs;

    // One of the two.
    std::unique_ptr<CoarseCycle<dim>>         coarse;
    std::unique_ptr<AlgebraicCorrection<dim>> algebraic;

    double smallest_norm(const VectorType &u) const;

    void set_normal_forces(ContactState     &state,
                           const VectorType &residual) const;

    double correct(VectorType         &u,
                   const VectorType   &residual,
                   const ContactState &state,
                   Recombination<dim> &recombination,
                   CycleInfo          &info);

    double try_whole_correction(VectorType         &v,
                                const double        length,
                                const VectorType   &whole,
                                const VectorType   &u,
                                const VectorType   &residual,
                                const ContactState &state) const;

    // Av = A v, with the ghosts of v brought up to date.
    void multiply(VectorType &Av, VectorType &v) const;

    // What the line search along v needs to know of its quadratic part, and a
    // number that is summed up in passing.
    struct Products
    {
      double      slope, curvature;
      std::size_t n_changed;
    };

    Products along(const VectorType  &v,
                   const VectorType  &Av,
                   const VectorType  &residual,
                   const unsigned int n_changed) const;
  };
} // namespace Friction

#endif

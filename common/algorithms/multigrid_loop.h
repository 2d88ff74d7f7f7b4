#ifndef friction_algorithms_multigrid_loop_h
#define friction_algorithms_multigrid_loop_h

#include <common/iteration/monotone_multigrid.h>

#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace Friction
{
  /** Is told the number of cycles done and the last relative increment. */
  using Progress = std::function<void(const unsigned int, const double)>;



  /** What happened in one multigrid cycle. */
  struct CycleInfo
  {
    double increment;   ///< energy norm of the increment, relative to u's
    double energy;      ///< of the smoothed iterate that the cycle begins with;
                        ///< with Newton's method that which a step ends with
    double step_length; ///< step length of the coarse correction
    double truncated;   ///< components held at all contact nodes
    double residual;    ///< Euclidean norm of the truncated residual; with
                        ///< Newton's method of all nodal forces that are wrong
  };



  /**
   * The cycles that several iterations may take together, and those of them
   * that the present attempt at a solution may take.
   */
  class CycleBudget
  {
  public:
    explicit CycleBudget(const unsigned int n_cycles)
      : left(n_cycles)
      , left_of_attempt(n_cycles)
    {}

    /**
     * Another attempt begins. It gets half of what is left, so that there is
     * something left for others, or all if it is the last one.
     * @return whether there is anything left.
     */
    bool
    begin_attempt(const bool is_last = false)
    {
      left_of_attempt = is_last ? left : (left + 1) / 2;
      return left > 0;
    }

    void
    take_cycle()
    {
      left -= (left > 0);
      left_of_attempt -= (left_of_attempt > 0);
    }

    /** For the present attempt. */
    unsigned int
    cycles_left() const
    {
      return left_of_attempt;
    }

    /** By the present attempt. */
    bool
    is_spent() const
    {
      return left_of_attempt == 0;
    }

  private:
    unsigned int left, left_of_attempt;
  };



  /** When a multigrid iteration ends. */
  struct MultigridLimits
  {
    /// Relative increment, in the energy norm, that is small enough.
    double inner_tolerance = 1e-9;

    /// Energy norm of the error, as extrapolated from the increments, that is
    /// small enough; zero if this is not to be asked.
    double energy_tolerance = 0.;

    /// With this ratio of increments the first one says how large the error is;
    /// zero: it does not, and there are two cycles at least.
    double expected_pace = 0.;

    unsigned int maximum_cycles = 200;

    /// End early if the iteration would not arrive within maximum_cycles, or
    /// worthwhile_cycles if that is less, but not before this number of them,
    /// see MultigridResult::stalls(); zero: never.
    unsigned int patience          = 0;
    unsigned int worthwhile_cycles = std::numeric_limits<unsigned int>::max();

    /// Called after each cycle but the last one, once phases have settled, with
    /// the number of cycles done and how many more there would be at the pace
    /// of the last ones. Returns whether it has made the iterate the solution;
    /// if not, it has left the iterate as it was. May be empty.
    std::function<bool(const unsigned int, const double)> finish;

    /// For Newton's method as the end of another one, whose phases are thought
    /// to be right: a linear problem is given so many iterations, and the
    /// method ends with the first one whose residual has not come down to a
    /// hundredth then, or with a step that has to be halved more than once;
    /// zero: no such limits.
    unsigned int iterations_per_problem = 0;

    /// Ends when these are spent; null for no such limit.
    std::shared_ptr<CycleBudget> budget;
  };



  /** What a multigrid iteration has come to. */
  struct MultigridResult
  {
    bool                   converged = false;
    std::vector<CycleInfo> cycles;

    /// Energy norm of the error of the last iterate, extrapolated from the last
    /// increments.
    double algebraic_error = 0;

    /** Whether in the last four cycles as many components were held as now. */
    bool phases_have_settled() const;

    /** Cycles until increments would be as small as @p tolerance, at the pace
     * of the last four of them; infinity if they do not get smaller, and zero
     * if there are too few to tell. */
    double cycles_until(const double tolerance) const;

    /** Mean contraction of the increments, per cycle; zero if there were fewer
     * than two. */
    double contraction() const;

    /**
     * Whether the iteration is getting nowhere: at the pace of the last cycles,
     * two fifths of @p patience, measured against as many before, the
     * increments would not come down to @p tolerance within @p maximum_cycles
     * altogether. Says no as long as there are fewer cycles than @p patience,
     * since contact zones take some to grow into place, and as long as they
     * do: if more components are held in all of the last cycles than in those
     * before, or fewer, and their number still changes by one per cycle.
     */
    bool stalls(const double       tolerance,
                const unsigned int maximum_cycles,
                const unsigned int patience) const;
  };



  /**
   * A body that merely moves has no energy but that of rounding errors, with
   * which no increment should be compared. The diagonal of the matrix says what
   * energy a displacement of this size could have; this is the part of it that
   * counts as rounding. Collective.
   */
  template <int dim>
  double smallest_squared_norm(const DiscreteProblem<dim> &problem,
                               const VectorType           &u);



  /**
   * Repeats the steps of MonotoneMultigrid until the increments are small
   * enough, and keeps a record of them.
   *
   * Increments are measured between smoothed iterates, in the energy norm: A
   * times the difference of two iterates is the difference of their residuals,
   * which are known.
   *
   * @param iteration  which is used.
   * @param x          initial guess, admissible and with the prescribed values,
   *                   and solution. Values at hanging nodes are not touched.
   */
  template <int dim>
  MultigridResult run_multigrid(MonotoneMultigrid<dim> &iteration,
                                Iterate                &x,
                                const MultigridLimits  &limits,
                                const Progress         &progress = {});
} // namespace Friction

#endif

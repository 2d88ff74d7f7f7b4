#ifndef friction_algorithms_safeguarded_solver_h
#define friction_algorithms_safeguarded_solver_h

#include <common/algorithms/coulomb_solver.h>
#include <common/iteration/algebraic_correction.h>
#include <common/iteration/truncated_correction.h>

#include <memory>
#include <string>

namespace Friction
{
  /**
   * Solves the discrete contact problem by CoulombSolver, and if that gets
   * nowhere, by whatever else may succeed:
   *
   * 1. the algorithm of the settings, by default Algorithm 3;
   * 2. with Coulomb's friction the same algorithm with shorter steps, if phases
   *    were still changing; if they were not, or have stopped to, with
   *    AlgebraicCorrection, since the coarse levels may be the trouble, for
   *    example because cells are short in two of three directions;
   * 3. Algorithm 2 with half of each change of the normal forces, and with
   *    mixing, see MixedFixedPoint: if Coulomb's law was the trouble, because
   *    there is much friction. Each of its problems, with given normal forces,
   *    is convex, which makes it slow and reliable;
   * 4. Algorithm 2 with a fiftieth of each change, and without mixing until the
   *    normal forces have nearly settled: with so much friction that each
   *    change of them changes phases, too;
   * 5. continuation: first the problem with less friction, and its solution as
   *    initial guess for more, until all friction is there.
   *
   * Without friction, or with Tresca's, the problem is convex, and the last
   * three are left out. Each attempt starts where the one before has ended,
   * except for the last two, which start from the initial guess.
   *
   * The discrete problem has a solution whatever the coefficient of friction,
   * if some admissible displacement has no tangential part at the contact
   * nodes: then the map of normal forces to those of the solution with these
   * forces given is continuous and bounded, and Brouwer's theorem applies. But
   * it may have several, and a solution that is not found is reported as what
   * it is, by SolverReport::converged.
   *
   * All attempts together take SolverSettings::total_cycles cycles at most, and
   * each of them half of those that are left and the last one all, so that a
   * problem without hope comes to an end.
   */
  template <int dim>
  class SafeguardedSolver
  {
  public:
    /**
     * @param problem    whose coefficient of friction the last attempt changes
     *                   while it lasts.
     * @param levels     of the same problem, for corrections.
     * @param iteration  the step to begin with. Other attempts exchange one or
     *                   two of its parts and share all others.
     * @param settings   that the parts of the iteration have been made with.
     *
     * References are kept.
     */
    SafeguardedSolver(DiscreteProblem<dim>   &problem,
                      Levels<dim>            &levels,
                      MonotoneMultigrid<dim> &iteration,
                      const SolverSettings   &settings);

    /**
     * Solves, and certifies the solution; as CoulombSolver::solve(). The report
     * is that of the last attempt, with the cycles of all of them; if none has
     * succeeded, residual, energy and certificate are those of what is
     * returned.
     */
    SolverReport
    solve(VectorType &u, ContactState &state, const Progress &progress = {});

  private:
    DiscreteProblem<dim>   &problem;
    Levels<dim>            &levels;
    MonotoneMultigrid<dim> &iteration;
    const SolverSettings    settings;

    // Of the present solve().
    std::shared_ptr<CycleBudget> budget;

    // Parts of later attempts, made when the first of them is.
    std::unique_ptr<Linearization<dim>>       phases;
    std::unique_ptr<TruncatedCorrection<dim>> truncated;
    std::unique_ptr<AlgebraicCorrection<dim>> algebraic;
    LineSearch<dim>                           line_search, short_steps;

    // The iteration with the parts that are known to work best.
    MonotoneMultigrid<dim> best_iteration();

    Correction<dim> &algebraic_correction();

    // What is being solved, and what has been tried so far.
    struct Search
    {
      VectorType     &u;
      ContactState   &state;
      SolverReport   &all;
      const Progress &progress;
    };

    CoulombSettings first_settings() const;

    CoulombSettings fallback_settings() const;

    SolverReport attempt(const std::string      &name,
                         MonotoneMultigrid<dim> &with_iteration,
                         const CoulombSettings  &with_settings,
                         const Search           &search) const;

    SolverReport mixed_algorithm_2(const Search &search);

    SolverReport careful_algorithm_2(const Search &search);

    SolverReport continuation(const Search &search);
  };



  /** What has been tried, and what came of it, in one sentence; empty if the
   * first attempt was enough. */
  std::string describe_attempts(const SolverReport &report);
} // namespace Friction

#endif

#ifndef friction_algorithms_safeguarded_solver_h
#define friction_algorithms_safeguarded_solver_h

#include <common/algorithms/condensed_solver.h>
#include <common/algorithms/coulomb_solver.h>
#include <common/algorithms/newton_finish.h>
#include <common/algorithms/newton_solver.h>
#include <common/iteration/aggregate_correction.h>
#include <common/iteration/algebraic_correction.h>
#include <common/iteration/multigrid_newton_step.h>
#include <common/iteration/truncated_correction.h>

#include <memory>
#include <optional>
#include <string>

namespace Friction
{
  /**
   * Solves the discrete contact problem by CoulombSolver, and if that gets
   * nowhere, by what may succeed:
   *
   * 1. the algorithm of the settings on contact nodes alone, see
   *    CondensedSolver, if that takes no longer than a few cycles, and these go
   *    on to a given tolerance; or where coarse functions are known to be of
   *    little help: materials jump, or are nearly incompressible, or most nodes
   *    of a body in three dimensions are in lines. There have to be so few
   *    unknowns that this takes no longer than cycles, and with much friction
   *    it has to show soon that it gets somewhere. What fails there does not
   *    fail for want of good levels, so that what knows the law is tried next:
   *    6., 7. and 9., on contact nodes alone as well;
   * 2. the algorithm of the settings, by default Algorithm 3. With much
   *    friction, or where materials jump, it has to show soon that it gets
   *    somewhere. Unless materials jump or are nearly incompressible, so that
   *    levels are of little use, Newton's method may be its end, see
   *    NewtonFinish, and that of 3., and on contact nodes alone;
   * 3. the algorithm of the settings with AggregateCorrection, where there is
   *    not much friction and materials jump, or most nodes of a body in three
   *    dimensions are in lines of strong couplings: coarse functions do not
   *    follow borders of materials within coarse cells. Contact nodes alone
   *    come before that if they take no longer than some tens of cycles;
   * 4. contact nodes alone, if that takes no longer than some hundreds of
   *    cycles, whatever the material where there is not much friction; and
   *    then, if 2. was given up early because there was 3. to try, 2. once
   *    more, with all its time; and where a material is nearly incompressible,
   *    2. goes on from the best iterate, as long as an attempt makes the
   *    violation of the law ten times smaller;
   * 5. the algorithm of the settings with AlgebraicCorrection, where there is
   *    not much friction: then coarse levels are the trouble, for example
   *    because cells are short in two of three directions;
   * 6. where there is much friction, the law is the trouble. In two dimensions,
   *    on contact nodes alone, complementary pivoting, see PhasePath, if that
   *    takes no longer than a hundred cycles. Then Newton's method, if it has
   *    not been tried yet; if contact nodes alone take no longer than some
   *    cycles, so does each of its steps. Where it fails, pivoting, if it takes
   *    no longer than some hundreds;
   * 7. continuation by the same method: first the problem with so much less
   *    friction that it arrives, and its solution as initial guess for more,
   *    until all friction is there;
   * 8. algebraic corrections, if they have not been tried yet;
   * 9. Algorithm 2 with half of each change of the normal forces, and with
   *    mixing, see MixedFixedPoint. Each of its problems, with given normal
   *    forces, is convex, which makes it slow and reliable.
   *
   * The discrete problem has a solution whatever the coefficient of friction,
   * if displacements are prescribed that leave the body no rigid motion, and
   * some admissible displacement has no tangential part at the contact nodes:
   * then the map of normal forces to those of the solution with these
   * forces given is continuous and bounded, and Brouwer's theorem applies. In
   * two dimensions pivoting finds one. But there may be several, and a solution
   * that is not found is reported as what it is, by SolverReport::converged.
   *
   * All attempts of all calls of solve() together take
   * SolverSettings::total_cycles cycles at most, but for one in each of them,
   * and each attempt half of those that are left, 7. and 9. all if they come in
   * this order, so that a problem without hope, or a force that cannot be
   * reached, comes to an end. Without Coulomb's friction the problem is convex,
   * and 7 and 9 are left out.
   *
   * What has solved one problem is tried first on the next one, in the next
   * call of solve() and, by SolverReport::next_method, on the next mesh, 3.
   * before 5. if that has not failed on the same mesh; but Newton's method only
   * with much friction or on contact nodes alone. If contact nodes alone have,
   * and would take too long on the next mesh, 5. follows there at once, unless
   * a material is nearly incompressible.
   */
  template <int dim>
  class SafeguardedSolver
  {
  public:
    /**
     * @param problem    whose coefficient of friction continuation changes
     *                   while it lasts.
     * @param levels     of the same problem, for corrections.
     * @param iteration  the step to begin with. Other attempts exchange
     *                   some of its parts and share all others.
     * @param settings   that the parts of the iteration have been made with.
     * @param first      what to try first.
     *
     * References are kept.
     */
    SafeguardedSolver(DiscreteProblem<dim>   &problem,
                      Levels<dim>            &levels,
                      MonotoneMultigrid<dim> &iteration,
                      const SolverSettings   &settings,
                      const Method            first = Method::algorithm);

    /**
     * Makes the levels, unless contact nodes alone are going to be tried first
     * or corrections are algebraic. Otherwise solve() does that, for callers
     * that do not count its time apart. Collective. The arguments are the
     * initial guess.
     */
    void prepare(VectorType &u, ContactState &state);

    /**
     * Solves, and certifies the solution; as CoulombSolver::solve(). The report
     * is that of the last attempt, with the cycles of all of them; if none has
     * succeeded, residual, energy and certificate are those of what is
     * returned.
     * @param accuracy  if it is positive, relative increments of this size are
     *                  small enough, whatever is tried, and certificates are
     *                  not asked for: for solutions on the way to the one that
     *                  is wanted.
     */
    SolverReport solve(VectorType     &u,
                       ContactState   &state,
                       const Progress &progress = {},
                       const double    accuracy = 0.);

  private:
    DiscreteProblem<dim>   &problem;
    Levels<dim>            &levels;
    MonotoneMultigrid<dim> &iteration;
    const SolverSettings    settings;

    // That of the next call of solve(), to judge by those before.
    Method next_method;

    // On this mesh, which is that of all calls of solve(): whether materials
    // jump, once that has been asked, and whether levels made of the matrix
    // have failed.
    std::optional<bool> jumps;
    bool                aggregates_have_failed = false;

    // Of all calls of solve().
    const std::shared_ptr<CycleBudget> budget;

    // Parts of attempts after the first, made when the first of them needs it.
    std::unique_ptr<Linearization<dim>>       phases;
    std::unique_ptr<TruncatedCorrection<dim>> truncated;
    std::unique_ptr<AggregateCorrection<dim>> aggregates;
    std::unique_ptr<AlgebraicCorrection<dim>> algebraic;
    std::unique_ptr<NewtonStep<dim>>          newton_step;
    std::unique_ptr<NewtonSolver<dim>>        newton;
    std::unique_ptr<CondensedSolver<dim>>     condensed;
    LineSearch<dim>                           whole_steps;

    // What is being solved.
    struct Search
    {
      VectorType     &u;
      ContactState   &state;
      const Progress &progress;
      const double    accuracy; // as in solve()
    };

    // In which order: attempts.h.
    class Attempts;

    // Cycles that a method may take until it has to get somewhere. Where bounds
    // of friction react strongly to the displacement, methods with those of the
    // moment go to and fro from the beginning.
    static constexpr unsigned int patience = 50, short_patience = 8;

    // The law is to blame if something fails.
    bool much_friction() const;

    // A user who chooses other parts wants to see them work.
    bool has_defaults() const;

    // Those of the user, for a solution of this accuracy.
    CoulombSettings first_settings(const double accuracy) const;

    // What all attempts after the first have in common. They end by increments,
    // and not by an estimate of the error.
    CoulombSettings later_settings(const double accuracy) const;

    bool is_finite(const Search &search) const;

    bool materials_do_jump();

    bool mostly_lines_in_space() const;

    bool coarse_cells_may_be_to_blame();

    bool may_condense() const;

    bool begins_with_contact_nodes_alone(const Search &search);

    bool contact_nodes_alone_are_better(const Search &search,
                                        const bool    others_have_failed);

    using Condensed = CondensedSolver<dim>;

    SolverReport solve_condensed(const Search                &search,
                                 const typename Condensed::By method,
                                 const CoulombSettings       &limits);

    // On contact nodes alone, if that is cheap.
    std::optional<SolverReport>
    condensed_if_cheap(const Search                &search,
                       const typename Condensed::By method,
                       const CoulombSettings       &limits);

    SolverReport contact_nodes_alone(const Search &search);

    bool contact_nodes_alone_take_less(const Search &search,
                                       const double  n_cycles);

    bool newton_is_for_contact_nodes_alone(const Search &search);

    SolverReport aggregate_corrections(const Search &search);

    MonotoneMultigrid<dim> without_levels();

    SolverReport algebraic_corrections(const Search &search);

    SolverReport mixed_algorithm_2(const Search &search);

    // For the whole body, with levels.
    NewtonSolver<dim> &newton_with_levels();

    // By the algorithm of the settings, and by Newton's method at the end.
    SolverReport algorithm_to_the_end(MonotoneMultigrid<dim> &its_iteration,
                                      const CoulombSettings  &its_settings,
                                      const Search           &search);

    // By Newton's method or pivoting.
    bool all_of_the_law_is_for_contact_nodes_alone(const Search &search);

    // In two dimensions, on contact nodes alone.
    bool pivoting_is_possible(const Search &search,
                              const bool    others_have_failed);

    // None if the zone became too large.
    std::optional<SolverReport> pivoting(const Search &search);

    SolverReport newton_method(const Search      &search,
                               const unsigned int most_iterations);

    // @p solved is the largest coefficient with a solution.
    SolverReport continuation(const Search &search, double &solved);
  };



  /** What has been tried, and what came of it, in one sentence; empty if the
   * algorithm of the settings was tried first and was enough by itself. */
  std::string describe_attempts(const SolverReport &report);
} // namespace Friction

#endif

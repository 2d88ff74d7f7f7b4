#ifndef friction_algorithms_safeguarded_solver_h
#define friction_algorithms_safeguarded_solver_h

#include <common/algorithms/coulomb_solver.h>

#include <string>

namespace Friction
{
  /**
   * Solves the discrete contact problem by CoulombSolver, and if that gets
   * nowhere, by whatever else may succeed:
   *
   * 1. the algorithm of the settings, by default Algorithm 3;
   * 2. the same algorithm with shorter steps, if phases were still changing;
   *    otherwise, or if that fails, with AlgebraicCorrection: if the coarse
   *    levels were the trouble, for example because cells are a thousand times
   *    longer than wide;
   * 3. Algorithm 2 with half of each change of the normal forces, and with
   *    mixing, see MixedFixedPoint: if Coulomb's law was the trouble, because
   *    there is much friction. Each of its problems, with given normal forces,
   *    is convex, which makes it slow and reliable;
   * 4. Algorithm 2 with a fiftieth of each change, and without mixing until the
   *    normal forces have nearly settled: with so much friction that each
   * change of them changes phases, too;
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
   */
  template <int dim>
  class SafeguardedSolver
  {
  public:
    using Progress = typename CoulombSolver<dim>::Progress;

    /** As for CoulombSolver. */
    SafeguardedSolver(const LevelHierarchy<dim>  &hierarchy,
                      const DiscreteProblem<dim> &problem,
                      const SolverSettings       &settings);

    /**
     * Solves, and certifies the solution; as CoulombSolver::solve(). The report
     * is that of the last attempt, with the cycles of all of them; if none has
     * succeeded, residual, energy and certificate are those of what is
     * returned.
     */
    SolverReport
    solve(VectorType &u, ContactState &state, const Progress &progress = {});

  private:
    const LevelHierarchy<dim> &hierarchy;
    const DiscreteProblem<dim> problem;
    const SolverSettings       settings;
    CoulombSolver<dim>         first;

    SolverReport attempt(const std::string  &name,
                         CoulombSolver<dim> &solver,
                         VectorType         &u,
                         ContactState       &state,
                         SolverReport       &all,
                         const Progress     &progress) const;

    SolverReport mixed_algorithm_2(const double    coefficient,
                                   VectorType     &u,
                                   ContactState   &state,
                                   SolverReport   &all,
                                   const Progress &progress) const;

    SolverReport careful_algorithm_2(VectorType     &u,
                                     ContactState   &state,
                                     SolverReport   &all,
                                     const Progress &progress) const;

    SolverReport continuation(VectorType     &u,
                              ContactState   &state,
                              SolverReport   &all,
                              const Progress &progress) const;
  };



  /** What has been tried, and what came of it, in one sentence; empty if the
   * first attempt was enough. */
  std::string describe_attempts(const SolverReport &report);
} // namespace Friction

#endif

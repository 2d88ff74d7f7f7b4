#ifndef friction_algorithms_newton_finish_h
#define friction_algorithms_newton_finish_h

#include <common/algorithms/coulomb_solver.h>
#include <common/algorithms/newton_solver.h>

#include <functional>

namespace Friction
{
  /**
   * Algorithm 3, and Newton's method for the end of it, where that saves
   * cycles.
   *
   * Algorithm 3 finds phases from any guess. Once these have settled, each of
   * its cycles solves a linear problem with the bounds of friction of the
   * moment, and bounds follow displacements. Where many contact nodes lie close
   * to each other they follow slowly, however good the coarse correction is.
   * Newton's method, which is no good at finding phases, takes two to five
   * steps from there.
   *
   * If it is the coarse correction that is slow, Newton's linear problems are
   * slow, too: a first one that takes more than five iterations is the last
   * one, for good. A step that has to be halved more than once tells that
   * phases are not what they will be; and half of the cycles that would be left
   * are the most that Newton's method may take, or twelve. Where it ends like
   * this, Algorithm 3 goes on from its own iterate, and Newton's method has
   * another try after as many cycles again.
   */
  template <int dim>
  class NewtonFinish
  {
  public:
    using MakeNewton = std::function<NewtonSolver<dim> &()>;

    /**
     * @param iteration    for Algorithm 3; kept by reference.
     * @param make_newton  called when Newton's method is needed.
     * @param longest_end  how many cycles are worth its steps.
     */
    NewtonFinish(MonotoneMultigrid<dim> &iteration,
                 const MakeNewton       &make_newton,
                 const unsigned int      longest_end);

    /** As CoulombSolver::solve(); collective. Algorithm 2, and problems without
     * Coulomb's friction, are left to that. Cycles of the report are those of
     * both in the order in which they were made, see NewtonSolver::solve(). */
    SolverReport solve(VectorType            &u,
                       ContactState          &state,
                       const CoulombSettings &settings,
                       const Progress        &progress = {});

  private:
    MonotoneMultigrid<dim> &iteration;
    const MakeNewton        make_newton;
    const unsigned int      longest_end;
  };
} // namespace Friction

#endif

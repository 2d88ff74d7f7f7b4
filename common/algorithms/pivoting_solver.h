#ifndef friction_algorithms_pivoting_solver_h
#define friction_algorithms_pivoting_solver_h

#include <common/algorithms/newton_solver.h>

namespace Friction
{
  /**
   * Solves the contact problem in two dimensions by following a PhasePath from
   * the contact zone of the guess. Newton's method confirms what has been
   * found, and takes away rounding errors.
   *
   * The problem has a dense matrix, all nodes of which are on this process, as
   * that of CondensedSolver.
   *
   * @param newton  of the same problem, for the end.
   * @param u       initial guess with its prescribed values, and solution.
   * @param state   the phases and normal forces of both.
   * @param limits  of the cycles that are left no more than these are taken.
   * @return as solve_by_newton(). What the path has taken counts as so many
   *         iterations as steps of Newton's method take as many
   *         multiplications.
   */
  SolverReport solve_by_pivoting(NewtonSolver<2>       &newton,
                                 VectorType            &u,
                                 ContactState          &state,
                                 const CoulombSettings &limits,
                                 const Progress        &progress);
} // namespace Friction

#endif

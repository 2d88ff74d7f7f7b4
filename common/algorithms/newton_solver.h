#ifndef friction_algorithms_newton_solver_h
#define friction_algorithms_newton_solver_h

#include <common/algorithms/coulomb_solver.h>
#include <common/contact/semismooth_law.h>
#include <common/iteration/newton_equations.h>
#include <common/iteration/tresca_functional.h>

#include <vector>

namespace Friction
{
  /**
   * Newton's method for the laws of contact and friction, SemismoothLaw: for
   * the problems in which the bounds of friction react so strongly to the
   * displacement that iterations with bounds of the moment, Algorithms 2 and 3,
   * go to and fro.
   *
   * A step solves linear equations, NewtonEquations, by a MultigridNewtonStep,
   * or on contact nodes alone by a DenseNewtonStep.
   *
   * Linear problems are solved no more accurately than the step deserves
   * (Eisenstat and Walker 1996). There is no energy that would decrease. What
   * decides over the length of a step is the violation of the law, the
   * Euclidean norm of all nodal forces that are wrong; steps after the first
   * are halved until it decreases, six times at most. It is given up after
   * three steps in a row, or twelve altogether, that had to be halved so often,
   * and after sixty steps.
   */
  template <int dim>
  class NewtonSolver
  {
  public:
    /** References are kept. Collective.
     * @param linear_solver  for the equations of each step. */
    NewtonSolver(const TrescaFunctional<dim> &functional,
                 NewtonStep<dim>             &linear_solver);

    /**
     * Solves. Collective.
     * @param u      initial guess with its prescribed values, and solution.
     * @param state  the phases and normal forces of the guess, with which the
     *               first step reckons, and those of the solution.
     * @param limits Of these, one cycle is one iteration for linear
     *               equations, of which a dense factorisation takes one.
     * @return a record per iteration, with the increment of the step of
     *         Newton's method that it belongs to.
     */
    MultigridResult solve(VectorType            &u,
                          ContactState          &state,
                          const MultigridLimits &limits,
                          const Progress        &progress = {});

    const TrescaFunctional<dim> &
    tresca_functional() const
    {
      return functional;
    }

    /** Steps of Newton's method in the last solution. */
    unsigned int
    n_steps() const
    {
      return steps;
    }

    /** Bytes on this process, those for linear equations included. */
    std::size_t memory_consumption() const;

  private:
    const TrescaFunctional<dim>    &functional;
    const DiscreteProblem<dim>     &problem;
    NewtonStep<dim>                &linear_solver;
    NewtonEquations<dim>            equations;
    std::vector<SemismoothLaw<dim>> laws;
    unsigned int                    steps = 0;

    // f - A u; and an image under A.
    VectorType residual, image;

    // The norm of all nodal forces that are wrong.
    double violation(const VectorType &residual) const;

    bool same_phases(const std::vector<SemismoothLaw<dim>> &others) const;

    void set_state(ContactState &state, const VectorType &residual) const;
  };



  /** Solves, and certifies the solution, as CoulombSolver::solve() does.
   * Collective. */
  template <int dim>
  SolverReport solve_by_newton(NewtonSolver<dim>     &newton,
                               VectorType            &u,
                               ContactState          &state,
                               const CoulombSettings &limits,
                               const Progress        &progress = {});
} // namespace Friction

#endif

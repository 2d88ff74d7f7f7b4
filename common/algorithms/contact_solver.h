#ifndef friction_algorithms_contact_solver_h
#define friction_algorithms_contact_solver_h

#include <common/algorithms/safeguarded_solver.h>
#include <common/discretization/discretization.h>
#include <common/iteration/monotone_correction.h>

#include <memory>

namespace Friction
{
  /**
   * All that it takes to solve a discrete contact problem, made and put
   * together in one place as the settings say: levels, the five parts of a
   * step, and the safeguards around it. step-friction-2d does the same in view.
   */
  template <int dim>
  class ContactSolver
  {
  public:
    /** Collective. What the problem refers to is kept by reference.
     * @param first  see SafeguardedSolver. */
    ContactSolver(const Discretization<dim> &discretization,
                  const SolverSettings      &settings,
                  const Method               first = Method::algorithm);

    /** The same for another problem on the same mesh: other loads, for example,
     * or another coefficient of friction. */
    ContactSolver(const DoFHandler<dim>      &dof_handler,
                  const DiscreteProblem<dim> &problem,
                  const SolverSettings       &settings,
                  const Method                first = Method::algorithm);

    ContactSolver(const ContactSolver &) = delete;

    /** See SafeguardedSolver::prepare(). Collective. */
    void prepare(VectorType &u, ContactState &state);

    /** See SafeguardedSolver::solve(). Collective. */
    SolverReport solve(VectorType     &u,
                       ContactState   &state,
                       const Progress &progress = {},
                       const double    accuracy = 0.);

    Levels<dim> &
    levels()
    {
      return all_levels;
    }

  private:
    DiscreteProblem<dim>                    problem;
    const TrescaFunctional<dim>             functional;
    const MonotoneSmoother<dim>             smoother;
    Linearization<dim>                      linearization;
    Levels<dim>                             all_levels;
    const std::unique_ptr<Correction<dim>>  correction;
    const std::unique_ptr<StepControl<dim>> step_control;
    MonotoneMultigrid<dim>                  multigrid;
    SafeguardedSolver<dim>                  safeguarded;
  };



  /** The coarse correction that the settings ask for. */
  template <int dim>
  std::unique_ptr<Correction<dim>>
  make_correction(Levels<dim>                &levels,
                  const DiscreteProblem<dim> &problem,
                  const SolverSettings       &settings);

  /** The step control that goes with it. */
  template <int dim>
  std::unique_ptr<StepControl<dim>>
  make_step_control(const TrescaFunctional<dim> &functional,
                    const SolverSettings        &settings);
} // namespace Friction

#endif

#include <common/algorithms/contact_solver.h>
#include <common/iteration/aggregate_correction.h>

namespace Friction
{
  template <int dim>
  std::unique_ptr<Correction<dim>>
  make_correction(Levels<dim>                &levels,
                  const DiscreteProblem<dim> &problem,
                  const SolverSettings       &settings)
  {
    switch (settings.coarse_correction)
      {
        case CoarseCorrection::monotone:
          return std::make_unique<MonotoneCorrection<dim>>(
            levels, settings.cycle, settings.coarse_smoothing_steps);
        case CoarseCorrection::aggregates:
          return std::make_unique<AggregateCorrection<dim>>(
            levels, problem, settings.cycle, settings.coarse_smoothing_steps);
        case CoarseCorrection::algebraic:
          return std::make_unique<AlgebraicCorrection<dim>>(
            problem, settings.coarsest_method);
        default:
          return std::make_unique<TruncatedCorrection<dim>>(
            levels, settings.cycle, settings.coarse_smoothing_steps);
      }
  }



  template <int dim>
  std::unique_ptr<StepControl<dim>>
  make_step_control(const TrescaFunctional<dim> &functional,
                    const SolverSettings        &settings)
  {
    if (settings.coarse_correction == CoarseCorrection::monotone)
      return std::make_unique<FullStep<dim>>(functional);
    return std::make_unique<LineSearch<dim>>(
      functional, settings.maximum_step_length, settings.recombined_steps);
  }



  template <int dim>
  ContactSolver<dim>::ContactSolver(const Discretization<dim> &discretization,
                                    const SolverSettings      &settings,
                                    const Method               first)
    : ContactSolver(
        discretization.dof_handler(), discretization.problem(), settings, first)
  {}



  template <int dim>
  ContactSolver<dim>::ContactSolver(const DoFHandler<dim>      &dof_handler,
                                    const DiscreteProblem<dim> &the_problem,
                                    const SolverSettings       &settings,
                                    const Method                first)
    : problem(the_problem)
    , functional(problem)
    , smoother(problem, settings.local_solver)
    , linearization(problem, settings.truncation)
    , all_levels(dof_handler, problem, settings.coarsest_method)
    , correction(make_correction(all_levels, problem, settings))
    , step_control(make_step_control(functional, settings))
    , multigrid(functional,
                smoother,
                linearization,
                *correction,
                *step_control,
                settings.smoothing_steps)
    , safeguarded(problem, all_levels, multigrid, settings, first)
  {}



  template <int dim>
  void
  ContactSolver<dim>::prepare(VectorType &u, ContactState &state)
  {
    safeguarded.prepare(u, state);
  }



  template <int dim>
  SolverReport
  ContactSolver<dim>::solve(VectorType     &u,
                            ContactState   &state,
                            const Progress &progress,
                            const double    accuracy)
  {
    return safeguarded.solve(u, state, progress, accuracy);
  }



  template std::unique_ptr<Correction<2>> make_correction(
    Levels<2> &, const DiscreteProblem<2> &, const SolverSettings &);
  template std::unique_ptr<Correction<3>> make_correction(
    Levels<3> &, const DiscreteProblem<3> &, const SolverSettings &);
  template std::unique_ptr<StepControl<2>>
  make_step_control(const TrescaFunctional<2> &, const SolverSettings &);
  template std::unique_ptr<StepControl<3>>
  make_step_control(const TrescaFunctional<3> &, const SolverSettings &);

  template class ContactSolver<2>;
  template class ContactSolver<3>;
} // namespace Friction

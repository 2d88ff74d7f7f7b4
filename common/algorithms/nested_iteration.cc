#include <common/algorithms/initial_guess.h>
#include <common/algorithms/nested_iteration.h>
#include <common/contact/contact_forces.h>
#include <common/discretization/mesh_refinement.h>
#include <common/estimate/contact_estimate.h>
#include <common/estimate/marking.h>

#include <deal.II/base/timer.h>

namespace Friction
{
  template <int dim>
  NestedIteration<dim>::NestedIteration(const Parameters    &parameters,
                                        const CellForm<dim> &form,
                                        const MPI_Comm       communicator,
                                        const bool           from_checkpoint)
    : the_parameters(parameters)
    , the_scene(parameters)
    , bilinear_form(form ? form : elasticity<dim>(the_scene.materials()))
    , triangulation(make_triangulation<dim>(
        communicator, from_checkpoint || the_parameters.output.checkpoint))
    , the_discretization(the_scene, *triangulation)
    , stop(the_parameters.solver)
    , force_control(the_scene)
    , contact_state(0, false)
  {}



  template <int dim>
  void
  NestedIteration<dim>::begin()
  {
    the_scene.make_coarse_mesh(*triangulation);
    refine_uniformly(*triangulation,
                     the_parameters.refinement.initial_refinements);
    begin_on_level(0);
  }



  template <int dim>
  void
  NestedIteration<dim>::begin_on_level(const unsigned int         level,
                                       const unsigned int         load_step,
                                       const std::vector<double> &platens)
  {
    the_level = level;
    the_scene.begin_load_step(load_step);
    if (!platens.empty())
      force_control.restore(platens);
    the_discretization.set_up();
    the_discretization.assemble(bilinear_form);
    guessed_displacement = the_discretization.vector();
    guessed_tractions    = guessed_displacement;
  }



  template <int dim>
  ContactState
  NestedIteration<dim>::make_guess(VectorType &guess) const
  {
    guess = guessed_displacement;
    return make_initial_guess(the_discretization, guess, guessed_tractions);
  }



  template <int dim>
  SolverReport
  NestedIteration<dim>::solve_with(const SolverSettings &settings,
                                   VectorType           &solution,
                                   ContactState         &state,
                                   const Progress       &progress)
  {
    Timer timer;
    state = make_guess(solution);
    ContactSolver<dim> solver(
      the_discretization, settings, last_report.next_method);
    solver.prepare(solution, state);
    solver_setup_seconds = timer.wall_time();
    timer.restart();
    const SolverReport report = force_control.solve(
      the_discretization,
      solution,
      state,
      settings,
      [&](const double accuracy) {
        return solver.solve(solution, state, progress, accuracy);
      });
    solution_seconds = timer.wall_time();
    the_discretization.interpolate_hanging_nodes(solution);
    return report;
  }



  template <int dim>
  const SolverReport &
  NestedIteration<dim>::solve(const Progress &progress)
  {
    VectorType         solution;
    ContactState       state(0, false);
    const SolverReport report =
      solve_with(stop.settings_for(the_discretization.dof_handler().n_dofs()),
                 solution,
                 state,
                 progress);
    accept(solution, state, report);
    return last_report;
  }



  template <int dim>
  void
  NestedIteration<dim>::accept(const VectorType   &solution,
                               const ContactState &state,
                               const SolverReport &report)
  {
    u             = solution;
    contact_state = state;
    last_report   = report;
    contact_stresses =
      contact_tractions(the_discretization.contact(), report.residual, state);
    the_discretization.interpolate_hanging_nodes(u);
    the_discretization.interpolate_hanging_nodes(contact_stresses);
  }



  template <int dim>
  bool
  NestedIteration<dim>::needs_estimate() const
  {
    const bool stops = the_parameters.solver.stop_at_discretization;
    if (is_last())
      return stops && the_scene.load_step() + 1 < the_scene.n_load_steps();
    return stops ||
      the_parameters.refinement.strategy == RefinementStrategy::adaptive;
  }



  template <int dim>
  bool
  NestedIteration<dim>::wants_estimate() const
  {
    return the_parameters.refinement.estimate_error || needs_estimate();
  }



  template <int dim>
  ErrorEstimate
  NestedIteration<dim>::estimate() const
  {
    return estimate_contact_error(the_discretization, u, contact_stresses);
  }



  template <int dim>
  void
  NestedIteration<dim>::learn(const ErrorEstimate &estimate)
  {
    add_level(estimate.lower_bound,
              the_discretization.dof_handler().n_dofs(),
              last_report.pace);
  }



  template <int dim>
  void
  NestedIteration<dim>::add_level(const double error_at_least,
                                  const dealii::types::global_dof_index n_dofs,
                                  const double                          pace)
  {
    stop.add_level(error_at_least, n_dofs, pace);
  }



  template <int dim>
  bool
  NestedIteration<dim>::is_last() const
  {
    return the_scene.load_step() > 0 ||
      the_level >= the_parameters.refinement.levels ||
      the_discretization.dof_handler().n_dofs() >=
      the_parameters.refinement.maximum_dofs;
  }



  template <int dim>
  void
  NestedIteration<dim>::mark_all()
  {
    triangulation->set_all_refine_flags();
  }



  template <int dim>
  bool
  NestedIteration<dim>::mark(const ErrorEstimate &estimate)
  {
    if (the_parameters.refinement.strategy == RefinementStrategy::uniform)
      {
        mark_all();
        return true;
      }
    bool any = mark_by_maximum(*triangulation,
                               estimate.cell_errors,
                               the_parameters.refinement.marking) > 0;
    if (the_parameters.refinement.contact_zone)
      any |= mark_contact_zone(the_discretization, contact_state);
    return any;
  }



  template <int dim>
  void
  NestedIteration<dim>::refine()
  {
    Assert(u.size() == the_discretization.dof_handler().n_dofs(),
           ExcMessage("There is no solution on this mesh."));
    ++the_level;
    // What belongs to the mesh before is of no use any more.
    guessed_displacement.swap(u);
    guessed_tractions.swap(contact_stresses);
    for (VectorType *of_last_mesh :
         {&u, &contact_stresses, &last_report.residual})
      of_last_mesh->reinit(0);
    guessed_displacement.update_ghost_values();
    guessed_tractions.update_ghost_values();
    refine_mesh(*triangulation,
                the_discretization,
                {&guessed_displacement, &guessed_tractions});
    the_discretization.assemble(bilinear_form);
  }



  template <int dim>
  bool
  NestedIteration<dim>::advance()
  {
    const ErrorEstimate estimated =
      needs_estimate() ? estimate() : ErrorEstimate();
    learn(estimated);
    if (is_last() || !mark(estimated))
      return false;
    refine();
    return true;
  }



  template <int dim>
  bool
  NestedIteration<dim>::begin_next_load_step()
  {
    if (the_scene.load_step() + 1 == the_scene.n_load_steps())
      return false;
    ++the_level;
    guessed_displacement = u;
    guessed_tractions    = contact_stresses;
    load_steps.begin_next(the_scene,
                          the_discretization,
                          force_control,
                          guessed_displacement,
                          guessed_tractions);
    the_discretization.assemble(bilinear_form);
    return true;
  }



  template class NestedIteration<2>;
  template class NestedIteration<3>;
} // namespace Friction

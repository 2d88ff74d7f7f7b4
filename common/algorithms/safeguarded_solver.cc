#include <common/algorithms/attempts.h>
#include <common/parallel/reductions.h>
#include <common/parallel/run_clock.h>
#include <common/printable.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>

namespace Friction
{
  namespace
  {
    // How many cycles of an easy material contact nodes alone may take the time
    // of, where materials jump or are nearly incompressible, or most nodes are
    // in lines. If the solution is to be as exact as its mesh:
    template <int dim>
    constexpr double cycles_to_expect = (dim == 2 ? 12 : 24);

    // To a given tolerance, with the ratio of Lame's constants that the
    // material has; cycles are the more, and the dearer, the less compressible
    // it is, see doc/benchmark/incompressible.txt. Where others have failed, it
    // is as many as are ever worth while, but for pivoting.
    template <int dim>
    double
    cycles_to_the_end(const double lame_ratio)
    {
      return std::max(dim == 2 ? 60. : 36.,
                      5. * std::sqrt(std::max(0., lame_ratio)));
    }

    // And for any material, to a given tolerance; and unknowns up to which that
    // is possible.
    template <int dim>
    constexpr double quick_cycles = (dim == 2 ? 4 : 2);

    template <int dim>
    constexpr types::global_dof_index largest_quick = (dim == 2 ? 5000 : 8000);

    // Where Newton's method would be next; and levels made of the matrix, of
    // which a cycle takes as long as several.
    constexpr double cycles_of_newton = 36, cycles_of_aggregates = 60;

    // Where pivoting would be, which arrives for certain.
    constexpr double cycles_of_pivoting = 100;

    // And for what does not arrive for certain, where others have failed.
    constexpr double most_cycles_alone = 400;

    // Unknowns on contact nodes up to which pivoting has the memory, some five
    // dense matrices.
    constexpr unsigned int largest_path = 4000;



    // Newton's method takes over once phases have settled if Algorithm 3 would
    // go on for more cycles than this.
    constexpr unsigned int longest_end = 20;



    // How many times as long as has been expected it may take if more nodes
    // turn out to touch.
    constexpr double allowed_growth = 3;
  } // namespace



  template <int dim>
  SafeguardedSolver<dim>::SafeguardedSolver(DiscreteProblem<dim>   &problem,
                                            Levels<dim>            &levels,
                                            MonotoneMultigrid<dim> &iteration,
                                            const SolverSettings   &settings,
                                            const Method            first)
    : problem(problem)
    , levels(levels)
    , iteration(iteration)
    , settings(settings)
    , next_method(first)
    , budget(std::make_shared<CycleBudget>(settings.total_cycles))
    , whole_steps(
        iteration.functional(), std::min(1., settings.maximum_step_length), 0)
  {
    Assert(&problem == &iteration.problem(),
           ExcMessage("The iteration is that of another problem."));
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::much_friction() const
  {
    return problem.has_coulomb_friction() &&
      problem.effective_coefficient() > 1.;
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::has_defaults() const
  {
    return settings.algorithm != Algorithm::fixed_point &&
      settings.coarse_correction == CoarseCorrection::truncated;
  }



  template <int dim>
  CoulombSettings
  SafeguardedSolver<dim>::first_settings(const double accuracy) const
  {
    CoulombSettings result(settings);
    if (accuracy > 0.)
      {
        result.limits.inner_tolerance =
          std::max(accuracy, result.limits.inner_tolerance);
        result.outer_tolerance = std::max(accuracy, result.outer_tolerance);
        result.certificate_tolerance = std::numeric_limits<double>::infinity();
      }
    return result;
  }



  template <int dim>
  CoulombSettings
  SafeguardedSolver<dim>::later_settings(const double accuracy) const
  {
    CoulombSettings result         = first_settings(accuracy);
    result.limits.energy_tolerance = 0.;
    result.limits.patience         = patience;
    result.limits.budget           = budget;
    return result;
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::is_finite(const Search &search) const
  {
    bool infinite = false;
    for (unsigned int i = 0; i < search.u.locally_owned_size(); ++i)
      infinite = infinite || !std::isfinite(search.u.local_element(i));
    for (unsigned int p = 0; p < search.state.size(); ++p)
      infinite = infinite || !std::isfinite(search.state.normal_force(p));
    return !true_on_any_process(infinite, problem.communicator());
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::materials_do_jump()
  {
    if (!jumps)
      jumps =
        materials_jump(problem.stiffness.blocks(), problem.communicator());
    return *jumps;
  }



  // In two dimensions relaxation of lines is all that stretched cells need, and
  // planes are enough where cells are long, so that only lines count.
  template <int dim>
  bool
  SafeguardedSolver<dim>::mostly_lines_in_space() const
  {
    constexpr double mostly = .5;
    return dim == 3 &&
      levels.share_in_lines(levels.n_correction_levels()) >= mostly;
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::coarse_cells_may_be_to_blame()
  {
    return has_defaults() && !much_friction() &&
      levels.hierarchy().n_levels() > 1 &&
      (mostly_lines_in_space() || materials_do_jump());
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::may_condense() const
  {
    return settings.condensation != CondensationUse::never && has_defaults();
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::contact_nodes_alone_are_better(
    const Search &search, const bool others_have_failed)
  {
    if (!may_condense())
      return false;
    if (settings.condensation == CondensationUse::where_quicker &&
        settings.energy_tolerance == 0. &&
        problem.constraints.partitioner()->size() <= largest_quick<dim> &&
        contact_nodes_alone_take_less(search, quick_cycles<dim>))
      return true;
    if (!(settings.nearly_incompressible() ||
          (others_have_failed && !much_friction()) || materials_do_jump() ||
          mostly_lines_in_space()))
      return false;
    const bool aggregates_are_left = others_have_failed &&
      !aggregates_have_failed && coarse_cells_may_be_to_blame();
    double n_cycles = most_cycles_alone;
    if (!others_have_failed || aggregates_are_left)
      {
        n_cycles = std::min(n_cycles,
                            settings.energy_tolerance > 0.
                              ? cycles_to_expect<dim>
                              : cycles_to_the_end<dim>(settings.lame_ratio));
        if (aggregates_are_left && settings.energy_tolerance == 0.)
          n_cycles = std::max(n_cycles, cycles_of_aggregates);
        // What fails there is left to Newton's method there.
        if (much_friction())
          n_cycles = std::min(n_cycles, cycles_of_newton);
      }
    return contact_nodes_alone_take_less(search, n_cycles);
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::contact_nodes_alone_take_less(const Search &search,
                                                        const double  n_cycles)
  {
    if (!condensed)
      condensed = std::make_unique<CondensedSolver<dim>>(
        problem,
        node_positions(levels.dof_handler(), problem.constraints),
        settings,
        Iterate(search.u, search.state));
    if (!condensed->is_worthwhile(n_cycles))
      return false;
    condensed->give_up_beyond(std::max(
      n_cycles, std::min(allowed_growth * n_cycles, most_cycles_alone)));
    return true;
  }



  // A step takes a factorisation there, and some iterations elsewhere.
  template <int dim>
  bool
  SafeguardedSolver<dim>::newton_is_for_contact_nodes_alone(
    const Search &search)
  {
    return may_condense() &&
      contact_nodes_alone_take_less(search, cycles_of_newton);
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::solve_condensed(const Search                &search,
                                          const typename Condensed::By method,
                                          const CoulombSettings       &limits)
  {
    return condensed->solve(
      iteration.functional(),
      Iterate(search.u, search.state, problem.has_coulomb_friction()),
      method,
      limits,
      search.progress);
  }



  // None if the matrix could not be factorised or the zone became too large,
  // either.
  template <int dim>
  std::optional<SolverReport>
  SafeguardedSolver<dim>::condensed_if_cheap(
    const Search                &search,
    const typename Condensed::By method,
    const CoulombSettings       &limits)
  {
    if (!newton_is_for_contact_nodes_alone(search))
      return {};
    const SolverReport report = solve_condensed(search, method, limits);
    if (condensed->has_given_up())
      return {};
    return report;
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::contact_nodes_alone(const Search &search)
  {
    CoulombSettings its_settings = later_settings(search.accuracy);
    if (much_friction())
      its_settings.limits.patience = short_patience;
    return solve_condensed(search, Condensed::By::coulomb_solver, its_settings);
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::aggregate_corrections(const Search &search)
  {
    if (!aggregates)
      aggregates = std::make_unique<AggregateCorrection<dim>>(
        levels, problem, settings.cycle, settings.coarse_smoothing_steps);
    MonotoneMultigrid<dim> best = iteration.with(*aggregates);
    return algorithm_to_the_end(best, later_settings(search.accuracy), search);
  }



  // Whole steps at most, each of its own direction: a line search works with
  // the normal forces of the moment and may go too far for those that come.
  template <int dim>
  MonotoneMultigrid<dim>
  SafeguardedSolver<dim>::without_levels()
  {
    if (!phases)
      phases = std::make_unique<Linearization<dim>>(problem,
                                                    TruncationVariant::phases);
    if (!algebraic)
      algebraic = std::make_unique<AlgebraicCorrection<dim>>(
        problem, CoarsestMethod::automatic);
    return iteration.with(*phases).with(*algebraic).with(whole_steps);
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::algebraic_corrections(const Search &search)
  {
    MonotoneMultigrid<dim> best = without_levels();
    return CoulombSolver<dim>(best, later_settings(search.accuracy))
      .solve(search.u, search.state, search.progress);
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::mixed_algorithm_2(const Search &search)
  {
    const VectorType   start       = search.u;
    const ContactState start_state = search.state;
    CoulombSettings    mixed       = later_settings(search.accuracy);
    mixed.algorithm                = Algorithm::fixed_point;
    mixed.outer_damping            = .5;
    mixed.mixed_outer_iterations   = 10;
    mixed.maximum_outer_iterations =
      std::max(200u, settings.maximum_outer_iterations);
    if (const std::optional<SolverReport> report =
          condensed_if_cheap(search, Condensed::By::coulomb_solver, mixed))
      return *report;
    SolverReport report = CoulombSolver<dim>(iteration, mixed)
                            .solve(search.u, search.state, search.progress);
    if (report.inner_converged || budget->is_spent())
      return report;

    if (!is_finite(search))
      {
        search.u     = start;
        search.state = start_state;
      }
    const std::vector<CycleInfo> cycles = report.cycles;
    MonotoneMultigrid<dim>       best   = without_levels();
    report                              = CoulombSolver<dim>(best, mixed)
               .solve(search.u, search.state, search.progress);
    report.cycles.insert(report.cycles.begin(), cycles.begin(), cycles.end());
    return report;
  }



  template <int dim>
  NewtonSolver<dim> &
  SafeguardedSolver<dim>::newton_with_levels()
  {
    if (!newton)
      {
        truncated = std::make_unique<TruncatedCorrection<dim>>(
          levels, settings.cycle, settings.coarse_smoothing_steps);
        newton_step = std::make_unique<MultigridNewtonStep<dim>>(
          problem,
          iteration.leading_smoother(),
          levels,
          *truncated,
          settings.smoothing_steps);
        newton = std::make_unique<NewtonSolver<dim>>(iteration.functional(),
                                                     *newton_step);
      }
    return *newton;
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::algorithm_to_the_end(
    MonotoneMultigrid<dim> &its_iteration,
    const CoulombSettings  &its_settings,
    const Search           &search)
  {
    // With lines in space the levels of the mesh may be good ones, also where
    // those of the matrix are tried.
    if (!settings.has_default_corrections() ||
        settings.nearly_incompressible() || materials_do_jump())
      return CoulombSolver<dim>(its_iteration, its_settings)
        .solve(search.u, search.state, search.progress);
    return NewtonFinish<dim>(
             its_iteration,
             [this]() -> NewtonSolver<dim> & { return newton_with_levels(); },
             longest_end)
      .solve(search.u, search.state, its_settings, search.progress);
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::all_of_the_law_is_for_contact_nodes_alone(
    const Search &search)
  {
    return newton_is_for_contact_nodes_alone(search) ||
      pivoting_is_possible(search, /*others_have_failed =*/false);
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::pivoting_is_possible(const Search &search,
                                               const bool    others_have_failed)
  {
    return dim == 2 && problem.has_coulomb_friction() && may_condense() &&
      contact_nodes_alone_take_less(search,
                                    others_have_failed ? Condensed::most_cycles
                                                       : cycles_of_pivoting) &&
      condensed->n_unknowns() <= largest_path;
  }



  template <int dim>
  std::optional<SolverReport>
  SafeguardedSolver<dim>::pivoting(const Search &search)
  {
    const SolverReport report = solve_condensed(
      search, Condensed::By::pivoting, later_settings(search.accuracy));
    if (condensed->has_given_up())
      return {};
    return report;
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::newton_method(const Search      &search,
                                        const unsigned int most_iterations)
  {
    CoulombSettings its_settings = later_settings(search.accuracy);
    its_settings.limits.maximum_cycles =
      std::min(its_settings.limits.maximum_cycles, most_iterations);
    if (const std::optional<SolverReport> report = condensed_if_cheap(
          search, Condensed::By::newton_solver, its_settings))
      return *report;

    SolverReport report = solve_by_newton(newton_with_levels(),
                                          search.u,
                                          search.state,
                                          its_settings,
                                          search.progress);
    report.solver_memory += iteration.leading_smoother().memory_consumption();
    return report;
  }



  // The guess may be a good one: so it is tried with less and less friction
  // until Newton's method arrives, each time with half of the iterations that
  // are left. From there the coefficient is doubled for as long as that works,
  // and multiplied by the square root of the last factor where it does not. If
  // that does not lead to the end, either, it begins lower.
  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::continuation(const Search &search, double &solved)
  {
    const double target = problem.friction_coefficient;
    // Also if a callback throws.
    const std::shared_ptr<void> restores_coefficient(
      nullptr, [&](void *) { problem.friction_coefficient = target; });
    // Where most problems are easy.
    const double           easy            = std::min(.25, target / 2);
    constexpr double       way_down        = 4;
    constexpr double       smallest_factor = 1.05;
    const VectorType       guess           = search.u;
    const ContactState     guess_state     = search.state;
    SolverReport           report;
    std::vector<CycleInfo> cycles;
    const auto             arrives_at = [&](const double       coefficient,
                                const unsigned int most_iterations) {
      VectorType   next            = search.u;
      ContactState next_state      = search.state;
      problem.friction_coefficient = coefficient;
      report                       = newton_method(
        {next, next_state, search.progress, search.accuracy}, most_iterations);
      cycles.insert(cycles.end(), report.cycles.begin(), report.cycles.end());
      if (report.converged)
        {
          solved       = std::max(solved, coefficient);
          search.u     = next;
          search.state = next_state;
        }
      return report.converged;
    };

    solved = 0;
    for (double first = target;
         first > easy && solved < target && !budget->is_spent();)
      {
        first        = std::max(easy, first / way_down);
        search.u     = guess;
        search.state = guess_state;
        if (!arrives_at(first, (budget->cycles_left() + 1) / 2))
          continue;
        double reached = first;
        for (double factor = 2; reached < target && factor >= smallest_factor &&
             !budget->is_spent();)
          {
            const double next = std::min(reached * factor, target);
            if (arrives_at(next, budget->cycles_left()))
              reached = next;
            else
              factor = std::sqrt(next / reached);
          }
      }
    report.converged = report.converged && solved == target;
    report.cycles    = cycles;
    if (!report.converged)
      {
        // Of what is returned, with all friction.
        problem.friction_coefficient = target;
        certify(report, iteration.functional(), search.u, search.state);
      }
    return report;
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::begins_with_contact_nodes_alone(const Search &search)
  {
    return (next_method == Method::newton &&
            all_of_the_law_is_for_contact_nodes_alone(search)) ||
      contact_nodes_alone_are_better(search,
                                     next_method == Method::contact_nodes);
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::prepare(VectorType &u, ContactState &state)
  {
    const RunScope part(problem.communicator(), RunPart::solution);
    const Progress none;
    if (settings.coarse_correction != CoarseCorrection::algebraic &&
        (!settings.safeguards ||
         !begins_with_contact_nodes_alone({u, state, none, 0.})))
      levels.make_now();
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::solve(VectorType     &u,
                                ContactState   &state,
                                const Progress &progress,
                                const double    accuracy)
  {
    const RunScope part(problem.communicator(), RunPart::solution);
    const Search   search{u, state, progress, accuracy};
    if (settings.safeguards)
      return Attempts(*this, search).run();
    return CoulombSolver<dim>(iteration, first_settings(accuracy))
      .solve(u, state, progress);
  }



  std::string
  describe_attempts(const SolverReport &report)
  {
    std::string text;
    for (const SolverAttempt &attempt : report.attempts)
      text += (text.empty() ? "" : "; ") + attempt.name +
        (attempt.converged ? " took " : " was given up after ") +
        counted(attempt.cycles, "cycle", "cycles");
    if (!text.empty())
      text[0] = std::toupper(static_cast<unsigned char>(text[0]));
    return text.empty() ? text : text + ".";
  }



  template class SafeguardedSolver<2>;
  template class SafeguardedSolver<3>;
} // namespace Friction

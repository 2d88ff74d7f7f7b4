#include <common/algorithms/safeguarded_solver.h>
#include <common/parallel/reductions.h>
#include <common/parallel/run_clock.h>
#include <common/printable.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>

namespace Friction
{
  namespace
  {
    // Without friction, and with given bounds, there is nothing to iterate but
    // the multigrid method.
    template <int dim>
    std::string
    name_of(const DiscreteProblem<dim> &problem, const SolverSettings &settings)
    {
      if (!problem.has_coulomb_friction())
        return "the multigrid iteration";
      return settings.algorithm == Algorithm::fixed_point ? "Algorithm 2"
                                                          : "Algorithm 3";
    }



    // Whether phases were still changing when an iteration ended: then it is
    // not slow coarse corrections that it died of.
    bool
    phases_change(const SolverReport &report)
    {
      const auto  &cycles = report.cycles;
      const auto   n      = std::min<std::size_t>(cycles.size(), 10);
      unsigned int change = 0;
      for (std::size_t i = cycles.size() - n + 1; i < cycles.size(); ++i)
        change += (cycles[i].truncated != cycles[i - 1].truncated);
      return change > 0;
    }



    bool
    is_finite(const VectorType   &u,
              const ContactState &state,
              const MPI_Comm      comm)
    {
      bool infinite = false;
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        infinite = infinite || !std::isfinite(u.local_element(i));
      for (unsigned int p = 0; p < state.size(); ++p)
        infinite = infinite || !std::isfinite(state.normal_force(p));
      return !true_on_any_process(infinite, comm);
    }



    // Notes what has been tried: its outcome, and all the cycles that it took,
    // which may be those of several solutions.
    void
    add_attempt(SolverReport                 &all,
                const std::string            &name,
                const SolverReport           &outcome,
                const std::vector<CycleInfo> &cycles)
    {
      all.attempts.push_back({name,
                              static_cast<unsigned int>(cycles.size()),
                              outcome.converged,
                              outcome.certificate.largest()});
      all.cycles.insert(all.cycles.end(), cycles.begin(), cycles.end());
    }
  } // namespace



  template <int dim>
  SafeguardedSolver<dim>::SafeguardedSolver(DiscreteProblem<dim>   &problem,
                                            Levels<dim>            &levels,
                                            MonotoneMultigrid<dim> &iteration,
                                            const SolverSettings   &settings)
    : problem(problem)
    , levels(levels)
    , iteration(iteration)
    , settings(settings)
    , line_search(iteration.functional(),
                  settings.maximum_step_length,
                  settings.recombined_steps)
    , short_steps(
        iteration.functional(), std::min(.5, settings.maximum_step_length), 0)
  {
    Assert(&problem == &iteration.problem(),
           ExcMessage("The iteration is that of another problem."));
  }



  // Whatever an attempt is, it may give up when it is getting nowhere.
  template <int dim>
  CoulombSettings
  SafeguardedSolver<dim>::first_settings() const
  {
    CoulombSettings result(settings);
    result.limits.gives_up_early = true;
    result.limits.budget         = budget;
    return result;
  }



  // What all other attempts have in common. They are to find a solution, to the
  // usual tolerance.
  template <int dim>
  CoulombSettings
  SafeguardedSolver<dim>::fallback_settings() const
  {
    CoulombSettings result         = first_settings();
    result.limits.energy_tolerance = 0.;
    return result;
  }



  template <int dim>
  MonotoneMultigrid<dim>
  SafeguardedSolver<dim>::best_iteration()
  {
    MonotoneMultigrid<dim> result = iteration.with(line_search);
    if (settings.truncation != TruncationVariant::phases)
      {
        if (!phases)
          phases = std::make_unique<Linearization<dim>>(
            problem, TruncationVariant::phases);
        result = result.with(*phases);
      }
    if (settings.coarse_correction != CoarseCorrection::truncated)
      {
        if (!truncated)
          truncated = std::make_unique<TruncatedCorrection<dim>>(
            levels, settings.cycle, settings.coarse_smoothing_steps);
        result = result.with(*truncated);
      }
    return result;
  }



  template <int dim>
  Correction<dim> &
  SafeguardedSolver<dim>::algebraic_correction()
  {
    if (!algebraic)
      algebraic = std::make_unique<AlgebraicCorrection<dim>>(
        problem, settings.coarsest_method);
    return *algebraic;
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::attempt(const std::string      &name,
                                  MonotoneMultigrid<dim> &with_iteration,
                                  const CoulombSettings  &with_settings,
                                  const Search           &search) const
  {
    const VectorType   start       = search.u;
    const ContactState start_state = search.state;
    SolverReport report = CoulombSolver<dim>(with_iteration, with_settings)
                            .solve(search.u, search.state, search.progress);
    add_attempt(search.all, name, report, report.cycles);
    if (!is_finite(search.u, search.state, problem.communicator()))
      {
        search.u     = start;
        search.state = start_state;
      }
    return report;
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::solve(VectorType     &u,
                                ContactState   &state,
                                const Progress &progress)
  {
    const RunScope part(problem.communicator(), RunPart::solution);
    if (!settings.safeguards)
      return CoulombSolver<dim>(iteration, CoulombSettings(settings))
        .solve(u, state, progress);

    budget = std::make_shared<CycleBudget>(settings.total_cycles);
    budget->begin_attempt();
    const PhaseCosts   before        = phase_costs(problem.communicator());
    const bool         coulomb       = problem.has_coulomb_friction();
    const VectorType   initial       = u;
    const ContactState initial_state = state;
    const std::string  name          = name_of(problem, settings);
    SolverReport       all;
    const Search       search = {u, state, all, progress};
    SolverReport report = attempt(name, iteration, first_settings(), search);

    // If nothing succeeds, what violates the law least is returned.
    double       smallest_violation = std::numeric_limits<double>::infinity();
    VectorType   best_u;
    ContactState best_state(0, false);
    const auto   keep_best = [&](const VectorType   &other,
                               const ContactState &other_state) {
      const double violation = report.certificate.largest();
      if (report.converged || !(violation < smallest_violation))
        return;
      smallest_violation = violation;
      best_u             = other;
      best_state         = other_state;
    };
    keep_best(u, state);

    if (!report.converged)
      {
        // Shorter steps, each of its own direction: a line search works with
        // the normal forces of the moment and may go too far for those that
        // come.
        MonotoneMultigrid<dim> cautious = best_iteration().with(short_steps);
        // Where only the outer iteration of Algorithm 2 has failed, neither of
        // the two attempts that follow would be any better.
        const bool outer_failure = coulomb && report.inner_converged &&
          settings.algorithm == Algorithm::fixed_point;
        bool slow_corrections =
          !outer_failure && (!coulomb || !phases_change(report));
        if (!slow_corrections && !outer_failure && budget->begin_attempt())
          {
            report           = attempt(name + " with short steps",
                             cautious,
                             fallback_settings(),
                             search);
            slow_corrections = !phases_change(report);
            keep_best(u, state);
          }
        if (!report.converged && slow_corrections && budget->begin_attempt())
          {
            LineSearch<dim> whole_steps(
              iteration.functional(),
              std::min(1., settings.maximum_step_length),
              0);
            MonotoneMultigrid<dim> without_levels =
              cautious.with(algebraic_correction()).with(whole_steps);
            report = attempt(name + " with algebraic corrections",
                             without_levels,
                             fallback_settings(),
                             search);
            keep_best(u, state);
          }
      }
    if (!report.converged && coulomb && budget->begin_attempt())
      {
        report = mixed_algorithm_2(search);
        keep_best(u, state);
      }
    // The last two start anew, and what they have got to is of no use if they
    // do not arrive.
    const auto start_anew = [&](const auto &method) {
      VectorType   other       = initial;
      ContactState other_state = initial_state;
      report                   = method({other, other_state, all, progress});
      if (report.converged)
        {
          u     = other;
          state = other_state;
        }
    };
    if (!report.converged && coulomb && budget->begin_attempt())
      start_anew(
        [&](const Search &other) { return careful_algorithm_2(other); });
    if (!report.converged && coulomb && budget->begin_attempt(true))
      start_anew([&](const Search &other) { return continuation(other); });

    if (all.attempts.size() > 1)
      {
        // What is reported of a failure is what is returned, and not the end of
        // an attempt that has been thrown away.
        if (!report.converged)
          {
            if (std::isfinite(smallest_violation))
              {
                u     = best_u;
                state = best_state;
              }
            certify(report, iteration.functional(), u, state);
          }
        report.cycles   = all.cycles;
        report.attempts = all.attempts;
        report.costs    = phase_costs(problem.communicator()) - before;
      }
    return report;
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::mixed_algorithm_2(const Search &search)
  {
    CoulombSettings mixed        = fallback_settings();
    mixed.algorithm              = Algorithm::fixed_point;
    mixed.outer_damping          = .5;
    mixed.mixed_outer_iterations = 10;
    mixed.maximum_outer_iterations =
      std::max(200u, settings.maximum_outer_iterations);

    const std::string      name   = "Algorithm 2 with mixed normal forces";
    MonotoneMultigrid<dim> best   = best_iteration();
    SolverReport           report = attempt(name, best, mixed, search);
    if (!report.inner_converged && !budget->is_spent())
      {
        MonotoneMultigrid<dim> without_levels =
          best.with(algebraic_correction());
        report = attempt(
          name + ", algebraic corrections", without_levels, mixed, search);
      }
    return report;
  }



  // What mixing extrapolates from are changes of phases as well, and where
  // there is very much friction nothing good comes of that. Fixed small steps
  // that do without get close to the solution, slowly; where the phases are
  // those of the solution, or nearly so, mixing does the rest. All of it is one
  // attempt.
  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::careful_algorithm_2(const Search &search)
  {
    CoulombSettings careful          = fallback_settings();
    careful.algorithm                = Algorithm::fixed_point;
    careful.outer_damping            = .02;
    careful.mixed_outer_iterations   = 0;
    careful.maximum_outer_iterations = 1000;
    // CoulombSolver divides this by the coefficient.
    careful.outer_tolerance =
      .01 * std::max(1., problem.effective_coefficient());
    const std::string name =
      "Algorithm 2 with small steps of the normal forces";
    SolverReport steps;
    const Search inner = {search.u, search.state, steps, search.progress};
    MonotoneMultigrid<dim> best   = best_iteration();
    SolverReport           report = attempt(name, best, careful, inner);
    if (report.inner_converged && !budget->is_spent())
      {
        careful.outer_tolerance        = settings.outer_tolerance;
        careful.mixed_outer_iterations = 10;
        report                         = attempt(name, best, careful, inner);
      }
    add_attempt(search.all, name, report, steps.cycles);
    return report;
  }



  // The coefficient is doubled for as long as that works, and multiplied by the
  // square root of the last factor where it does not. All of it is one attempt.
  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::continuation(const Search &search)
  {
    const double target = problem.friction_coefficient;
    // Also if a callback throws.
    const std::shared_ptr<void> restores_coefficient(
      nullptr, [&](void *) { problem.friction_coefficient = target; });
    // Where most problems are easy.
    constexpr double easy            = .25;
    constexpr double smallest_factor = 1.05;
    double           solved = 0, factor = 2;
    SolverReport     report, steps;
    while (solved < target && !budget->is_spent())
      {
        const double coefficient     = solved == 0
              ? std::min(easy, target / 2)
              : std::min(solved * factor, target);
        VectorType   next            = search.u;
        ContactState next_state      = search.state;
        problem.friction_coefficient = coefficient;
        report = mixed_algorithm_2({next, next_state, steps, search.progress});
        if (report.converged)
          {
            solved       = coefficient;
            search.u     = next;
            search.state = next_state;
          }
        else
          {
            factor = std::sqrt(factor);
            if (solved == 0 || factor < smallest_factor)
              break;
          }
      }
    report.converged = report.converged && solved == target;

    std::ostringstream name;
    name << "continuation from less friction, up to the coefficient " << solved
         << ",";
    add_attempt(search.all, name.str(), report, steps.cycles);
    return report;
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

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
    // Cycles that a method may take until it has to get somewhere. Where bounds
    // of friction react strongly to the displacement, methods with those of the
    // moment go to and fro from the beginning.
    constexpr unsigned int patience = 50, short_patience = 8;

    // Where friction is much, more cycles than that are better saved by
    // Newton's method: on this mesh, and on the next one if this took a few
    // less.
    constexpr unsigned int many_cycles = 25, many_for_the_next = 20;

    // Where materials jump, there are levels made of the matrix to try.
    // If these take that many cycles, the next mesh does not begin with them.
    constexpr unsigned int jump_patience = 10, too_many_for_the_next = 100;



    // How many cycles contact nodes alone may take the time of: where a
    // material is nearly incompressible, which makes cycles several times as
    // dear, and is solved to a given tolerance; and where fewer will do, or are
    // cheaper. Where others have failed, as many as are ever worth while.
    constexpr double cycles_to_expect = 24;

    // And for any material, to a given tolerance; fewer in three dimensions,
    // where CondensedSolver is generous with multiplications per cycle. And
    // unknowns up to which that is possible.
    template <int dim>
    constexpr double quick_cycles = (dim == 2 ? 8 : 3);

    template <int dim>
    constexpr types::global_dof_index largest_quick = (dim == 2 ? 5000 : 8000);

    template <int dim>
    constexpr double cycles_to_the_end = (dim == 2 ? 72 : 36);



    // Cycles that Newton's method may save once phases have settled.
    constexpr unsigned int longest_end = 20;



    // How many times as long as has been expected it may take if more nodes
    // turn out to touch.
    constexpr double allowed_growth = 3;



    constexpr const char *on_contact_nodes = " on contact nodes alone";



    // A user who chooses other parts wants to see them work.
    bool
    has_defaults(const SolverSettings &settings)
    {
      return settings.algorithm != Algorithm::fixed_point &&
        settings.coarse_correction == CoarseCorrection::truncated;
    }



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



    // For a solution on the way to the one that is wanted.
    void
    ease(CoulombSettings &settings, const double accuracy)
    {
      if (accuracy > 0.)
        {
          settings.limits.inner_tolerance =
            std::max(accuracy, settings.limits.inner_tolerance);
          settings.outer_tolerance =
            std::max(accuracy, settings.outer_tolerance);
          settings.certificate_tolerance =
            std::numeric_limits<double>::infinity();
        }
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



    // Notes what has been tried, and all the cycles that it took.
    void
    add_attempt(SolverReport       &all,
                const std::string  &name,
                const SolverReport &outcome)
    {
      all.attempts.push_back({name,
                              static_cast<unsigned int>(outcome.cycles.size()),
                              outcome.converged,
                              outcome.certificate.largest()});
      all.cycles.insert(
        all.cycles.end(), outcome.cycles.begin(), outcome.cycles.end());
    }
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



  // What all attempts after the first have in common. They end by increments,
  // and not by an estimate of the error.
  template <int dim>
  CoulombSettings
  SafeguardedSolver<dim>::later_settings(const double accuracy) const
  {
    CoulombSettings result(settings);
    ease(result, accuracy);
    result.limits.energy_tolerance = 0.;
    result.limits.patience         = patience;
    result.limits.budget           = budget;
    return result;
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



  // In two dimensions relaxation of lines is all that stretched cells need.
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
    return has_defaults(settings) && !much_friction() &&
      levels.hierarchy().n_levels() > 1 &&
      (mostly_lines_in_space() || materials_do_jump());
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::may_condense() const
  {
    return settings.condensation != CondensationUse::never &&
      has_defaults(settings);
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
    if (!(settings.nearly_incompressible ||
          (others_have_failed && !much_friction()) || materials_do_jump() ||
          mostly_lines_in_space()))
      return false;
    const bool are_dearer =
      settings.nearly_incompressible && settings.energy_tolerance == 0.;
    return contact_nodes_alone_take_less(search,
                                         others_have_failed
                                           ? CondensedSolver<dim>::most_cycles
                                           : are_dearer ? cycles_to_the_end<dim>
                                                        : cycles_to_expect);
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
    condensed->give_up_beyond(allowed_growth * n_cycles);
    return true;
  }



  // A step takes a factorisation there, and some iterations elsewhere.
  template <int dim>
  bool
  SafeguardedSolver<dim>::newton_is_for_contact_nodes_alone(
    const Search &search)
  {
    return may_condense() &&
      contact_nodes_alone_take_less(search, cycles_to_the_end<dim>);
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



  // None if the matrix could not be factorised, either.
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
    if (!condensed->is_worthwhile(Condensed::most_cycles))
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
        problem, settings.coarsest_method);
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

    if (!is_finite(search.u, search.state, problem.communicator()))
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
    if (!has_defaults(settings) || settings.nearly_incompressible ||
        materials_do_jump())
      return CoulombSolver<dim>(its_iteration, its_settings)
        .solve(search.u, search.state, search.progress);
    return NewtonFinish<dim>(
             its_iteration,
             [this]() -> NewtonSolver<dim> & { return newton_with_levels(); },
             longest_end)
      .solve(search.u, search.state, its_settings, search.progress);
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::newton_method(const Search &search)
  {
    CoulombSettings its_settings = later_settings(search.accuracy);
    its_settings.limits.patience = 0;
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



  // The coefficient is doubled for as long as that works, and multiplied by the
  // square root of the last factor where it does not.
  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::continuation(const Search &search, double &solved)
  {
    const double target = problem.friction_coefficient;
    // Also if a callback throws.
    const std::shared_ptr<void> restores_coefficient(
      nullptr, [&](void *) { problem.friction_coefficient = target; });
    // Where most problems are easy.
    constexpr double       easy            = .25;
    constexpr double       smallest_factor = 1.05;
    double                 factor          = 2;
    SolverReport           report;
    std::vector<CycleInfo> cycles;
    solved = 0;
    while (solved < target && !budget->is_spent())
      {
        const double coefficient     = solved == 0
              ? std::min(easy, target / 2)
              : std::min(solved * factor, target);
        VectorType   next            = search.u;
        ContactState next_state      = search.state;
        problem.friction_coefficient = coefficient;
        report =
          newton_method({next, next_state, search.progress, search.accuracy});
        cycles.insert(cycles.end(), report.cycles.begin(), report.cycles.end());
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
    report.cycles    = cycles;
    if (!report.converged)
      {
        // Of what is returned, with all friction.
        problem.friction_coefficient = target;
        certify(report, iteration.functional(), search.u, search.state);
      }
    return report;
  }



  // One call of solve(): what has been tried, and in which order.
  template <int dim>
  class SafeguardedSolver<dim>::Attempts
  {
  public:
    Attempts(SafeguardedSolver<dim> &solver, const Search &search);

    SolverReport run();

  private:
    SafeguardedSolver<dim> &solver;
    const Search           &search;
    DiscreteProblem<dim>   &problem;
    const MPI_Comm          comm;
    const bool              coulomb;
    const std::string       algorithm; // its name
    const Method            begin_with;
    const VectorType        initial;
    const ContactState      initial_state;

    // Of the last attempt, and of all.
    SolverReport report, all;

    // If nothing succeeds, what violates the law least is returned.
    double       smallest_violation = std::numeric_limits<double>::infinity();
    VectorType   best;
    ContactState best_state;

    // What has been tried.
    bool is_condensed = false, is_aggregate = false, is_algebraic = false,
         is_newton = false, is_continued = false, is_mixed = false;

    // Whether there is anything left to do and to try it with; notes that it is
    // being tried.
    bool begin(bool &is_tried, const bool is_last = false);

    template <typename MethodOfSolver>
    void attempt(const std::string &name, const MethodOfSolver &method);

    void start_anew();

    // A step of Newton's method may have gone into the obstacle; phases that
    // Algorithm 3 alone has begun to find are a good guess.
    void start_anew_unless_guess_is_better();

    void try_algorithm(
      const unsigned int its_patience,
      const unsigned int worthwhile = std::numeric_limits<unsigned int>::max());

    void try_contact_nodes_alone();
    void try_aggregates();
    void try_algebraic_corrections();
    void try_newton();
    void try_continuation(const bool is_last);
    void try_mixed_algorithm_2(const bool is_last);

    // Newton's method and those that follow it are for contact nodes alone
    // where that is cheap.
    std::string where_newton_is() const;

    void try_what_knows_the_law();
    void try_what_has_solved_the_mesh_before();
  };



  template <int dim>
  SafeguardedSolver<dim>::Attempts::Attempts(SafeguardedSolver<dim> &solver,
                                             const Search           &search)
    : solver(solver)
    , search(search)
    , problem(solver.problem)
    , comm(problem.communicator())
    , coulomb(problem.has_coulomb_friction())
    , algorithm(name_of(problem, solver.settings))
    , begin_with(solver.next_method)
    , initial(search.u)
    , initial_state(search.state)
    , best(search.u)
    , best_state(search.state)
  {}



  template <int dim>
  bool
  SafeguardedSolver<dim>::Attempts::begin(bool &is_tried, const bool is_last)
  {
    if (report.converged || is_tried || !solver.budget->begin_attempt(is_last))
      return false;
    is_tried = true;
    return true;
  }



  template <int dim>
  template <typename MethodOfSolver>
  void
  SafeguardedSolver<dim>::Attempts::attempt(const std::string    &name,
                                            const MethodOfSolver &method)
  {
    report         = method();
    const double v = report.certificate.largest();
    if (!report.converged && v < smallest_violation &&
        is_finite(search.u, search.state, comm))
      {
        smallest_violation = v;
        best               = search.u;
        best_state         = search.state;
      }
    add_attempt(
      all,
      name +
        (report.finished_by_newton ? ", finished by Newton's method," : ""),
      report);
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::start_anew()
  {
    search.u     = initial;
    search.state = initial_state;
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::start_anew_unless_guess_is_better()
  {
    if (all.attempts.size() > 1 || is_newton ||
        !is_finite(search.u, search.state, comm))
      start_anew();
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_algorithm(
    const unsigned int its_patience, const unsigned int worthwhile)
  {
    CoulombSettings first(solver.settings);
    ease(first, search.accuracy);
    first.limits.patience          = its_patience;
    first.limits.worthwhile_cycles = worthwhile;
    first.limits.budget            = solver.budget;
    if (!all.attempts.empty())
      start_anew();
    attempt(algorithm, [&]() {
      return solver.algorithm_to_the_end(solver.iteration, first, search);
    });
    solver.next_method = Method::algorithm;
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_contact_nodes_alone()
  {
    const bool others_have_failed =
      !all.attempts.empty() || begin_with == Method::contact_nodes;
    if (report.converged || is_condensed ||
        !solver.contact_nodes_alone_are_better(search, others_have_failed) ||
        !begin(is_condensed))
      return;
    start_anew_unless_guess_is_better();
    attempt((coulomb ? algorithm : "the iteration") + on_contact_nodes,
            [&]() { return solver.contact_nodes_alone(search); });
    if (report.converged && others_have_failed)
      solver.next_method = Method::contact_nodes;
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_aggregates()
  {
    if (!begin(is_aggregate))
      return;
    start_anew();
    attempt(algorithm + " with levels made of the matrix",
            [&]() { return solver.aggregate_corrections(search); });
    solver.aggregates_have_failed = !report.converged;
    if (report.converged)
      solver.next_method = report.cycles.size() > too_many_for_the_next
        ? Method::algorithm
        : Method::aggregates;
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_algebraic_corrections()
  {
    if (!begin(is_algebraic))
      return;
    start_anew_unless_guess_is_better();
    attempt(algorithm + " with algebraic corrections",
            [&]() { return solver.algebraic_corrections(search); });
    if (report.converged)
      solver.next_method = Method::algebraic;
  }



  template <int dim>
  std::string
  SafeguardedSolver<dim>::Attempts::where_newton_is() const
  {
    return solver.newton_is_for_contact_nodes_alone(search) ? on_contact_nodes
                                                            : "";
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_newton()
  {
    if (!begin(is_newton))
      return;
    start_anew();
    attempt("Newton's method" + where_newton_is(),
            [&]() { return solver.newton_method(search); });
    if (report.converged)
      solver.next_method = Method::newton;
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_continuation(const bool is_last)
  {
    if (!coulomb || !begin(is_continued, is_last))
      return;
    start_anew();
    const std::string where  = where_newton_is();
    double            solved = 0;
    attempt("", [&]() { return solver.continuation(search, solved); });
    std::ostringstream text;
    text << "continuation from less friction" << where
         << ", up to the coefficient " << solved << ',';
    all.attempts.back().name = text.str();
    if (report.converged)
      solver.next_method = Method::newton;
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_mixed_algorithm_2(const bool is_last)
  {
    if (!coulomb || !begin(is_mixed, is_last))
      return;
    search.u     = best;
    search.state = best_state;
    attempt("Algorithm 2 with mixed normal forces" + where_newton_is(),
            [&]() { return solver.mixed_algorithm_2(search); });
  }



  // What fails on contact nodes alone does not fail for want of good levels.
  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_what_knows_the_law()
  {
    if (report.converged || !is_condensed ||
        !solver.newton_is_for_contact_nodes_alone(search))
      return;
    try_newton();
    try_continuation(/*is_last =*/false);
    try_mixed_algorithm_2(/*is_last =*/false);
  }



  // It is likely to solve this one.
  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_what_has_solved_the_mesh_before()
  {
    const bool much_friction = solver.much_friction();
    if (report.converged)
      return;
    if (begin_with == Method::newton && much_friction)
      try_newton();
    else if (begin_with == Method::aggregates &&
             has_defaults(solver.settings) && !much_friction)
      try_aggregates();
    else if (begin_with == Method::algebraic ||
             (begin_with == Method::contact_nodes && !is_condensed &&
              !much_friction))
      {
        // Much dearer, so that others may try once what they can do on this
        // mesh.
        if (!solver.aggregates_have_failed &&
            solver.coarse_cells_may_be_to_blame())
          try_aggregates();
        try_algebraic_corrections();
      }
  }



  template <int dim>
  SolverReport
  SafeguardedSolver<dim>::Attempts::run()
  {
    const SolverSettings &settings      = solver.settings;
    const bool            much_friction = solver.much_friction();
    const PhaseCosts      before        = phase_costs(comm);

    // Here it is known beforehand what coarse levels are worth.
    if (begin_with == Method::newton &&
        solver.newton_is_for_contact_nodes_alone(search))
      try_newton();
    try_contact_nodes_alone();
    try_what_knows_the_law();
    try_what_has_solved_the_mesh_before();

    // Whether there is something else to try soon.
    const bool may_aggregate = !report.converged && !is_aggregate &&
      solver.coarse_cells_may_be_to_blame();
    if (!report.converged)
      {
        solver.budget->begin_attempt();
        if (much_friction && has_defaults(settings) && !is_newton)
          try_algorithm(short_patience, many_cycles);
        else if (much_friction)
          try_algorithm(short_patience);
        else if (may_aggregate)
          try_algorithm(jump_patience, many_cycles);
        else
          try_algorithm(patience);
        if (report.converged && !is_newton && has_defaults(settings) &&
            much_friction && report.cycles.size() > many_for_the_next)
          solver.next_method = Method::newton;
        if (report.converged && all.attempts.size() == 1)
          {
            report.next_method = solver.next_method;
            if (report.finished_by_newton)
              report.attempts = all.attempts;
            return report;
          }
      }

    // Without much friction hardly anything but coarse levels can be to blame;
    // but not if only the outer iteration of Algorithm 2 has failed.
    const bool outer_failure = coulomb && report.inner_converged &&
      settings.algorithm == Algorithm::fixed_point;
    if (may_aggregate)
      try_aggregates();
    if (!outer_failure)
      {
        try_contact_nodes_alone();
        try_what_knows_the_law();
      }
    // It has not had much time.
    if (!report.converged && may_aggregate && solver.budget->begin_attempt())
      try_algorithm(patience);
    if (!outer_failure && !much_friction)
      try_algebraic_corrections();
    try_newton();
    try_continuation(/*is_last =*/true);
    try_algebraic_corrections();
    try_mixed_algorithm_2(/*is_last =*/true);

    // What is reported of a failure is what is returned, and not the end of an
    // attempt that has been thrown away.
    if (!report.converged)
      {
        search.u     = best;
        search.state = best_state;
        certify(report, solver.iteration.functional(), search.u, search.state);
      }
    report.cycles      = all.cycles;
    report.attempts    = all.attempts;
    report.costs       = phase_costs(comm) - before;
    report.next_method = solver.next_method;
    return report;
  }



  template <int dim>
  bool
  SafeguardedSolver<dim>::begins_with_contact_nodes_alone(const Search &search)
  {
    return (next_method == Method::newton &&
            newton_is_for_contact_nodes_alone(search)) ||
      contact_nodes_alone_are_better(search,
                                     next_method == Method::contact_nodes);
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::prepare(VectorType &u, ContactState &state)
  {
    const RunScope part(problem.communicator(), RunPart::solution);
    const Progress none;
    if (!settings.safeguards ||
        !begins_with_contact_nodes_alone({u, state, none, 0.}))
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
    CoulombSettings only(settings);
    ease(only, accuracy);
    return CoulombSolver<dim>(iteration, only).solve(u, state, progress);
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

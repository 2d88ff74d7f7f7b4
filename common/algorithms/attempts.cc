#include <common/algorithms/attempts.h>
#include <common/parallel/phase_costs.h>

#include <optional>
#include <sstream>

namespace Friction
{
  namespace
  {
    // Where friction is much, more cycles than that are better saved by
    // Newton's method: on this mesh, and on the next one if this took a few
    // less.
    constexpr unsigned int many_cycles = 25, many_for_the_next = 20;

    // Where materials jump, there are levels made of the matrix to try, soon.
    // If these take that many cycles, the next mesh does not begin with them.
    constexpr unsigned int jump_patience = 10, too_many_for_the_next = 100;

    constexpr const char *on_contact_nodes = " on contact nodes alone";



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
  } // namespace



  template <int dim>
  SafeguardedSolver<dim>::Attempts::Attempts(SafeguardedSolver<dim> &solver,
                                             const Search           &search)
    : solver(solver)
    , search(search)
    , coulomb(solver.problem.has_coulomb_friction())
    , algorithm(name_of(solver.problem, solver.settings))
    , begin_with(solver.next_method)
    , initial(search.u)
    , initial_state(search.state)
    , best_state(0, false)
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
    if (!report.converged && v < smallest_violation && solver.is_finite(search))
      {
        smallest_violation = v;
        best               = search.u;
        best_state         = search.state;
      }
    attempts.push_back(
      {name +
         (report.finished_by_newton ? ", finished by Newton's method," : ""),
       static_cast<unsigned int>(report.cycles.size()),
       report.converged});
    cycles.insert(cycles.end(), report.cycles.begin(), report.cycles.end());
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
  SafeguardedSolver<dim>::Attempts::start_from_best()
  {
    const bool there_is = best.size() > 0;
    search.u            = there_is ? best : initial;
    search.state        = there_is ? best_state : initial_state;
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::start_anew_unless_guess_is_better()
  {
    if ((attempts.size() > 1 && !has_gone_on) || is_newton ||
        !solver.is_finite(search))
      start_anew();
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_algorithm(
    const unsigned int its_patience, const unsigned int worthwhile)
  {
    CoulombSettings first          = solver.first_settings(search.accuracy);
    first.limits.patience          = its_patience;
    first.limits.worthwhile_cycles = worthwhile;
    first.limits.budget            = solver.budget;
    if (!attempts.empty())
      start_anew();
    attempt(algorithm, [&]() {
      return solver.algorithm_to_the_end(solver.iteration, first, search);
    });
    solver.next_method = Method::algorithm;
  }



  // Volumes that hardly change make any correction slow, and those of Trilinos
  // are dearer. So Algorithm 3 goes on from the best iterate, as long as an
  // attempt has made the violation ten times smaller.
  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::go_on_with_algorithm()
  {
    constexpr double progress = .1;
    double           before   = std::numeric_limits<double>::infinity();
    while (!report.converged && smallest_violation < progress * before &&
           solver.budget->begin_attempt())
      {
        before      = smallest_violation;
        has_gone_on = true;
        start_from_best();
        attempt(algorithm + " once more", [&]() {
          return solver.algorithm_to_the_end(
            solver.iteration, solver.later_settings(search.accuracy), search);
        });
        if (report.converged)
          solver.next_method = Method::algorithm;
      }
    if (has_gone_on && !report.converged)
      start_from_best();
  }



  // A contact zone that becomes too large says nothing against the method: that
  // was no attempt, and the next one may have a larger limit.
  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_contact_nodes_alone()
  {
    const bool others_have_failed =
      !attempts.empty() || begin_with == Method::contact_nodes;
    while (!report.converged && !is_condensed &&
           solver.contact_nodes_alone_are_better(search, others_have_failed) &&
           begin(is_condensed))
      {
        start_anew_unless_guess_is_better();
        attempt((coulomb ? algorithm : "the iteration") + on_contact_nodes,
                [&]() { return solver.contact_nodes_alone(search); });
        if (solver.condensed->has_given_up())
          {
            is_condensed = false;
            attempts.pop_back();
          }
        else if (report.converged && others_have_failed)
          solver.next_method = Method::contact_nodes;
      }
    try_what_knows_the_law();
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
  SafeguardedSolver<dim>::Attempts::try_pivoting(const bool others_have_failed)
  {
    if (report.converged || is_pivoted ||
        !solver.pivoting_is_possible(search, others_have_failed) ||
        !begin(is_pivoted))
      return;
    start_anew();
    const std::optional<SolverReport> result = solver.pivoting(search);
    if (!result)
      {
        // A zone that has become too large says nothing against the method.
        is_pivoted = false;
        return;
      }
    attempt(std::string("complementary pivoting") + on_contact_nodes,
            [&]() { return *result; });
    if (report.converged)
      solver.next_method = Method::newton;
  }



  // Where that is cheap, pivoting is the better way to solve with all of the
  // law, and the way out where Newton's method fails.
  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_newton()
  {
    try_pivoting(/*others_have_failed =*/false);
    if (!begin(is_newton))
      return;
    start_anew();
    attempt("Newton's method" + where_newton_is(), [&]() {
      return solver.newton_method(search, solver.budget->cycles_left());
    });
    if (report.converged)
      solver.next_method = Method::newton;
    try_pivoting(/*others_have_failed =*/true);
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
    attempts.back().name = text.str();
    if (report.converged)
      solver.next_method = Method::newton;
  }



  template <int dim>
  void
  SafeguardedSolver<dim>::Attempts::try_mixed_algorithm_2(const bool is_last)
  {
    if (!coulomb || !begin(is_mixed, is_last))
      return;
    start_from_best();
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
    else if (begin_with == Method::aggregates && solver.has_defaults() &&
             !much_friction)
      try_aggregates();
    else if (begin_with == Method::algebraic ||
             (begin_with == Method::contact_nodes && !is_condensed &&
              !much_friction && !solver.settings.nearly_incompressible()))
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
    const MPI_Comm        comm          = solver.problem.communicator();
    const PhaseCosts      before        = phase_costs(comm);

    // Here it is known beforehand what coarse levels are worth.
    if (begin_with == Method::newton &&
        solver.all_of_the_law_is_for_contact_nodes_alone(search))
      try_newton();
    try_contact_nodes_alone();
    try_what_has_solved_the_mesh_before();

    // Whether there is something else to try soon.
    const bool may_aggregate = !report.converged && !is_aggregate &&
      solver.coarse_cells_may_be_to_blame();
    if (!report.converged)
      {
        solver.budget->begin_attempt();
        if (much_friction && solver.has_defaults() && !is_newton)
          try_algorithm(short_patience, many_cycles);
        else if (much_friction)
          try_algorithm(short_patience);
        else if (may_aggregate)
          try_algorithm(jump_patience, many_cycles);
        else
          try_algorithm(patience);
        if (report.converged && !is_newton && solver.has_defaults() &&
            much_friction && report.cycles.size() > many_for_the_next)
          solver.next_method = Method::newton;
      }

    // Without much friction hardly anything but coarse levels can be to blame;
    // but not if only the outer iteration of Algorithm 2 has failed.
    const bool outer_failure = coulomb && report.inner_converged &&
      settings.algorithm == Algorithm::fixed_point;
    if (may_aggregate)
      {
        try_contact_nodes_alone();
        try_aggregates();
      }
    if (!outer_failure)
      try_contact_nodes_alone();
    // It has not had much time.
    if (!report.converged && may_aggregate && solver.budget->begin_attempt())
      try_algorithm(patience);
    if (!outer_failure && !much_friction)
      {
        if (settings.nearly_incompressible() && solver.has_defaults())
          go_on_with_algorithm();
        try_algebraic_corrections();
      }
    try_newton();
    try_continuation(/*is_last =*/true);
    try_algebraic_corrections();
    try_mixed_algorithm_2(/*is_last =*/true);

    // What is reported of a failure is what is returned, and not the end of an
    // attempt that has been thrown away.
    if (!report.converged)
      {
        start_from_best();
        certify(report, solver.iteration.functional(), search.u, search.state);
      }
    report.cycles = cycles;
    // The algorithm of the settings may be enough, and nothing to speak of.
    if (!report.converged || attempts.size() > 1 ||
        attempts[0].name != algorithm)
      report.attempts = attempts;
    report.costs       = phase_costs(comm) - before;
    report.next_method = solver.next_method;
    return report;
  }



  template class SafeguardedSolver<2>::Attempts;
  template class SafeguardedSolver<3>::Attempts;
} // namespace Friction

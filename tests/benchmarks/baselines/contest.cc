#include <common/algorithms/nested_iteration.h>
#include <common/algorithms/safeguarded_solver.h>

#include <tests/benchmarks/baselines/contest.h>
#include <tests/benchmarks/baselines/gauss_seidel.h>
#include <tests/benchmarks/baselines/linear_cg.h>
#include <tests/benchmarks/baselines/newton_direct.h>
#include <tests/benchmarks/baselines/newton_gmres.h>
#include <tests/benchmarks/bonded.h>

#include <cmath>
#include <ctime>
#include <iostream>

namespace Benchmark
{
  namespace
  {
    bool
    is_linear(const std::string &name)
    {
      return name.compare(0, 6, "linear") == 0;
    }



    template <int dim>
    double
    energy_norm(const DiscreteProblem<dim> &problem, const VectorType &v)
    {
      VectorType Av(v);
      problem.stiffness.vmult(Av, v);
      double sum = 0;
      for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
        sum += v.local_element(i) * Av.local_element(i);
      return std::sqrt(std::max(0., sum));
    }
  } // namespace



  const std::vector<std::string> &
  solver_names()
  {
    static const std::vector<std::string> names = {"default",
                                                   "algorithm 3",
                                                   "algorithm 3 W",
                                                   "algorithm 3 monotone",
                                                   "algorithm 3 monotone W",
                                                   "algorithm 2",
                                                   "newton direct",
                                                   "newton gmres",
                                                   "gauss-seidel",
                                                   "linear multigrid",
                                                   "linear cg+ml",
                                                   "linear direct"};
    return names;
  }



  // A clock that stands still while errors are computed, and the errors. It is
  // that of the processor: all solvers are one thread, and what else a machine
  // does meanwhile is not their time.
  template <int dim>
  class Contest<dim>::Recorder
  {
  public:
    Recorder(Contest<dim>               &contest,
             const std::string          &name,
             const DiscreteProblem<dim> &problem)
      : contest(contest)
      , name(name)
      , problem(problem)
    {
      if (contest.history != nullptr)
        {
          reference = &contest.references.at(is_linear(name));
          norm      = energy_norm(problem, *reference);
          record(contest.u, 0.);
        }
      start = now();
    }

    double
    seconds() const
    {
      return now() - start - paused;
    }

    void
    end_setup()
    {
      setup = seconds();
    }

    /** How often there was something to record: the iterations of a solver that
     * did not live to report them. */
    unsigned int
    calls() const
    {
      return n_calls;
    }

    double
    setup_seconds() const
    {
      return setup;
    }

    void
    operator()(const std::function<VectorType()> &iterate)
    {
      ++n_calls;
      if (seconds() > contest.limit)
        throw std::runtime_error(
          "stopped after " + std::to_string(int(contest.limit)) + " seconds");
      if (contest.history == nullptr)
        return;
      const double elapsed = seconds();
      const double stopped = now();
      record(iterate(), elapsed);
      paused += now() - stopped;
    }

  private:
    Contest<dim>              &contest;
    const std::string          name;
    const DiscreteProblem<dim> problem;
    const VectorType          *reference = nullptr;
    double                     norm      = 1.;
    double                     start = 0, paused = 0, setup = 0;
    unsigned int               n_iterations = 0, n_calls = 0;

    static double
    now()
    {
      timespec time = {};
      clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
      return time.tv_sec + 1e-9 * time.tv_nsec;
    }

    void
    record(const VectorType &u, const double elapsed)
    {
      VectorType error(u);
      error -= *reference;
      *contest.history << name << ',' << n_iterations++ << ',' << elapsed << ','
                       << energy_norm(problem, error) / norm << std::endl;
    }
  };



  template <int dim>
  Contest<dim>::Contest(NestedIteration<dim> &nest,
                        const double          n_coarser,
                        const double          seconds,
                        const double          limit,
                        const Method          first)
    : nest(nest)
    , n_coarser(n_coarser)
    , seconds(seconds)
    , limit(limit)
    , first(first)
    , points(node_points(nest.discretization()))
    , bonded(bond(
        nest.discretization().problem(), nest.displacement(), nest.state()))
  {}



  template <int dim>
  DiscreteProblem<dim>
  Contest<dim>::problem() const
  {
    return nest.discretization().problem();
  }



  template <int dim>
  DiscreteProblem<dim>
  Contest<dim>::bonded_problem() const
  {
    const Discretization<dim> &d = nest.discretization();
    return {d.stiffness(),
            d.loads(),
            bonded,
            nothing,
            d.problem().face_measures,
            FrictionLaw::none,
            0.};
  }



  template <int dim>
  void
  Contest<dim>::start(const DiscreteProblem<dim> &problem)
  {
    state = nest.make_guess(u);
    if (&problem.constraints == &bonded)
      {
        bonded.impose(u);
        state = ContactState(0, false);
      }
  }



  // The product at a tolerance that rounding may or may not allow on a fine
  // mesh, so that it does not go on for ever, and the certificate decides.
  template <int dim>
  VectorType
  Contest<dim>::reference(const DiscreteProblem<dim> &problem)
  {
    start(problem);
    if (&problem.constraints != &bonded)
      {
        u     = nest.displacement();
        state = nest.state();
      }
    SolverSettings settings  = nest.parameters().solver;
    settings.inner_tolerance = 1e-13;
    settings.safeguards      = false;
    settings.maximum_cycles  = 60;
    ContactSolver<dim> solver(
      nest.discretization().dof_handler(), problem, settings);
    const SolverReport report = solver.solve(u, state);
    AssertThrow(report.certificate.largest() <= 1e-9,
                ExcMessage("The reference solution is not one: " +
                           report.certificate.describe()));
    return u;
  }



  template <int dim>
  void
  Contest<dim>::keep_history(std::ostream &out)
  {
    const DiscreteProblem<dim> contact = problem();
    references[false]                  = reference(contact);
    references[true]                   = reference(bonded_problem());

    // The discretisation error by the difference d to the level before, of
    // which the interpolated guess is the solution: if errors behave like
    // N^{-1/dim} and the difference is orthogonal to the error, then with
    // q = (N_{J-1}/N_J)^{1/dim} they are d/sqrt(1-q^2) on that level and q
    // times that on this one.
    out << "# scene=" << nest.parameters().name
        << " dofs=" << nest.discretization().dof_handler().n_dofs()
        << " friction=" << nest.parameters().contact.friction_coefficient
        << " poisson=" << nest.parameters().material.poisson_ratio()
        << std::endl;
    if (n_coarser > 0)
      {
        VectorType difference(*nest.guess()[0]);
        difference -= references[false];
        const double d = energy_norm(contact, difference) /
          energy_norm(contact, references[false]);
        const double q = std::pow(
          n_coarser / nest.discretization().dof_handler().n_dofs(), 1. / dim);
        out << "# discretisation_error=" << d * q / std::sqrt(1 - q * q)
            << std::endl;
      }
    out << "solver,iteration,seconds,relative_error" << std::endl;
    history = &out;
  }



  // "default" is what a user gets; the algorithms are what they are without
  // safeguards.
  template <int dim>
  SolverSettings
  Contest<dim>::settings_of(const std::string &name) const
  {
    SolverSettings settings = nest.parameters().solver;
    if (name == "default")
      return settings;
    settings.safeguards = false;
    if (name == "algorithm 2")
      settings.algorithm = Algorithm::fixed_point;
    if (name.find("monotone") != std::string::npos)
      settings.coarse_correction = CoarseCorrection::monotone;
    if (name.size() > 2 && name.substr(name.size() - 2) == " W")
      settings.cycle = Cycle::W;
    return settings;
  }



  template <int dim>
  BaselineReport
  Contest<dim>::run_product(const SolverSettings       &settings,
                            const DiscreteProblem<dim> &problem,
                            Recorder                   &recorder)
  {
    ContactSolver<dim> solver(nest.discretization().dof_handler(),
                              problem,
                              settings,
                              settings.safeguards ? first : Method::algorithm);
    solver.prepare(u, state);
    recorder.end_setup();
    const SolverReport solution =
      solver.solve(u, state, [&](const unsigned int, const double) {
        recorder([&]() { return u; });
      });
    BaselineReport report;
    report.converged  = solution.converged;
    report.iterations = solution.cycles.size();
    report.memory     = solution.solver_memory;
    if (!solution.attempts.empty())
      {
        report.n_attempts = solution.attempts.size();
        report.attempt    = solution.attempts.back().name;
      }
    return report;
  }



  template <int dim>
  BaselineReport
  Contest<dim>::run(const std::string          &name,
                    const DiscreteProblem<dim> &problem,
                    Recorder                   &recorder)
  {
    const Watch watch = [&](const std::function<VectorType()> &iterate) {
      recorder(iterate);
    };
    if (name == "newton direct" || name == "linear direct")
      {
        NewtonDirect<dim> solver(problem, u, state);
        recorder.end_setup();
        return solver.solve(u, state, watch);
      }
    if (name == "newton gmres")
      {
        NewtonGmres<dim> solver(problem, points, u, state);
        recorder.end_setup();
        return solver.solve(u, state, watch);
      }
    if (name == "linear cg+ml")
      {
        LinearCg<dim> solver(problem, points);
        recorder.end_setup();
        return solver.solve(u, watch);
      }
    if (name == "gauss-seidel")
      {
        GaussSeidel<dim> solver(
          problem, nest.parameters().solver.inner_tolerance, seconds);
        recorder.end_setup();
        return solver.solve(u, state, watch);
      }
    return run_product(settings_of(name), problem, recorder);
  }



  template <int dim>
  Result
  Contest<dim>::judge(const DiscreteProblem<dim> &problem) const
  {
    VectorType residual(u);
    problem.stiffness.residual(residual, problem.forces, u);
    Result result;
    result.certificate =
      make_certificate(problem, u, residual, state).largest();
    result.energy = TrescaFunctional<dim>(problem).energy(u, residual, state);
    result.converged  = result.certificate <= 1e-6;
    result.n_contact  = state.n_contact();
    result.n_sticking = state.n_sticking();
    return result;
  }



  template <int dim>
  Result
  Contest<dim>::run(const std::string &name)
  {
    const DiscreteProblem<dim> problem =
      is_linear(name) ? bonded_problem() : this->problem();
    start(problem);
    Recorder       recorder(*this, name, problem);
    BaselineReport report;
    std::string    failure;
    try
      {
        report = run(name, problem, recorder);
      }
    catch (const std::exception &error)
      {
        std::cerr << "  failed: " << error.what() << std::endl;
        failure           = error.what();
        report.iterations = recorder.calls();
      }
    if (report.n_setups > 1)
      std::cerr << "  " << report.n_setups << " factorisations" << std::endl;
    const double seconds    = recorder.seconds();
    Result       result     = judge(problem);
    result.converged        = result.converged && failure.empty();
    result.failure          = failure;
    result.n_attempts       = report.n_attempts;
    result.attempt          = report.attempt;
    result.iterations       = report.iterations;
    result.inner_iterations = report.inner_iterations;
    result.setup_seconds    = recorder.setup_seconds();
    result.solve_seconds    = seconds - recorder.setup_seconds();
    result.memory           = report.memory;
    if (is_linear(name))
      {
        result.n_contact  = nest.state().n_contact();
        result.n_sticking = nest.state().n_sticking();
      }
    return result;
  }



  template class Contest<2>;
  template class Contest<3>;
} // namespace Benchmark

// The product against other solvers on the same discrete problem.
//
// A nested iteration by the product leads to the last level, where each solver
// starts from the same initial guess, interpolated from the level before and
// made admissible. It goes on from a level that is not solved, too, and says
// so. All solvers are judged by the same certificate, evaluated by the same
// function for all of them. Seconds are those of the processor, which other
// programs on the same machine disturb little.
//
// The solver "default" is the product with its safeguards, as a user gets it;
// the others that are the product are variants without them.
//
// Usage: benchmark-solvers 2|3 scene.prm [--solvers=NAME,NAME,...]
//            [--table=FILE] [--history=FILE] [--every-level] [--levels=L,L,...]
//            [--seconds=S] [--limit=S] [--repeat=S] [--guess=NAME]
//            [--inclusion=FACTOR] [Section/Entry=value ...]
//
// --table    one line of comma separated values per solver (and level).
// --history  also the relative energy norm of the error after each iteration on
//            the last level, against seconds since the start, set-up included.
//            The reference is a solution by the product at a tolerance of
//            1e-13; that of a linear solver, of its own linear problem.
//            Iteration 0 is the initial guess, at time 0. An iteration is a
//            cycle, a step of "newton direct", an iteration of GMRES within a
//            step of "newton gmres", or ten sweeps of Gauss-Seidel.
// --solvers  all but "default" if not given.
// --seconds  after which Gauss-Seidel is stopped; 120 by default.
// --levels   those on which the solvers run, in place of the last one.
// --limit    seconds after which any solver is stopped, and has failed.
// --repeat   a solver that takes less than so many seconds solves the same
//            problem again and again until they have passed, ten times at
//            most, and the shortest time counts.
// --guess    interpolated (that of the nested iteration), or another one on the
//            first mesh: zero, random, inside, lifted; see guesses.h.
// --inclusion  multiplies Young's modulus in a part of the body: it lies at the
//            middle of the lower side, half as wide and a quarter as high.

#include <deal.II/base/timer.h>
#include <deal.II/base/utilities.h>

#include <deal.II/grid/grid_tools.h>

#include <common/algorithms/nested_iteration.h>
#include <common/algorithms/safeguarded_solver.h>

#include <tests/benchmarks/baselines/contest.h>
#include <tests/benchmarks/guesses.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

namespace Benchmark
{
  struct Options
  {
    std::vector<std::string> solvers;
    std::string              table, history, guess = "interpolated";
    bool                     every_level = false;
    std::vector<int>         levels;
    double                   seconds   = 120;
    double                   limit     = std::numeric_limits<double>::max();
    double                   repeat    = 0;
    double                   inclusion = 1;
    std::vector<std::string> overrides;
  };



  Options
  read_options(const int argc, char *argv[])
  {
    Options    options;
    const auto value = [](const std::string &argument,
                          const std::string &name) {
      return argument.compare(0, name.size(), name) == 0
        ? argument.substr(name.size())
        : std::string();
    };
    for (int i = 3; i < argc; ++i)
      {
        const std::string argument = argv[i];
        if (argument == "--every-level")
          options.every_level = true;
        else if (!value(argument, "--solvers=").empty())
          options.solvers =
            Utilities::split_string_list(value(argument, "--solvers="), ',');
        else if (!value(argument, "--table=").empty())
          options.table = value(argument, "--table=");
        else if (!value(argument, "--history=").empty())
          options.history = value(argument, "--history=");
        else if (!value(argument, "--seconds=").empty())
          options.seconds =
            Utilities::string_to_double(value(argument, "--seconds="));
        else if (!value(argument, "--levels=").empty())
          options.levels = Utilities::string_to_int(
            Utilities::split_string_list(value(argument, "--levels="), ','));
        else if (!value(argument, "--limit=").empty())
          options.limit =
            Utilities::string_to_double(value(argument, "--limit="));
        else if (!value(argument, "--repeat=").empty())
          options.repeat =
            Utilities::string_to_double(value(argument, "--repeat="));
        else if (!value(argument, "--inclusion=").empty())
          options.inclusion =
            Utilities::string_to_double(value(argument, "--inclusion="));
        else if (!value(argument, "--guess=").empty())
          options.guess = value(argument, "--guess=");
        else if (argument.compare(0, 2, "--") == 0)
          throw InputError("There is no option '" + argument + "'.");
        else
          options.overrides.push_back(argument);
      }
    if (options.solvers.empty())
      for (const std::string &name : solver_names())
        if (name != "default")
          options.solvers.push_back(name);
    for (const std::string &name : options.solvers)
      if (std::find(solver_names().begin(), solver_names().end(), name) ==
          solver_names().end())
        {
          std::string all;
          for (const std::string &known : solver_names())
            all += (all.empty() ? "" : ", ") + known;
          throw InputError("There is no solver '" + name +
                           "'. The solvers are: " + all + ".");
        }
    return options;
  }



  std::ofstream
  open_file(const std::string &name)
  {
    std::ofstream file;
    if (!name.empty())
      {
        file.open(name);
        if (!file)
          throw InputError("The file '" + name + "' cannot be written.");
        file.precision(10);
      }
    return file;
  }



  // Elasticity with a part of the body that is stiffer or softer.
  template <int dim>
  CellForm<dim>
  make_inclusion(const Parameters &parameters, const double factor)
  {
    if (factor == 1)
      return {};
    const auto mesh = make_triangulation<dim>();
    Scene<dim>(parameters).make_coarse_mesh(*mesh);
    const BoundingBox<dim> box = GridTools::compute_bounding_box(*mesh);
    return [box, factor, form = elasticity<dim>(parameters.material)](
             const FEValues<dim> &fe_values, CellBlocks<dim> &cell_blocks) {
      form(fe_values, cell_blocks);
      const Point<dim> p = box.real_to_unit(fe_values.get_cell()->center());
      bool             inside = p[dim - 1] < 0.25;
      for (unsigned int d = 0; d + 1 < dim; ++d)
        inside = inside && std::abs(p[d] - 0.5) < 0.25;
      if (inside)
        cell_blocks *= factor;
    };
  }



  // A level of the nested iteration. What a solver leaves behind is a guess for
  // the next level, whether it is a solution or not.
  template <int dim>
  void
  solve_level(NestedIteration<dim> &nest, const double limit)
  {
    Timer          timer;
    const Progress progress = [&](const unsigned int, const double) {
      if (timer.cpu_time() > limit)
        throw std::runtime_error("it took too long");
    };
    VectorType   u;
    ContactState state(0, false);
    SolverReport report;
    try
      {
        report = nest.solve_with(nest.parameters().solver, u, state, progress);
        if (!report.attempts.empty())
          std::cerr << "  level " << nest.level() << ": "
                    << describe_attempts(report) << std::endl;
        if (!report.converged)
          std::cerr << "  level " << nest.level()
                    << " was not solved: " << report.certificate.describe()
                    << std::endl;
      }
    catch (const std::exception &error)
      {
        std::cerr << "  level " << nest.level()
                  << " was not solved: " << error.what() << std::endl;
        certify(report,
                TrescaFunctional<dim>(nest.discretization().problem()),
                u,
                state);
      }
    nest.accept(u, state, report);
  }



  // On a small mesh the clock tells more of the machine than of the solver; the
  // least of several times tells less of it.
  template <int dim>
  Result
  run_solver(Contest<dim>      &contest,
             const std::string &name,
             const double       repeat)
  {
    constexpr unsigned int most_times = 10;
    const auto             seconds    = [](const Result &result) {
      return result.setup_seconds + result.solve_seconds;
    };
    Result result  = contest.run(name);
    double elapsed = seconds(result);
    for (unsigned int i = 1; i < most_times && elapsed < repeat; ++i)
      {
        const Result again = contest.run(name);
        elapsed += seconds(again);
        if (seconds(again) < seconds(result))
          result = again;
      }
    return result;
  }



  // What a solver has said of its failure, as one field of a table.
  std::string
  in_quotes(std::string text)
  {
    text = text.substr(0, text.find('\n'));
    for (char &c : text)
      if (c == '"')
        c = '\'';
    return '"' + text + '"';
  }



  template <int dim>
  void
  run(const Parameters &parameters, const Options &options)
  {
    std::ofstream table   = open_file(options.table);
    std::ofstream history = open_file(options.history);
    table << "scene,friction,poisson,level,dofs,contact,sticking,solver,"
             "converged,iterations,inner_iterations,setup_seconds,"
             "solve_seconds,memory_bytes,certificate,energy,attempts,attempt,"
             "failure"
          << std::endl;
    std::printf("%-22s %5s %8s %8s %8s  %-4s %5s %6s %9s %9s %8s %9s %16s\n",
                "solver",
                "level",
                "dofs",
                "contact",
                "sticking",
                "ok",
                "iter.",
                "inner",
                "set-up",
                "solve",
                "MB",
                "certif.",
                "energy");

    NestedIteration<dim> nest(
      parameters, make_inclusion<dim>(parameters, options.inclusion));
    nest.begin();
    bool   more      = true;
    double n_coarser = 0;
    while (more)
      {
        std::cerr << "level " << nest.level() << ", "
                  << nest.discretization().dof_handler().n_dofs() << " dofs"
                  << std::endl;
        const bool given = (options.guess != "interpolated");
        // A guess from elsewhere comes without what another mesh has taught.
        const Method first =
          given ? Method::algorithm : nest.report().next_method;
        if (given)
          {
            set_guess(nest, options.guess);
            VectorType         u;
            const ContactState state = nest.make_guess(u);
            SolverReport       guess;
            certify(guess,
                    TrescaFunctional<dim>(nest.discretization().problem()),
                    u,
                    state);
            nest.accept(u, state, guess);
          }
        else
          solve_level(nest, options.limit);
        const auto compete = [&](const bool last) {
          Contest<dim> contest(
            nest, n_coarser, options.seconds, options.limit, first);
          if (last && !options.history.empty())
            {
              std::cerr << "reference solution" << std::endl;
              contest.keep_history(history);
            }
          for (const std::string &name : options.solvers)
            {
              std::cerr << name << std::endl;
              const Result r = run_solver(
                contest, name, options.history.empty() ? options.repeat : 0.);
              table << parameters.name << ','
                    << parameters.contact.friction_coefficient << ','
                    << parameters.material.poisson_ratio() << ','
                    << nest.level() << ','
                    << nest.discretization().dof_handler().n_dofs() << ','
                    << r.n_contact << ',' << r.n_sticking << ',' << name << ','
                    << r.converged << ',' << r.iterations << ','
                    << r.inner_iterations << ',' << r.setup_seconds << ','
                    << r.solve_seconds << ',' << r.memory << ','
                    << r.certificate << ',' << r.energy << ',' << r.n_attempts
                    << ",\"" << r.attempt << "\"," << in_quotes(r.failure)
                    << std::endl;
              std::printf("%-22s %5u %8u %8u %8u  %-4s %5u %6u %9.3f %9.3f "
                          "%8.1f %9.1e %16.9e\n",
                          name.c_str(),
                          nest.level(),
                          static_cast<unsigned int>(
                            nest.discretization().dof_handler().n_dofs()),
                          r.n_contact,
                          r.n_sticking,
                          r.converged ? "yes" : "no",
                          r.iterations,
                          r.inner_iterations,
                          r.setup_seconds,
                          r.solve_seconds,
                          1e-6 * r.memory,
                          r.certificate,
                          r.energy);
              std::fflush(stdout);
            }
        };
        const bool last   = given || nest.is_last();
        const bool wanted = options.levels.empty()
          ? last || options.every_level
          : std::find(options.levels.begin(),
                      options.levels.end(),
                      nest.level()) != options.levels.end();
        if (wanted)
          compete(last);
        const double n_dofs = nest.discretization().dof_handler().n_dofs();
        more                = !given && nest.advance();
        // Where the error is nowhere, no mesh follows.
        if (!more && !last && !wanted && options.levels.empty())
          compete(true);
        n_coarser = n_dofs;
      }
  }
} // namespace Benchmark



int
main(int argc, char *argv[])
{
  // CHOLMOD starts threads of its own, and OpenBLAS likewise, which cannot be
  // told otherwise once they are loaded: one core for all.
  if (std::getenv("OMP_THREAD_LIMIT") == nullptr)
    {
      setenv("OMP_THREAD_LIMIT", "1", 1);
      setenv("OPENBLAS_NUM_THREADS", "1", 1);
      execv("/proc/self/exe", argv);
    }
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  try
    {
      const std::string dimension = argc < 3 ? "" : argv[1];
      if (dimension != "2" && dimension != "3")
        {
          std::cerr << "Usage: benchmark-solvers 2|3 scene.prm "
                       "[--solvers=NAME,...] [--table=FILE] [--history=FILE] "
                       "[--every-level] [--levels=L,...] "
                       "[--seconds=S] [--limit=S] [--repeat=S] "
                       "[--guess=NAME] [--inclusion=FACTOR] "
                       "[Section/Entry=value ...]\n";
          return 2;
        }
      const Benchmark::Options   options = Benchmark::read_options(argc, argv);
      const Friction::Parameters parameters =
        Friction::read_parameters(argv[2], options.overrides);
      if (dimension == "2")
        Benchmark::run<2>(parameters, options);
      else
        Benchmark::run<3>(parameters, options);
    }
  catch (const std::exception &error)
    {
      std::cerr << error.what() << std::endl;
      return 1;
    }
}

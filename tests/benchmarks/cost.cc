// What does friction cost? On each mesh of a nested iteration the contact
// problem is solved, and then the linear problem that remains when the contact
// nodes are bonded at the displacements just found: the same mesh, the same
// solution, the same multigrid, the same initial guess and tolerance, in the
// same run.
//
// Also measured: the share of the updates of coarse matrices, solve time per
// degree of freedom, and memory.
//
// Usage: benchmark-cost 2|3 scene.prm [Section/Entry=value ...]

#include <common/algorithms/nested_iteration.h>

#include <deal.II/base/timer.h>
#include <deal.II/base/utilities.h>

#include <tests/benchmarks/benchmark.h>
#include <tests/benchmarks/bonded.h>
#include <tests/benchmarks/machine.h>
#include <tests/support/discretized.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <vector>

namespace benchmark_cost
{
  using namespace Benchmark;
  using namespace Tests;

  double
  peak_memory()
  {
    Utilities::System::MemoryStats stats;
    Utilities::System::get_memory_stats(stats);
    return 1024. * stats.VmHWM;
  }



  // Seconds of three leading sweeps with friction over those without any
  // contact, all nodes being relaxed in either case.
  template <int dim>
  double
  ratio_of_sweeps(const Discretization<dim> &d,
                  const VectorType          &solution,
                  const ContactState        &solution_state)
  {
    const DiscreteProblem<dim> &problem = d.problem();
    const ContactBoundary<dim>  nothing;
    const DiscreteProblem<dim>  without = {problem.stiffness,
                                           problem.forces,
                                           problem.constraints,
                                           nothing,
                                           problem.face_measures,
                                           FrictionLaw::none,
                                           0.};
    const auto                  seconds = [&](const DiscreteProblem<dim> &which,
                             ContactState                state) {
      const MonotoneSmoother<dim> smoother(which);
      VectorType                  u = solution;
      Iterate                     x(u, state, which.has_friction());
      return best_of(10, [&]() { smoother.relax(x, 3); });
    };
    return seconds(problem, solution_state) /
      seconds(without, ContactState(0, false));
  }



  double
  seconds_of(const PhaseCosts &costs, const SolverPhase phase)
  {
    return costs[static_cast<unsigned int>(phase)].seconds;
  }



  void
  demand_convergence(const SolverReport &report)
  {
    AssertThrow(
      report.converged,
      ExcMessage("A benchmark that does not converge measures nothing: " +
                 report.certificate.describe()));
  }



  template <int dim>
  void
  run(const Parameters &parameters)
  {
    std::printf("scene %s, F = %g\n",
                parameters.name.c_str(),
                parameters.contact.friction_coefficient);
    std::printf("    dofs  contact  sticky | cycles   solve   us/dof  updates |"
                " linear   solve | ratio: solve, sweep\n");

    NestedIteration<dim> nest(parameters);
    nest.begin();
    PhaseCosts costs;
    double     seconds;
    do
      {
        nest.solve();
        demand_convergence(nest.report());
        costs                               = nest.report().costs;
        seconds                             = nest.solve_seconds();
        const Discretization<dim>  &d       = nest.discretization();
        const DiscreteProblem<dim> &problem = d.problem();

        const NodalConstraints<dim> bonded =
          bond(problem, nest.displacement(), nest.state());
        const ContactBoundary<dim> nothing;
        ContactSolver<dim>         linear_solver(d.dof_handler(),
                                         {problem.stiffness,
                                                  problem.forces,
                                                  bonded,
                                                  nothing,
                                                  problem.face_measures,
                                                  FrictionLaw::none,
                                                  0.},
                                         without_safeguards(parameters.solver));
        VectorType                 u;
        ContactState               no_state(0, false);
        nest.make_guess(u);
        bonded.impose(u);
        linear_solver.prepare(u, no_state);
        Timer              timer;
        const SolverReport linear       = linear_solver.solve(u, no_state);
        const double       linear_solve = timer.wall_time();
        demand_convergence(linear);

        const unsigned int n_dofs = d.dof_handler().n_dofs();
        std::printf("%8u %8u %7u | %6u %7.3f  %7.3f  %6.1f%% | %6u %7.3f | "
                    "%12.2f %6.2f\n",
                    n_dofs,
                    nest.state().n_contact(),
                    nest.state().n_sticking(),
                    static_cast<unsigned int>(nest.report().cycles.size()),
                    seconds,
                    1e6 * seconds / n_dofs,
                    100. * seconds_of(costs, SolverPhase::matrix_updates) /
                      seconds,
                    static_cast<unsigned int>(linear.cycles.size()),
                    linear_solve,
                    seconds / linear_solve,
                    ratio_of_sweeps(d, nest.displacement(), nest.state()));
        std::fflush(stdout);
    } while (nest.advance());

    std::printf("shares of the solve time: leading sweeps %.0f%%, coarse "
                "cycle %.0f%%, updates %.1f%%, recombination and line "
                "search %.0f%%\n",
                100. * seconds_of(costs, SolverPhase::leading_sweeps) / seconds,
                100. *
                  (seconds_of(costs, SolverPhase::coarse_sweeps) +
                   seconds_of(costs, SolverPhase::transfer) +
                   seconds_of(costs, SolverPhase::coarsest)) /
                  seconds,
                100. * seconds_of(costs, SolverPhase::matrix_updates) / seconds,
                100. * seconds_of(costs, SolverPhase::line_search) / seconds);

    // What holds the memory.
    const Discretization<dim> &d = nest.discretization();
    ContactSolver<dim>         solver(d, parameters.solver);
    const double               n_dofs = d.dof_handler().n_dofs();
    std::printf("bytes per dof: leaf matrix %.0f, smoother and levels %.0f, of "
                "which hierarchy %.0f; peak of the process %.0f\n\n",
                d.stiffness().memory_consumption() / n_dofs,
                nest.report().solver_memory / n_dofs,
                solver.levels().hierarchy().memory_consumption() / n_dofs,
                peak_memory() / n_dofs);
  }
} // namespace benchmark_cost



BENCHMARK(cost)
{
  try
    {
      const std::string dimension = argc < 3 ? "" : argv[1];
      if (dimension != "2" && dimension != "3")
        {
          std::cerr << "Usage: benchmark-cost 2|3 scene.prm "
                       "[Section/Entry=value ...]\n";
          return 2;
        }
      const Friction::Parameters parameters = Friction::read_parameters(
        argv[2], std::vector<std::string>(argv + 3, argv + argc));
      if (dimension == "2")
        run<2>(parameters);
      else
        run<3>(parameters);
    }
  catch (const std::exception &error)
    {
      std::cerr << error.what() << std::endl;
      return 1;
    }
  return 0;
}

// What does friction cost? On each mesh of a nested iteration the contact
// problem is solved, and then the linear problem that remains when the contact
// nodes are bonded at the displacements just found: the same mesh, the same
// solution, the same multigrid, the same initial guess and tolerance, in the
// same run.
//
// Also measured: the share of the updates of coarse matrices, solve time per
// degree of freedom, and the memory bandwidth of a leading sweep compared with
// a triad a = b + s c, which is as fast as memory allows.
//
// Usage: benchmark-cost scene.prm refinements [Section/Entry=value ...]

#include <common/solvers/coulomb_solver.h>
#include <common/solvers/initial_guess.h>

#include <deal.II/base/timer.h>

#include <deal.II/distributed/solution_transfer.h>

#include <tests/support/discretization.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace Benchmark
{
  using namespace Tests;

  double
  best_of(const unsigned int n, const std::function<void()> &work)
  {
    double best = 1e300;
    for (unsigned int i = 0; i < n; ++i)
      {
        Timer timer;
        work();
        best = std::min(best, timer.wall_time());
      }
    return best;
  }



  // Bytes per second of a triad on vectors far larger than any cache.
  double
  triad_bandwidth()
  {
    const std::size_t   n = 20000000;
    std::vector<double> a(n, 0.), b(n, 1.), c(n, 2.);
    const double        seconds = best_of(5, [&]() {
      for (std::size_t i = 0; i < n; ++i)
        a[i] = b[i] + 3. * c[i];
    });
    // Read b and c, read and write a.
    return 4. * n * sizeof(double) / seconds + (a[n / 2] < 0 ? 1. : 0.);
  }



  struct Solution
  {
    unsigned int  cycles;
    double        setup, seconds;
    MultigridCost cost;
    SolverReport  report;
  };



  template <int dim>
  Solution
  solve(const Discretization<dim>  &discretization,
        const DiscreteProblem<dim> &problem,
        const LevelHierarchy<dim>  &hierarchy,
        const SolverSettings       &settings,
        VectorType                 &u,
        ContactState               &state)
  {
    Solution           result;
    Timer              timer;
    CoulombSolver<dim> solver(
      discretization.dof_handler, hierarchy, problem, settings);
    result.setup = timer.wall_time();
    timer.restart();
    result.report  = solver.solve(u, state);
    result.seconds = timer.wall_time();
    result.cycles  = result.report.cycles.size();
    result.cost    = solver.multigrid().cost();
    AssertThrow(
      result.report.converged,
      ExcMessage("A benchmark that does not converge measures nothing: " +
                 result.report.certificate.describe()));
    return result;
  }



  template <int dim>
  double
  sweep_bandwidth(const DiscreteProblem<dim> &problem,
                  const VectorType           &solution,
                  const ContactState         &solution_state)
  {
    const MonotoneSmoother<dim> smoother(problem.matrix,
                                         problem.constraints,
                                         problem.contact,
                                         problem.effective_coefficient());
    VectorType                  u       = solution;
    ContactState                state   = solution_state;
    const double                seconds = best_of(
      10, [&]() { smoother.sweep(u, problem.forces, state, true, false); });
    // What a sweep must read and write at least: blocks and column numbers, row
    // starts and inverse diagonals, right hand side, and the vector twice.
    const auto  &A = problem.matrix;
    const double bytes =
      A.n_blocks() * (dim * dim * sizeof(double) + sizeof(unsigned int)) +
      A.n_rows() *
        (sizeof(std::size_t) + dim * dim * sizeof(double) +
         3 * dim * sizeof(double));
    return bytes / seconds;
  }



  template <int dim>
  void
  run(const Parameters &parameters, const unsigned int n_refinements)
  {
    const Scene<dim> scene(parameters);
    auto             mesh = make_triangulation<dim>();
    scene.make_coarse_mesh(*mesh);

    const double triad = triad_bandwidth();
    std::printf("scene %s, F = %g; triad %.1f GB/s\n",
                parameters.name.c_str(),
                scene.friction_coefficient(),
                triad * 1e-9);
    std::printf("    dofs  contact  sticky | cycles   solve   us/dof  updates |"
                " linear   solve | ratio | sweep/triad\n");

    VectorType u, tractions;
    auto discretization = std::make_unique<Discretization<dim>>(scene, *mesh);
    u                   = discretization->admissible_start();
    tractions.reinit(u);
    for (unsigned int level = 0;; ++level)
      {
        const auto   problem    = discretization->problem();
        VectorType   start      = u;
        ContactState state      = make_initial_guess(start,
                                                tractions,
                                                problem.constraints,
                                                problem.contact,
                                                problem.has_friction());
        u                       = start;
        const Solution friction = solve(*discretization,
                                        problem,
                                        *discretization->hierarchy,
                                        parameters.solver,
                                        u,
                                        state);

        // The bonded problem.
        NodalConstraints<dim> bonded = *discretization->constraints;
        for (unsigned int p = 0; p < problem.contact.size(); ++p)
          if (state.in_contact(p))
            for (unsigned int d = 0; d < dim; ++d)
              bonded.prescribe(
                problem.contact[p].node,
                d,
                u.local_element(dim * problem.contact[p].node + d));
        const ContactBoundary<dim> nothing(discretization->mapping,
                                           discretization->dof_handler,
                                           discretization->hanging,
                                           bonded,
                                           numbers::invalid_boundary_id,
                                           Obstacle<dim>(),
                                           ContactNormal::body);
        const LevelHierarchy<dim>  hierarchy(discretization->dof_handler,
                                            bonded);
        const DiscreteProblem<dim> linear_problem = {problem.matrix,
                                                     problem.forces,
                                                     bonded,
                                                     nothing,
                                                     FrictionLaw::none,
                                                     0.};
        bonded.impose(start);
        ContactState   no_state(0, false);
        const Solution linear = solve(*discretization,
                                      linear_problem,
                                      hierarchy,
                                      parameters.solver,
                                      start,
                                      no_state);

        const unsigned int n_dofs = discretization->dof_handler.n_dofs();
        std::printf(
          "%8u %8u %7u | %6u %7.3f  %7.3f  %6.1f%% | %6u %7.3f | %5.2f |",
          n_dofs,
          state.n_contact(),
          state.n_sticking(),
          friction.cycles,
          friction.seconds,
          1e6 * friction.seconds / n_dofs,
          100. * friction.cost.matrix_updates / friction.seconds,
          linear.cycles,
          linear.seconds,
          friction.seconds / linear.seconds);
        if (n_dofs > 200000)
          std::printf(" %4.0f%%\n",
                      100. * sweep_bandwidth(problem, u, state) / triad);
        else
          std::printf("\n");
        std::fflush(stdout);

        if (level == n_refinements)
          {
            std::printf(
              "shares of the solve time: leading sweeps %.0f%%, coarse "
              "cycle %.0f%%, updates %.1f%%, recombination and line "
              "search %.0f%%\n\n",
              100. * friction.cost.leading_sweeps / friction.seconds,
              100. * friction.cost.coarse_correction / friction.seconds,
              100. * friction.cost.matrix_updates / friction.seconds,
              100. * friction.cost.line_search / friction.seconds);
            return;
          }

        discretization->hanging.distribute(u);
        u.update_ghost_values();
        tractions = contact_tractions(friction.report.residual,
                                      problem.constraints,
                                      problem.contact,
                                      state);
        tractions.update_ghost_values();
        parallel::distributed::SolutionTransfer<dim, VectorType> transfer(
          discretization->dof_handler);
        mesh->set_all_refine_flags();
        mesh->prepare_coarsening_and_refinement();
        transfer.prepare_for_coarsening_and_refinement({&u, &tractions});
        mesh->execute_coarsening_and_refinement();
        // The transfer speaks to the old DoFHandler, which therefore is to know
        // the new mesh, with the numbering of the new one.
        discretization->dof_handler.distribute_dofs(discretization->fe);
        discretization->dof_handler.distribute_mg_dofs();
        renumber_nodes(discretization->dof_handler);
        auto       next = std::make_unique<Discretization<dim>>(scene, *mesh);
        VectorType new_u(next->constraints->partitioner());
        VectorType new_tractions(next->constraints->partitioner());
        std::vector<VectorType *> all = {&new_u, &new_tractions};
        transfer.interpolate(all);
        u              = new_u;
        tractions      = new_tractions;
        discretization = std::move(next);
      }
  }
} // namespace Benchmark



int
main(int argc, char *argv[])
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  try
    {
      if (argc < 3)
        {
          std::cerr << "Usage: benchmark-cost scene.prm refinements "
                       "[Section/Entry=value ...]\n";
          return 2;
        }
      Benchmark::run<2>(
        Friction::read_parameters(
          argv[1], std::vector<std::string>(argv + 3, argv + argc)),
        std::stoi(argv[2]));
    }
  catch (const std::exception &error)
    {
      std::cerr << error.what() << std::endl;
      return 1;
    }
}

// The coarsest level, solved by factorisation and by conjugate gradients with
// algebraic multigrid, when the coarsest mesh is all there is: a box of n cells
// in each direction. On the left what a single solution costs, its setting up
// included; on the right the whole contact problem, from zero.
//
// Usage: benchmark-coarsest 2|3 scene.prm DIRECT n ...
// with the largest number of unknowns for which to try the factorisation.

#include <common/algorithms/nested_iteration.h>
#include <common/compatibility.h>

#include <deal.II/base/timer.h>

#include <tests/benchmarks/benchmark.h>
#include <tests/support/discretized.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

namespace benchmark_coarsest
{
  using namespace Tests;

  template <int dim>
  void
  run(const std::string &scene, const unsigned int n, const double largest)
  {
    std::string subdivisions = std::to_string(n);
    for (unsigned int d = 1; d < dim; ++d)
      subdivisions += "," + std::to_string(n);

    Timer                timer;
    NestedIteration<dim> nest(
      read_parameters(scene,
                      {"Scene/Subdivisions=" + subdivisions,
                       "Refinement/Initial refinements=0",
                       "Refinement/Levels=0"}));
    nest.begin();
    const double               setup = timer.wall_time();
    const Discretization<dim> &d     = nest.discretization();
    const LevelHierarchy<dim>  hierarchy(
      d.dof_handler(), d.constraints(), d.stiffness().blocks());
    const LevelMatrices<dim> matrices(
      d.stiffness().blocks(), hierarchy, d.constraints());
    VectorType c(d.dof_handler().locally_owned_dofs(),
                 Compatibility::mpi_communicator(d.dof_handler()));
    VectorType rhs(c);
    for (unsigned int i = 0; i < rhs.locally_owned_size(); ++i)
      rhs.local_element(i) = d.constraints().is_prescribed(i / dim, i % dim)
        ? 0.
        : 1. + .5 * std::sin(.01 * i * i);

    std::printf("%8u %7.2f |", d.dof_handler().n_dofs(), setup);
    for (const CoarsestMethod method :
         {CoarsestMethod::direct, CoarsestMethod::algebraic_multigrid})
      {
        const bool is_direct = (method == CoarsestMethod::direct);
        if (is_direct && d.dof_handler().n_dofs() > largest)
          {
            std::printf("       -       -      -       - |");
            continue;
          }
        timer.restart();
        CoarsestSolver<dim> coarsest(hierarchy, matrices, method);
        if (!is_direct)
          coarsest.solve(c.begin(), rhs.begin()); // makes the hierarchy
        const double first = timer.wall_time();
        timer.restart();
        coarsest.solve(c.begin(), rhs.begin());
        const double again = timer.wall_time();
        std::printf(" %7.3f %7.4f", is_direct ? first : first - again, again);
        if (!is_direct)
          std::printf(" %4u", coarsest.algebraic_solver().n_iterations());

        SolverSettings settings  = nest.parameters().solver;
        settings.coarsest_method = method;
        VectorType         u;
        ContactState       state(0, false);
        const SolverReport report = nest.solve_with(settings, u, state);
        AssertThrow(report.converged, ExcMessage("No convergence"));
        std::printf(" %6u %7.3f%s",
                    static_cast<unsigned int>(report.cycles.size()),
                    nest.setup_seconds() + nest.solve_seconds(),
                    is_direct ? " |" : "\n");
        std::fflush(stdout);
      }
    std::fflush(stdout);
  }
} // namespace benchmark_coarsest



BENCHMARK(coarsest)
{
  try
    {
      const std::string dimension = argc < 5 ? "" : argv[1];
      if (dimension != "2" && dimension != "3")
        {
          std::cerr << "Usage: benchmark-coarsest 2|3 scene.prm DIRECT n ...\n";
          return 2;
        }
      std::printf("box in %sD; seconds, on one process\n", argv[1]);
      std::printf("                 |             factorisation         |"
                  "         algebraic multigrid\n"
                  "    dofs    mesh |   setup   solve cycles  problem |"
                  "   setup   solve  its cycles problem\n");
      for (int i = 4; i < argc; ++i)
        if (dimension == "2")
          run<2>(argv[2], std::stoi(argv[i]), std::stod(argv[3]));
        else
          run<3>(argv[2], std::stoi(argv[i]), std::stod(argv[3]));
    }
  catch (const std::exception &error)
    {
      std::cerr << error.what() << std::endl;
      return 1;
    }
  return 0;
}

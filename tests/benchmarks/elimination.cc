// What it costs to eliminate all nodes but contact nodes, with the instructions
// of each kind that this processor has, and how many multiplications can be
// done in the time of a multigrid cycle: a box of n cells in each direction.
//
// Usage: benchmark-elimination 2|3 scene.prm n ...

#include <common/algorithms/nested_iteration.h>
#include <common/nodes/condensation.h>
#include <common/nodes/instructions.h>

#include <tests/benchmarks/benchmark.h>
#include <tests/benchmarks/machine.h>
#include <tests/support/discretized.h>

#include <array>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

namespace benchmark_elimination
{
  using namespace Tests;

  template <int dim>
  void
  run(const std::string &scene, unsigned int n)
  {
    unsigned int n_refinements = 0;
    for (; n % 2 == 0; n /= 2)
      ++n_refinements;
    std::string subdivisions = std::to_string(n);
    for (unsigned int d = 1; d < dim; ++d)
      subdivisions += "," + std::to_string(n);
    NestedIteration<dim> nest(read_parameters(
      scene,
      {"Scene/Subdivisions=" + subdivisions,
       "Refinement/Initial refinements=" + std::to_string(n_refinements),
       "Refinement/Levels=0",
       "Refinement/Maximum dofs=10000000"}));
    nest.begin();
    const Discretization<dim>    &d      = nest.discretization();
    const NodeBlockMatrix<dim>   &A      = d.stiffness().blocks();
    const std::vector<Point<dim>> points = node_points(d);
    Places                        positions(A.n_rows());
    std::vector<char> is_held(dim * A.n_rows()), is_kept(A.n_rows(), 0),
      is_absent(A.n_rows());
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      {
        is_absent[i] = true;
        positions[i] = place_of(points[i]);
        for (unsigned int c = 0; c < dim; ++c)
          {
            is_held[dim * i + c] = d.constraints().is_prescribed(i, c);
            is_absent[i]         = is_absent[i] && is_held[dim * i + c];
          }
      }
    for (const ContactNode<dim> &node : d.contact())
      is_kept[node.node] = true;
    const EliminationTree tree(A.sparsity(), positions, is_kept, is_absent);
    std::printf("%8u %10.2e",
                static_cast<unsigned int>(d.dof_handler().n_dofs()),
                tree.cost(dim));

    double seconds = 0, first = 0;
    for (const Instructions instructions : available_instructions())
      {
        instructions_in_use = instructions;
        seconds             = Benchmark::best_of(3, [&]() {
          Condensation<dim> condensation(tree, is_held);
          AssertThrow(condensation.factorize(A),
                      ExcMessage("The matrix cannot be factorised."));
        });
        first               = (first == 0 ? seconds : first);
        std::printf(" %9.4f", seconds);
      }

    SolverSettings settings = nest.parameters().solver;
    settings.condensation   = CondensationUse::never;
    double cycle            = 1e300;
    for (unsigned int repetition = 0; repetition < 3; ++repetition)
      {
        VectorType         u;
        ContactState       state(0, false);
        const SolverReport report = nest.solve_with(settings, u, state);
        AssertThrow(report.converged, ExcMessage("No convergence"));
        cycle = std::min(cycle, nest.solve_seconds() / report.cycles.size());
      }
    std::printf(" %7.2f %9.5f %12.0f\n",
                first / seconds,
                cycle,
                cycle / seconds * tree.cost(dim) / d.dof_handler().n_dofs());
    std::fflush(stdout);
  }
} // namespace benchmark_elimination



BENCHMARK(elimination)
{
  try
    {
      const std::string dimension = argc < 4 ? "" : argv[1];
      if (dimension != "2" && dimension != "3")
        {
          std::cerr << "Usage: benchmark-elimination 2|3 scene.prm n ...\n";
          return 2;
        }
      std::printf(
        "box in %sD; seconds to eliminate all nodes but contact nodes, "
        "and of a cycle\n"
        "    dofs  multiplic.",
        argv[1]);
      for (const Instructions instructions : available_instructions())
        std::printf(" %9s",
                    instructions == Instructions::common ? "common" : "avx2");
      std::printf("  faster     cycle  per unknown\n");
      for (int i = 3; i < argc; ++i)
        if (dimension == "2")
          run<2>(argv[2], std::stoi(argv[i]));
        else
          run<3>(argv[2], std::stoi(argv[i]));
    }
  catch (const std::exception &error)
    {
      std::cerr << error.what() << std::endl;
      return 1;
    }
  return 0;
}

// Outer iterations of Algorithm 2 by what they start from on each mesh, to
// compare with table 6.1 of the thesis. The thesis interpolates nodal forces.
// On a mesh that is twice as fine these are too large by a factor of 2^(dim-1),
// so that the first relative change is about one in two dimensions, as it is
// from zero. Stresses, which are what this suite interpolates, begin much
// closer. These three have interpolated displacements; the fourth start is from
// nothing at all, w = 0 on each mesh, as Algorithm 3 is printed in the thesis.
// Beside them are the cycles of Algorithm 3 from the same starts.
//
// Usage: benchmark-outer_start DIM SCENE [SECTION/ENTRY=VALUE ...]
//
// The scene has to ask for Algorithm 2. A row per mesh: its level, the degrees
// of freedom, and those that there would be with one more node per cell, as in
// the thesis; nodes in contact and sticking nodes; and for each start the outer
// iterations, all cycles, the relative change of the normal forces in the first
// and in the seventh iteration (zero if there is none), the mean factor from
// one change to the next, and the cycles of Algorithm 3; at last, how much
// larger the last relative increment of Algorithm 3 from stresses is in the
// energy norm, which stops it here, than in the Euclidean one, which stops it
// in the thesis. Interpolated forces are interpolated stresses times the
// measure of the coarser mesh, which they are where the contact zone is refined
// evenly.

#include <common/algorithms/nested_iteration.h>

#include <tests/benchmarks/benchmark.h>

#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>

namespace benchmark_outer_start
{
  using namespace Friction;

  // Energy over Euclidean norm of the last of these many cycles.
  template <int dim>
  double
  ratio_of_norms(NestedIteration<dim> &nest,
                 SolverSettings        settings,
                 const unsigned int    n_cycles)
  {
    std::array<VectorType, 2> iterates;
    double                    increment = 0;
    for (unsigned int i = 0; i < 2; ++i)
      {
        ContactState state(0, false);
        settings.maximum_cycles = n_cycles - 1 + i;
        increment =
          nest.solve_with(settings, iterates[i], state).cycles.back().increment;
      }
    const double length = iterates[1].l2_norm();
    iterates[0] -= iterates[1];
    return increment / (iterates[0].l2_norm() / length);
  }



  template <int dim>
  void
  print_table(const std::string              &scene,
              const std::vector<std::string> &overrides)
  {
    NestedIteration<dim> nest(read_parameters(scene, overrides));
    // Of the interpolated displacement and stresses.
    struct Start
    {
      std::string name;
      double      displacement, stresses;
    };
    const std::vector<Start> starts = {{"stresses", 1., 1.},
                                       {"forces", 1., std::pow(2., dim - 1)},
                                       {"zero", 1., 0.},
                                       {"nothing", 0., 0.}};
    std::cout << " level     dofs with centres contact sticky";
    for (const Start &start : starts)
      std::cout << " | " << std::setw(9) << std::left << start.name + ":"
                << "outer Jac   first  seventh   factor  GS" << std::right;
    std::cout << " | norms" << std::endl;
    nest.begin();
    do
      {
        const VectorType   displacement = *nest.guess()[0];
        const VectorType   stresses     = *nest.guess()[1];
        std::ostringstream columns;
        columns << std::scientific << std::setprecision(1);
        double norms = 0;
        for (const Start &start : starts)
          {
            *nest.guess()[0] = displacement;
            *nest.guess()[0] *= start.displacement;
            *nest.guess()[1] = stresses;
            *nest.guess()[1] *= start.stresses;
            VectorType         u;
            ContactState       state(0, false);
            const SolverReport report =
              nest.solve_with(nest.parameters().solver, u, state);
            AssertThrow(report.converged, ExcMessage("No solution."));
            const std::vector<double> &changes = report.outer_changes;
            columns << " | " << std::setw(14) << report.outer_iterations
                    << std::setw(4) << report.cycles.size() << std::setw(8)
                    << changes.front() << std::setw(9)
                    << (changes.size() < 7 ? 0. : changes[6]) << std::setw(9)
                    << report.rho_tau_contraction();
            SolverSettings seidel = nest.parameters().solver;
            seidel.algorithm      = Algorithm::gauss_seidel_like;
            VectorType         v;
            ContactState       phases(0, false);
            const SolverReport other = nest.solve_with(seidel, v, phases);
            AssertThrow(other.converged, ExcMessage("No solution."));
            columns << std::setw(4) << other.cycles.size();
            if (&start == &starts.front())
              {
                if (other.cycles.size() > 1)
                  norms = ratio_of_norms(nest, seidel, other.cycles.size());
                nest.accept(u, state, report);
              }
          }
        const unsigned int n_dofs =
          nest.discretization().dof_handler().n_dofs();
        std::cout << std::setw(6) << nest.level() << std::setw(9) << n_dofs
                  << std::setw(13)
                  << n_dofs + dim * nest.mesh().n_global_active_cells()
                  << std::setw(8) << nest.state().n_contact() << std::setw(7)
                  << nest.state().n_sticking() << columns.str() << " | "
                  << std::fixed << std::setprecision(1) << norms << std::endl;
    } while (nest.advance());
  }
} // namespace benchmark_outer_start

BENCHMARK(outer_start)
{
  if (argc < 3)
    {
      std::cerr
        << "Usage: benchmark-outer_start DIM SCENE [SECTION/ENTRY=VALUE ...]\n";
      return 2;
    }
  try
    {
      const std::vector<std::string> overrides(argv + 3, argv + argc);
      if (std::string(argv[1]) == "2")
        print_table<2>(argv[2], overrides);
      else
        print_table<3>(argv[2], overrides);
    }
  catch (const InputError &error)
    {
      std::cerr << error.what() << '\n';
      return 2;
    }
  return 0;
}

// Stopping at the discretisation error: on each mesh but the first the
// iteration ends early, and still its error, measured against a solution to
// rounding, is at most a tenth of the error of the discretisation. With a known
// solution, and a material that hardly changes its volume or cells that are
// much longer than wide, what the iteration is asked for is at most a tenth of
// the true error: the estimate is many times that.

#include <common/algorithms/discretization_stop.h>
#include <common/algorithms/nested_iteration.h>

#include <common/estimate/exact_error.h>

#include <iostream>

#include <tests/support/check.h>

#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_discretization_stop
{
  template <int dim>
  double
  energy_norm(const NodeBlockMatrix<dim> &A, const VectorType &v)
  {
    VectorType Av(v);
    A.vmult(Av.begin(), v.begin());
    return std::sqrt(std::max(0., Av * v));
  }



  template <int dim>
  void
  test(const std::string              &scene,
       const std::vector<std::string> &overrides,
       const bool                      one_is_enough = false)
  {
    std::cout << "Scene " << scene << std::endl;
    NestedIteration<dim> nest(without_safeguards(read_parameters(
      (dim == 2 ? SCENES_DIR "/" : SCENES_3D_DIR "/") + scene + ".prm",
      overrides)));
    nest.begin();
    SolverSettings tight          = nest.parameters().solver;
    tight.inner_tolerance         = 1e-12;
    SolverSettings wanted         = nest.parameters().solver;
    wanted.stop_at_discretization = true;
    DiscretizationStop<dim> stop(wanted);

    double       share = 0, extrapolation_low = 1e10, extrapolation_high = 0;
    unsigned int n_cycles = 0, n_tight_cycles = 0, least_cycles = 1000;
    bool         converged = true;
    do
      {
        const Discretization<dim> &d      = nest.discretization();
        const auto                 n_dofs = d.dof_handler().n_dofs();
        VectorType                 u;
        ContactState               state(0, false);
        n_tight_cycles += nest.solve_with(tight, u, state).cycles.size();

        VectorType         v;
        ContactState       stopped(0, false);
        const SolverReport report =
          nest.solve_with(stop.settings_for(n_dofs), v, stopped);
        nest.accept(v, stopped, report);
        converged = converged && nest.report().converged;
        n_cycles += nest.report().cycles.size();
        u -= nest.displacement();
        const double        error = energy_norm<dim>(d.stiffness().blocks(), u);
        const ErrorEstimate estimate = nest.estimate();
        stop.add_level(estimate.lower_bound, n_dofs, report.pace);
        least_cycles =
          std::min<unsigned int>(least_cycles, report.cycles.size());
        share = std::max(share, error / estimate.total);
        if (nest.level() > 0)
          {
            const double ratio = nest.report().algebraic_error / error;
            extrapolation_low  = std::min(extrapolation_low, ratio);
            extrapolation_high = std::max(extrapolation_high, ratio);
          }
    } while (nest.advance());
    check(converged, "all meshes are solved");
    check_below(share, .1 / 8., "error of the iteration over estimated error");
    check_below(extrapolation_high, 10., "the error is not overestimated much");
    check_below(1. / extrapolation_low, 4., "and underestimated even less");
    check_below(double(n_cycles) / n_tight_cycles,
                .5,
                "cycles over those to rounding, first mesh included");
    if (one_is_enough)
      check(least_cycles == 1, "a mesh is solved in one cycle");
  }



  // What is missing of a force that is given is an error of the iteration, too.
  template <int dim>
  void
  test_with_force(const std::string &scene,
                  const std::string &force,
                  const std::string &start,
                  const std::string &levels)
  {
    std::cout << "Scene " << scene << " with a force" << std::endl;
    const auto make = [&](const std::string &tolerance) {
      return without_safeguards(read_parameters(
        (dim == 2 ? SCENES_DIR "/" : SCENES_3D_DIR "/") + scene + ".prm",
        {"Refinement/Strategy=uniform",
         "Boundary conditions/Force=" + force,
         "Boundary conditions/Displacement=" + start,
         "Solver/Inner tolerance=" + tolerance,
         levels}));
    };
    NestedIteration<dim> tight(make("1e-12")), stopped(make("discretisation"));
    tight.begin();
    stopped.begin();

    double       share    = 0;
    unsigned int n_cycles = 0, n_tight_cycles = 0;
    bool         converged = true;
    do
      {
        converged             = tight.solve().converged && converged;
        converged             = stopped.solve().converged && converged;
        VectorType difference = tight.displacement();
        difference -= stopped.displacement();
        const double error = energy_norm<dim>(
          tight.discretization().stiffness().blocks(), difference);
        share = std::max(share, error / stopped.estimate().total);
        if (stopped.level() > 0)
          {
            n_cycles += stopped.report().cycles.size();
            n_tight_cycles += tight.report().cycles.size();
          }
    } while (tight.advance() && stopped.advance());
    check(converged, "all meshes are solved");
    check_below(share, .05 / 8., "error of the iteration over estimated error");
    check_below(
      double(n_cycles) / n_tight_cycles, .5, "cycles over those to rounding");
  }



  void
  test_overestimated(const std::string              &name,
                     const std::vector<std::string> &overrides,
                     const double                    least)
  {
    std::cout << name << std::endl;
    std::vector<std::string> all = overrides;
    all.push_back("Refinement/Levels=2");
    all.push_back("Solver/Inner tolerance=1e-9");
    NestedIteration<2> nest(
      read_parameters(SCENES_DIR "/manufactured.prm", all));
    nest.begin();
    SolverSettings wanted         = nest.parameters().solver;
    wanted.stop_at_discretization = true;
    const Scene<2>       &scene   = nest.discretization().scene();
    DiscretizationStop<2> stop(wanted);

    double most_tolerated = 0, least_overestimation = 1e10;
    do
      {
        const Discretization<2> &d        = nest.discretization();
        const auto               n_dofs   = d.dof_handler().n_dofs();
        const SolverSettings     settings = stop.settings_for(n_dofs);
        nest.solve();
        const double error = compute_exact_error(d.mapping(),
                                                 d.dof_handler(),
                                                 scene.materials(),
                                                 *scene.exact_displacement(),
                                                 nest.displacement())
                               .energy;
        if (nest.level() > 0)
          most_tolerated =
            std::max(most_tolerated, settings.energy_tolerance / error);
        const ErrorEstimate estimate = nest.estimate();
        least_overestimation =
          std::min(least_overestimation, estimate.total / error);
        stop.add_level(estimate.lower_bound, n_dofs, 0.);
    } while (nest.advance());
    check(least_overestimation > least, "the estimate is far too large");
    check_below(most_tolerated, .1, "what is tolerated over the true error");
  }
} // namespace test_discretization_stop



TEST(discretization_stop)
{
  test<2>("hertz", {"Refinement/Maximum dofs=5000"});
  test<2>("block",
          {"Refinement/Initial refinements=2",
           "Refinement/Levels=3",
           "Material/Poisson ratio=0.45",
           "Contact/Friction coefficient=0.05"});
  test<3>("cylinder",
          {"Refinement/Initial refinements=1", "Refinement/Maximum dofs=2000"});
  test<3>("block", {}, true);
  test_with_force<2>(
    "hertz", "1: free, -0.003", "1: 0, -0.001", "Refinement/Levels=4");
  test_with_force<3>("half-ball",
                     "1: free, free, -0.0012",
                     "1: 0, 0, -0.02",
                     "Refinement/Levels=2");
  for (const std::string strain : {"pointwise", "mean"})
    test_overestimated(
      "Poisson ratio 0.49, strains " + strain,
      {"Material/Poisson ratio=0.49", "Material/Volumetric strain=" + strain},
      16.);
  test_overestimated(
    "Cells 60, 1",
    {"Scene/Subdivisions=60, 1", "Refinement/Initial refinements=0"},
    8.);
}

// NewtonFinish against Algorithm 3 by itself, with which it shares the
// beginning only: the same displacements, normal forces and phases.
//
// Plates of thin cells that stand on the obstacle have a hundred and more
// contact nodes close to each other. There Newton's method takes less than half
// of the cycles. In a nearly incompressible block it is coarse functions that
// are slow: Newton's method gives up after one linear problem, and Algorithm 3
// goes on as if it had not been asked. Where Algorithm 3 is quick, with
// Algorithm 2, and for Tresca's law nothing happens at all.

#include <common/algorithms/newton_finish.h>
#include <common/iteration/multigrid_newton_step.h>
#include <common/levels/levels.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_newton_finish
{
  struct Outcome
  {
    SolverReport report;
    VectorType   u;
    ContactState state{0, false};
    unsigned int n_newton = 0; // times that it was asked
  };



  // Both ways, each with parts of its own.
  class Body
  {
  public:
    Body(const std::vector<std::string> &entries)
      : parameters(read_parameters(SCENES_3D_DIR "/block.prm", entries))
      , scene(parameters)
      , mesh(make_triangulation<3>())
    {
      scene.make_coarse_mesh(*mesh);
      mesh->refine_global(parameters.refinement.initial_refinements);
      discretization = std::make_unique<Discretized<3>>(scene, *mesh);
    }

    Outcome
    solve(const bool finish, const Algorithm algorithm) const
    {
      const Discretized<3>     &d       = *discretization;
      const DiscreteProblem<3> &problem = d.problem();
      CoulombSettings           limits(parameters.solver);
      limits.algorithm              = algorithm;
      limits.limits.maximum_cycles  = 400;
      limits.limits.inner_tolerance = 1e-10;
      limits.outer_tolerance        = 1e-9;

      const TrescaFunctional<3> functional(problem);
      const MonotoneSmoother<3> smoother(problem);
      Linearization<3>   linearization(problem, TruncationVariant::phases);
      Levels<3>          levels(d.dof_handler(), problem);
      const unsigned int n_sweeps = parameters.solver.coarse_smoothing_steps;
      TruncatedCorrection<3> correction(levels, Cycle::V, n_sweeps);
      TruncatedCorrection<3> of_newton(levels, Cycle::V, n_sweeps);
      LineSearch<3>          line_search(functional, 1., 1);
      MonotoneMultigrid<3>   iteration(functional,
                                     smoother,
                                     linearization,
                                     correction,
                                     line_search,
                                     parameters.solver.smoothing_steps);
      MultigridNewtonStep<3> step(problem,
                                  smoother,
                                  levels,
                                  of_newton,
                                  parameters.solver.smoothing_steps);
      NewtonSolver<3>        newton(functional, step);

      Outcome outcome;
      outcome.u     = admissible_start(d);
      outcome.state = ContactState(d.contact().size(), problem.has_friction());
      for (unsigned int p = 0; p < outcome.state.size(); ++p)
        outcome.state.set_normal_force(p, 1e-3 * problem.contact[p].measure);
      outcome.report = finish
        ? NewtonFinish<3>(
            iteration,
            [&]() -> NewtonSolver<3> & {
              ++outcome.n_newton;
              return newton;
            },
            20)
            .solve(outcome.u, outcome.state, limits)
        : CoulombSolver<3>(iteration, limits).solve(outcome.u, outcome.state);
      return outcome;
    }

  private:
    const Parameters                  parameters;
    const Scene<3>                    scene;
    std::unique_ptr<Triangulation<3>> mesh;
    std::unique_ptr<Discretized<3>>   discretization;
  };



  void
  compare(const Outcome &a, const Outcome &b)
  {
    check_everywhere(a.report.converged && b.report.converged, "  both solve");
    check_everywhere(a.report.certificate.largest() < 1e-7, "  certified");
    check_everywhere(relative_distance(a.u, b.u) < 1e-7,
                     "  displacements agree");
    check_everywhere(phases_agree(a.state, b.state), "  phases do");
    check_everywhere(relative_distance_of_forces(a.state, b.state) < 1e-5,
                     "  normal forces do");
  }



  std::size_t
  n_cycles(const Outcome &outcome)
  {
    return outcome.report.cycles.size();
  }
} // namespace test_newton_finish



TEST(newton_finish)
{
  using namespace test_newton_finish;
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  {
    std::cout << "thin cells" << std::endl;
    const Body body(
      {"Scene/Subdivisions=60,1,1", "Refinement/Initial refinements=0"});
    const Outcome a = body.solve(true, Algorithm::gauss_seidel_like),
                  b = body.solve(false, Algorithm::gauss_seidel_like);
    compare(a, b);
    check_everywhere(a.report.finished_by_newton, "  by Newton's method");
    check_everywhere(2 * n_cycles(a) < n_cycles(b), "  in half of the cycles");

    const Outcome c = body.solve(true, Algorithm::fixed_point);
    check_everywhere(c.n_newton == 0, "  not with Algorithm 2");
  }
  {
    std::cout << "nearly incompressible" << std::endl;
    const Body    body({"Refinement/Initial refinements=3",
                        "Material/Poisson ratio=0.499",
                        "Material/Volumetric strain=mean"});
    const Outcome a = body.solve(true, Algorithm::gauss_seidel_like),
                  b = body.solve(false, Algorithm::gauss_seidel_like);
    compare(a, b);
    check_everywhere(!a.report.finished_by_newton && a.n_newton == 1,
                     "  Newton's method gives up");
    check_everywhere(n_cycles(a) <= n_cycles(b) + 5, "  soon");
    check_everywhere(relative_distance(a.u, b.u) < 1e-12,
                     "  and changes nothing");
  }
  {
    std::cout << "cubes" << std::endl;
    const Outcome a = Body({"Refinement/Initial refinements=2"})
                        .solve(true, Algorithm::gauss_seidel_like);
    check_everywhere(a.report.converged && a.n_newton == 0,
                     "  there is no need");
  }
  {
    std::cout << "thin cells, Tresca" << std::endl;
    const Outcome a = Body({"Scene/Subdivisions=60,1,1",
                            "Refinement/Initial refinements=0",
                            "Contact/Friction law=Tresca",
                            "Contact/Friction bound=0.002"})
                        .solve(true, Algorithm::gauss_seidel_like);
    check_everywhere(a.n_newton == 0, "  there is nothing to finish");
  }
}

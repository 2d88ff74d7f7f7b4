// Stiff parts that no coarse cell knows of, a million times stiffer than what
// is around them: Algorithm 3 with levels of the mesh is given up on a coarse
// mesh, and with levels made of the matrix it takes a few cycles on all meshes
// from then on, one attempt each (bodies as small as these would otherwise be
// solved on contact nodes alone). Its solution is that of AlgebraicCorrection,
// which has no levels at all. Groups of nodes end between processes, so that
// several of them need more cycles. The tolerance is what rounding errors
// leave: those of the forces on a stiff part move it, against nothing but what
// is soft, by some billionths of the displacement.

#include <common/algorithms/nested_iteration.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_jumps
{
  template <int dim>
  std::vector<std::string>
  overrides(const std::string &stiff)
  {
    return {"Refinement/Strategy=uniform",
            std::string("Refinement/Initial refinements=") +
              (dim == 2 ? "3" : "1"),
            std::string("Refinement/Levels=") + (dim == 2 ? "3" : "2"),
            "Solver/Condensation=never",
            "Solver/Inner tolerance=1e-8",
            "Material/Regions=where " + stiff + ": 1e6*E, nu"};
  }

  template <int dim>
  Parameters
  block(std::vector<std::string> texts)
  {
    return read_parameters((dim == 2 ? SCENES_DIR "/" : SCENES_3D_DIR "/") +
                             std::string("block.prm"),
                           texts);
  }

  template <int dim>
  double
  energy_without_levels(std::vector<std::string> texts)
  {
    texts.push_back("Solver/Coarse correction=algebraic");
    NestedIteration<dim> nest(block<dim>(texts));
    nest.begin();
    do
      nest.solve();
    while (nest.advance());
    check_everywhere(nest.report().converged, "  and without levels");
    return nest.report().cycles.back().energy;
  }

  template <int dim>
  void
  test(const std::string &stiff,
       const unsigned int bound,
       const bool         compare = false)
  {
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << dim << "D, " << stiff << std::endl;
    NestedIteration<dim> nest(block<dim>(overrides<dim>(stiff)));
    nest.begin();
    bool converged = true;
    do
      {
        nest.solve();
        converged = converged && nest.report().converged;
    } while (nest.advance());
    const SolverReport &report = nest.report();
    check_everywhere(converged, "  all meshes are solved");
    check_everywhere(report.next_method == Method::aggregates &&
                       report.attempts.size() == 1,
                     "  the last one at the first attempt, with levels made of "
                     "the matrix");
    check_everywhere(report.cycles.size() <= bound,
                     "  in few cycles" +
                       (report.cycles.size() > bound
                          ? ": " + std::to_string(report.cycles.size())
                          : ""));
    if (compare)
      {
        const double energy = energy_without_levels<dim>(overrides<dim>(stiff));
        check_below(std::abs(report.cycles.back().energy / energy - 1.),
                    1e-8,
                    "  with the same energy");
      }
  }
} // namespace test_jumps



TEST(jumps)
{
  const bool alone = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
  test<2>("abs(y - 0.33) < 0.06", alone ? 20 : 40, alone);
  test<2>("(x - 0.55)^2 + (y - 0.3)^2 < 0.04", alone ? 20 : 40);
  if (alone)
    {
      test<2>("abs(y - 0.3 - 0.2*x) < 0.06", 25);
      test<2>("sin(5*pi*x)*sin(5*pi*y) > 0", 30);
    }
  test<3>("abs(z - 0.33) < 0.06", alone ? 16 : 24, alone);
  if (alone)
    test<3>("(x - 0.55)^2 + (y - 0.45)^2 + (z - 0.3)^2 < 0.04", 18);
}

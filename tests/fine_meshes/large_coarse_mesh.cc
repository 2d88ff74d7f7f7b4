// An imported mesh of more than 10^5 quadrilaterals, which is the coarsest mesh
// and the leaf mesh at once: there are no levels, and each correction is one
// solution by algebraic multigrid. The same mesh obtained by refining 25 cells
// six times has the same discrete solution, and the geometric levels to find
// it with.

#include <common/algorithms/nested_iteration.h>

#include <deal.II/grid/grid_out.h>

#include <fstream>
#include <iomanip>
#include <iostream>

#include <tests/support/check.h>

#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_large_coarse_mesh
{
  void
  write_mesh(const Triangulation<2> &mesh, const std::string &file_name)
  {
    GridOut grid_out;
    grid_out.set_flags(GridOutFlags::Msh(true, true));
    std::ofstream file(file_name);
    file << std::setprecision(17);
    grid_out.write_msh(mesh, file);
  }



  // Both begin on this mesh and have to find the contact zone on it, which
  // takes ten of their cycles. There are 17 of them with levels, and 21
  // without.
  void
  print(const NestedIteration<2> &iteration,
        const std::string        &what,
        const unsigned int        most_cycles)
  {
    const SolverReport &report = iteration.report();
    std::cout << what << ": " << iteration.mesh().n_cells(0)
              << " coarse cells of " << iteration.mesh().n_active_cells()
              << ", " << iteration.state().n_contact() << " nodes in contact, "
              << iteration.state().n_sticking() << " sticking"
              << (report.converged ? "" : ", not converged") << std::endl;
    check_below(report.certificate.largest(), 1e-6, "certificate");
    check_below(report.cycles.size(), most_cycles, "cycles");
  }
} // namespace test_large_coarse_mesh



TEST(large_coarse_mesh)
{
  const std::vector<std::string> overrides = {"Refinement/Levels=0",
                                              "Material/Poisson ratio=0.45"};

  const auto parameters = [&](std::vector<std::string> more) {
    more.insert(more.end(), overrides.begin(), overrides.end());
    return without_safeguards(read_parameters(SCENES_DIR "/block.prm", more));
  };

  NestedIteration<2> refined(parameters(
    {"Scene/Subdivisions=5, 5", "Refinement/Initial refinements=6"}));
  refined.begin();
  write_mesh(refined.mesh(), "large_coarse_mesh.msh");
  refined.solve();
  print(refined, "refined", 20);

  Parameters of_import      = parameters({"Refinement/Initial refinements=0"});
  of_import.scene.geometry  = GeometryKind::mesh_file;
  of_import.scene.mesh_file = "large_coarse_mesh.msh";
  NestedIteration<2> imported(of_import);
  imported.begin();
  imported.solve();
  print(imported, "imported", 23);

  check_below(std::abs(imported.report().energy / refined.report().energy - 1.),
              1e-9,
              "the same energy");
}

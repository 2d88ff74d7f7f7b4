// Cells that are much longer than wide: a frictional block takes about as many
// cycles as with squares, whichever way the cells lie, on all meshes. Without
// relaxation by lines, and in three dimensions by planes, it is around a
// hundred for an aspect ratio of ten. With several processes, these are cut,
// and it takes more cycles.

#include <common/algorithms/nested_iteration.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_stretched_cells
{
  template <int dim>
  void
  test(const std::string &subdivisions,
       const unsigned int first,
       const unsigned int levels,
       const unsigned int bound)
  {
    NestedIteration<dim> nest(without_safeguards(read_parameters(
      (dim == 2 ? SCENES_DIR "/" : SCENES_3D_DIR "/") +
        std::string("block.prm"),
      {"Scene/Subdivisions=" + subdivisions,
       "Refinement/Strategy=uniform",
       "Refinement/Initial refinements=" + std::to_string(first),
       "Refinement/Levels=" + std::to_string(levels)})));
    nest.begin();
    bool         converged   = true;
    unsigned int most_cycles = 0;
    do
      {
        nest.solve();
        converged = converged && nest.report().converged;
        most_cycles =
          std::max<unsigned int>(most_cycles, nest.report().cycles.size());
    } while (nest.advance());
    check_everywhere(
      converged && most_cycles <= bound,
      std::to_string(dim) + "D, cells " + subdivisions + ": solved in " +
        std::to_string(bound) + " cycles" +
        (most_cycles > bound ? ", no, " + std::to_string(most_cycles) : ""));
  }
} // namespace test_stretched_cells



TEST(stretched_cells)
{
  const bool alone = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
  test<2>("10, 1", 1, 3, alone ? 9 : 24);
  test<2>("1, 10", 1, 3, alone ? 10 : 24);
  if (alone)
    {
      test<2>("100, 1", 0, 3, 24);
      test<2>("1, 100", 0, 3, 9);
    }
  test<3>("1, 1, 10", 0, 2, alone ? 9 : 24);
  test<3>("10, 1, 1", 0, 2, alone ? 18 : 33);
  test<3>("1, 10, 10", 0, 1, alone ? 9 : 36);
  test<3>("8, 8, 1", 0, 1, alone ? 18 : 54);
}

// The maximum strategy marks what is expected, pairs of errors that differ by
// rounding alike, and nothing where there is no error.

#include <common/estimate/marking.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/grid/grid_generator.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include <tests/support/test.h>

using namespace dealii;

TEST(marking)
{
  parallel::distributed::Triangulation<2> triangulation(MPI_COMM_WORLD);
  GridGenerator::hyper_cube(triangulation);
  triangulation.refine_global(3);

  // Errors over nine orders of magnitude; each occurs twice, up to rounding.
  Vector<float> errors(triangulation.n_active_cells());
  for (unsigned int i = 0; i < errors.size(); ++i)
    errors(i) =
      std::pow(2., -static_cast<int>((i * 7) % 64) / 2) * (1. + 2e-7 * (i % 2));

  const auto smallest_marked = [&]() {
    double smallest = 1e300;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->refine_flag_set())
        smallest =
          std::min<double>(smallest, errors(cell->active_cell_index()));
    for (const auto &cell : triangulation.active_cell_iterators())
      cell->clear_refine_flag();
    return smallest;
  };

  std::cout << "maximum strategy" << std::endl;
  for (const double theta : {1., 0.6, 0.5, 0.1, 1e-9})
    {
      const unsigned int n =
        Friction::mark_by_maximum(triangulation, errors, theta);
      const double smallest = smallest_marked();
      std::cout << theta << ": " << n << " cells, down to " << smallest
                << std::endl;
    }

  errors = 0.;
  std::cout << "no error: "
            << Friction::mark_by_maximum(triangulation, errors, 0.5)
            << std::endl;
}

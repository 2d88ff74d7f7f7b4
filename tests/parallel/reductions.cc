// What is gathered is there in the order of the processes, and a process that
// has nothing adds nothing.

#include <common/parallel/reductions.h>

#include <deal.II/base/point.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;
using namespace Tests;

namespace test_reductions
{
  struct Item
  {
    char     process;
    double   number;
    Point<3> place;
  };
} // namespace test_reductions



TEST(reductions)
{
  const int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const int n    = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);

  // The second one has nothing.
  const auto n_items = [](const int process) {
    return process == 1 ? 0 : 3 + process;
  };
  std::vector<Item> own;
  for (int i = 0; i < n_items(rank); ++i)
    own.push_back(
      {char(rank), rank + .1 * i, Point<3>(1. * i, -2. * rank, i - .5)});
  const std::vector<Item> all = gather_from_all(own, MPI_COMM_WORLD);

  bool        good = true;
  std::size_t next = 0;
  for (int process = 0; process < n; ++process)
    for (int i = 0; i < n_items(process); ++i, ++next)
      good = good && next < all.size() && all[next].process == process &&
        all[next].number == process + .1 * i &&
        all[next].place == Point<3>(1. * i, -2. * process, i - .5);
  check_everywhere(good && next == all.size() && next > 0,
                   "in the order of the processes");
  check_everywhere(
    gather_from_all(std::vector<double>(), MPI_COMM_WORLD).empty(),
    "nothing of nothing");
}

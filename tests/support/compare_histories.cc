// Compares the protocols of two runs of the same scene, the second of them on
// more processes: the same levels, the same numbers of cells, unknowns, and
// nodes in contact and sticking, energies to ten digits, and at most two cycles
// more per level (with Algorithm 2 per outer iteration, with given forces per
// solution for them, but no more than half as many together). On meshes with
// fewer than 300 unknowns per process, where next to all nodes are at an
// interface, it may be half as many more.
//
// Usage: compare_histories HISTORY HISTORY PROCESSES

#include <deal.II/base/hdf5.h>
#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

int
main(int argc, char **argv)
{
  using namespace dealii;
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  AssertThrow(argc == 4, ExcMessage("Two files are to be compared."));
  const HDF5::File a(argv[1], HDF5::File::FileAccessMode::open);
  const HDF5::File b(argv[2], HDF5::File::FileAccessMode::open);
  const auto column = [](const HDF5::File &file, const std::string &name) {
    return file.open_group("levels")
      .open_dataset(name)
      .read<std::vector<double>>();
  };

  bool good = true;
  for (const std::string name :
       {"level", "cells", "dofs", "contact_nodes", "sticky_nodes", "energy"})
    {
      const auto x = column(a, name), y = column(b, name);
      if (x.size() != y.size())
        {
          std::cout << "FAILED: " << y.size() << " levels instead of "
                    << x.size() << std::endl;
          return 1;
        }
      for (unsigned int i = 0; i < x.size(); ++i)
        if (!(std::abs(x[i] - y[i]) <= 1e-10 * std::abs(x[i])))
          {
            std::cout.precision(13);
            std::cout << "FAILED: " << name << " on level " << i << " is "
                      << y[i] << " instead of " << x[i] << std::endl;
            good = false;
          }
    }
  const auto x = column(a, "cycles"), y = column(b, "cycles"),
             outer = column(a, "outer_iterations"), dofs = column(a, "dofs");
  const double n = std::stod(argv[3]);
  for (unsigned int i = 0; i < x.size(); ++i)
    if (const double half = std::max(2., x[i] / 2); y[i] >
        x[i] + (dofs[i] < 300 * n ? half : std::min(2. * outer[i], half)))
      {
        std::cout << "FAILED: " << y[i] << " cycles instead of " << x[i]
                  << " on level " << i << std::endl;
        good = false;
      }
  return good ? 0 : 1;
}

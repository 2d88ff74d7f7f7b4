// Compares the protocols of two runs of the same scene, the second of them on
// more processes: the same levels, the same numbers of cells, unknowns, and
// nodes in contact and sticking, energies to ten digits, and at most two cycles
// more per level (with Algorithm 2 per outer iteration, with given forces per
// solution for them, but no more than half as many together). On meshes with
// fewer than 300 unknowns per process, where next to all nodes are at an
// interface, it may be half as many more.
//
// Usage: compare_histories HISTORY HISTORY PROCESSES

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

namespace
{
  // Without deal.II, which takes longer to load than this takes to run, as
  // often as there are scenes on several processes.
  class History
  {
  public:
    explicit History(const char *name)
      : file(H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT))
    {}

    ~History()
    {
      H5Fclose(file);
    }

    // The values of all levels.
    std::vector<double>
    column(const std::string &name) const
    {
      const hid_t data = H5Dopen(file, ("levels/" + name).c_str(), H5P_DEFAULT);
      const hid_t space        = H5Dget_space(data);
      const hssize_t      size = H5Sget_simple_extent_npoints(space);
      std::vector<double> values(size < 0 ? 0 : size);
      const herr_t        status = H5Dread(
        data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
      if (size < 1 || status < 0)
        {
          std::cout << "FAILED: " << name << " cannot be read" << std::endl;
          std::exit(1);
        }
      H5Sclose(space);
      H5Dclose(data);
      return values;
    }

  private:
    const hid_t file;
  };
} // namespace



int
main(int argc, char **argv)
{
  if (argc != 4)
    {
      std::cout << "Usage: compare_histories HISTORY HISTORY PROCESSES"
                << std::endl;
      return 2;
    }
  const History a(argv[1]), b(argv[2]);

  bool good = true;
  for (const std::string name :
       {"level", "cells", "dofs", "contact_nodes", "sticky_nodes", "energy"})
    {
      const std::vector<double> x = a.column(name), y = b.column(name);
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
  const std::vector<double> x = a.column("cycles"), y = b.column("cycles"),
                            outer = a.column("outer_iterations"),
                            dofs  = a.column("dofs");
  const double n                  = std::stod(argv[3]);
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

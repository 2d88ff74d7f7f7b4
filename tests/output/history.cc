// The history of a run: what is written comes back unchanged, with the names
// and shapes scripts rely on, and each level replaces the file as a whole. Each
// number says what it is and which unit it has, in two dimensions and in three;
// the table of levels is there as text, too.

#include <common/output/history.h>
#include <common/output/run_directory.h>
#include <common/output/units.h>

#include <deal.II/base/hdf5.h>
#include <deal.II/base/mpi.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

#include <tests/support/test.h>

using namespace Friction;

namespace test_history
{
  // The units of all kinds of numbers.
  void
  print_units(const Parameters::UnitNames &names)
  {
    std::cout << "length '" << names.length << "', force '" << names.force
              << "'" << std::endl;
    for (const unsigned int dim : {2, 3})
      {
        std::cout << "  " << dim << "D:";
        for (const Quantity quantity : {Quantity::number,
                                        Quantity::length,
                                        Quantity::area,
                                        Quantity::force,
                                        Quantity::stress,
                                        Quantity::energy,
                                        Quantity::energy_norm,
                                        Quantity::time})
          std::cout << " '" << unit_of(quantity, dim, names) << '\'';
        std::cout << std::endl;
      }
  }
} // namespace test_history

TEST(history)
{
  const RunDirectory directory("history-test/nested/directory");
  History<2>         history(
    directory.file("history.h5"),
    {"hertz", "subsection Scene\nend\n", "0.1.0", {"mm", "N"}});

  for (unsigned int l = 0; l < 3; ++l)
    {
      LevelRecord level;
      level.level        = l;
      level.cells        = 40u << (2 * l);
      level.energy       = -0.25 * (l + 1);
      level.normal_force = 1. + l;

      std::vector<CycleRecord> cycles(l + 1);
      for (unsigned int i = 0; i < cycles.size(); ++i)
        {
          cycles[i].level     = l;
          cycles[i].increment = 1. / (1 << i);
          cycles[i].truncated = i;
        }

      // No contact on the first level.
      std::vector<ContactRecord<2>> contact(2 * l);
      for (unsigned int i = 0; i < contact.size(); ++i)
        {
          contact[i].point          = dealii::Point<2>(i, -1.);
          contact[i].force          = dealii::Tensor<1, 2>({0.5, 2. * i});
          contact[i].gap            = 0.125 * i;
          contact[i].state          = i % 3;
          contact[i].normal         = dealii::Tensor<1, 2>({0., -1.});
          contact[i].displacement   = dealii::Tensor<1, 2>({0.5, 0.25});
          contact[i].friction_bound = 0.75;
        }
      history.add_level(level, cycles, contact);
    }

  std::set<std::string> names;
  for (const auto &entry :
       std::filesystem::directory_iterator(directory.path()))
    names.insert(entry.path().filename().string());
  for (const std::string &name : names)
    std::cout << name << std::endl;

  const dealii::HDF5::File file(directory.file("history.h5"),
                                dealii::HDF5::File::FileAccessMode::open);
  std::cout << file.get_attribute<std::string>("scene") << ' '
            << file.get_attribute<std::string>("version") << std::endl
            << file.get_attribute<std::string>("parameters");

  const auto print = [&](const std::string &group, const std::string &name) {
    auto dataset = file.open_group(group).open_dataset(name);
    std::cout << group << '/' << name << " [";
    for (const auto n : dataset.get_dimensions())
      std::cout << ' ' << n;
    std::cout << " ]:";
    for (const double value : dataset.read<std::vector<double>>())
      std::cout << ' ' << value;
    std::cout << std::endl;
  };
  for (const char *name : {"level",
                           "cells",
                           "dofs",
                           "contact_nodes",
                           "sticky_nodes",
                           "outer_iterations",
                           "cycles",
                           "contraction",
                           "energy",
                           "normal_force",
                           "tangential_force",
                           "max_pressure",
                           "contact_half_width",
                           "stick_half_width",
                           "contact_half_width_error",
                           "contact_resolution",
                           "estimated_error",
                           "certificate",
                           "setup_seconds",
                           "solve_seconds"})
    print("levels", name);
  for (const char *name :
       {"level", "increment", "energy", "damping", "truncated", "residual"})
    print("cycles", name);
  for (const char *name : {"point",
                           "normal",
                           "gap",
                           "force",
                           "displacement",
                           "slip",
                           "measure",
                           "friction_bound",
                           "state"})
    print("contact/level_02", name);

  std::cout << "levels.csv" << std::endl
            << std::ifstream(directory.file("levels.csv")).rdbuf();

  for (const std::string dataset : {"levels/energy",
                                    "levels/max_pressure",
                                    "levels/solve_seconds",
                                    "cycles/residual",
                                    "contact/level_02/slip",
                                    "contact/level_02/friction_bound"})
    {
      const auto data = file.open_dataset(dataset);
      std::cout << dataset << ": " << data.get_attribute<std::string>("label")
                << ", " << data.get_attribute<std::string>("units")
                << std::endl;
    }
  print_units({"mm", "N"});
  print_units({"m", ""});
  print_units({"", ""});
}

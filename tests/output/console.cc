// The table on the console, without what depends on the clock.

#include <common/output/console.h>

#include <iostream>

using namespace Friction;

int
main(int argc, char *argv[])
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  Console console(std::cout, Console::Times::hidden);
  for (unsigned int l = 0; l < 10; l += 3)
    {
      LevelRecord record;
      record.level            = l;
      record.cells            = 40u << (2 * l);
      record.dofs             = 102u << (2 * l);
      record.contact_nodes    = 1 + 2 * l;
      record.sticky_nodes     = l;
      record.outer_iterations = 1;
      record.cycles           = 9 + l / 3;
      record.contraction      = 0.25;
      record.energy           = -1.25e-3;
      record.solve_seconds    = 17. * l;
      console.progress(l, 1, 1e-3);
      console.level_complete(record);
      if (l == 3)
        console.note("Warning: a remark between the rows.");
    }

  // A run that is continued prints again what it has printed.
  std::cout << "repeated" << std::endl;
  Console                  repeated(std::cout, Console::Times::hidden);
  std::vector<LevelRecord> levels(2);
  levels[1].level = 1;
  repeated.repeat(levels, console.notes());

  Console silent(std::cout, Console::Times::shown, true);
  silent.level_complete(LevelRecord());
  silent.note("nobody reads this");
}

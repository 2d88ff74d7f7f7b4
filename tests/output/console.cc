// The table on the console, without what depends on the clock; and that a file
// gets a sign of life in long levels, and none in short ones.

#include <common/output/console.h>

#include <chrono>
#include <iostream>
#include <sstream>
#include <thread>

#include <tests/support/test.h>

using namespace Friction;

TEST(console)
{
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

  Console silent(std::cout, Console::Times::shown, Verbosity::quiet);
  silent.level_complete(LevelRecord());
  silent.note("nobody reads this");

  // Rows come within a second each, and then none for more than five.
  std::ostringstream file;
  Console            followed(file, Console::Times::shown);
  std::ostringstream rows;
  Console            table(rows, Console::Times::shown, Verbosity::levels);
  const auto         wait = [&](const unsigned int tenths) {
    for (unsigned int i = 1; i <= tenths; ++i)
      {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        followed.progress(2, i, 1e-3);
        table.progress(2, i, 1e-3);
      }
  };
  wait(8);
  followed.level_complete(LevelRecord());
  wait(8);
  followed.level_complete(LevelRecord());
  const bool none_in_short_levels =
    file.str().find("cycle 8") == std::string::npos;
  wait(55);
  const std::string text = file.str();
  std::cout << "progress in a file: short levels "
            << (none_in_short_levels ? "none" : "some") << ", a long one "
            << (text.find("  level 2: cycle ") != text.npos &&
                    text.find(", increment 1.0e-03, after ") != text.npos &&
                    text.back() == '\n'
                  ? "some"
                  : "none")
            << ", with rows only " << (rows.str().empty() ? "none" : "some")
            << std::endl;
}

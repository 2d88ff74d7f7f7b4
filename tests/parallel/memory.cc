// What a group of processes may still take of its limit, from files like those
// of the system: in its second and in its first version, with and without a
// limit, and if some of the numbers are missing. Files that have been read and
// may be forgotten are no memory that is gone.

#include <common/parallel/memory.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <tests/support/check.h>
#include <tests/support/test.h>

using namespace Friction;
using namespace Tests;

namespace test_memory
{
  double
  left(const std::map<std::string, std::string> &files)
  {
    namespace fs          = std::filesystem;
    const fs::path folder = "group";
    fs::remove_all(folder);
    fs::create_directories(folder / "memory");
    for (const auto &[name, content] : files)
      std::ofstream(folder / name) << content;
    const double result = memory_left_to_group(folder.string());
    fs::remove_all(folder);
    return result;
  }
} // namespace test_memory



TEST(memory)
{
  const std::string stat = "anon 100\nfile 700\ninactive_file 600\nshmem 1\n";
  check(left({{"memory.max", "1000\n"},
              {"memory.current", "800\n"},
              {"memory.stat", stat}}) == 800.,
        "what is used is less what has been read");
  check(left({{"memory.max", "1000\n"},
              {"memory.current", "1800\n"},
              {"memory.stat", stat}}) == 0.,
        "there may be nothing left");
  check(left({{"memory.max", "1000\n"},
              {"memory.current", "500\n"},
              {"memory.stat", stat}}) == 1000.,
        "but never more than the limit");
  check(std::isinf(left({{"memory.max", "max\n"},
                         {"memory.current", "800\n"},
                         {"memory.stat", stat}})),
        "no limit");
  check(std::isinf(left({})), "nothing is said");
  check(std::isinf(left({{"memory.current", "800\n"}, {"memory.stat", stat}})),
        "no limit is said");
  check(left({{"memory.max", "1000\n"}, {"memory.current", "800\n"}}) == 1000.,
        "not said how much has been read");
  check(left({{"memory.max", "1000\n"}, {"memory.stat", stat}}) == 1000.,
        "not said how much is used");
  check(left({{"memory.max", "1000\n"},
              {"memory.current", "800\n"},
              {"memory.stat", "anon 100\nfile nothing\n"}}) == 1000.,
        "not said in a way that can be read");

  const std::string first_stat =
    "cache 700\ninactive_file 5\ntotal_inactive_file 600\n";
  check(left({{"memory/memory.limit_in_bytes", "1000\n"},
              {"memory/memory.usage_in_bytes", "800\n"},
              {"memory/memory.stat", first_stat}}) == 800.,
        "the first version");
  check(left({{"memory/memory.limit_in_bytes", "9223372036854771712\n"},
              {"memory/memory.usage_in_bytes", "800\n"},
              {"memory/memory.stat", first_stat}}) > 1e18,
        "in which a very large limit is none");

  check(memory_within_reach(MPI_COMM_SELF) >= 0., "and this machine");
}

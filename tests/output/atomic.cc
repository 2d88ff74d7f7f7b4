// Files appear complete or not at all: if writing fails, whatever the reason,
// the previous file is still there and no temporary one is left.

#include <common/output/history.h>
#include <common/output/run_directory.h>
#include <common/parameters/wrong_number.h>
#include <sys/resource.h>

#include <deal.II/base/mpi.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>

#include <tests/support/test.h>

using namespace Friction;

namespace test_atomic
{
  void
  list_files(const RunDirectory &directory)
  {
    std::set<std::string> names;
    for (const auto &entry :
         std::filesystem::directory_iterator(directory.path()))
      names.insert(entry.path().filename().string());
    std::cout << "  files:";
    for (const std::string &name : names)
      std::cout << ' ' << name;
    std::cout << std::endl;
  }



  template <typename Function>
  void
  try_to(const Function &function)
  {
    try
      {
        function();
        std::cout << "  written" << std::endl;
      }
    catch (const InputError &error)
      {
        std::cout << "  InputError: " << error.what() << std::endl;
      }
    catch (const std::exception &error)
      {
        std::cout << "  another exception: " << error.what() << std::endl;
      }
  }



  // A limit on the size of files acts like a disk that is full.
  void
  limit_file_size(const rlim_t bytes)
  {
    rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
} // namespace test_atomic

TEST(atomic)
{
  std::signal(SIGXFSZ, SIG_IGN);
  std::filesystem::remove_all("atomic-test");

  const RunDirectory directory("atomic-test/a");

  std::cout << "first version" << std::endl;
  try_to([&]() {
    directory.write("text.txt", [](std::ostream &out) { out << "one\n"; });
  });
  list_files(directory);

  std::cout << "a writer that throws" << std::endl;
  try_to([&]() {
    directory.write("text.txt", [](std::ostream &out) {
      out << "two\n";
      throw std::runtime_error("lost interest");
    });
  });
  list_files(directory);

  std::cout << "a stream that fails" << std::endl;
  limit_file_size(1000);
  try_to([&]() {
    directory.write("text.txt",
                    [](std::ostream &out) { out << std::string(100000, 'x'); });
  });
  list_files(directory);

  std::cout << "a stream that fails when it is closed" << std::endl;
  try_to([&]() {
    directory.write("text.txt",
                    [](std::ostream &out) { out << std::string(1500, 'x'); });
  });
  list_files(directory);

  std::cout << "a history that does not fit" << std::endl;
  History<2> history(directory.file("history.h5"), {"hertz", "", "0"});
  try_to([&]() { history.add_level(LevelRecord(), {}, {}); });
  list_files(directory);
  std::cout << "room for a file that there is" << std::endl;
  for (const std::uint64_t size : {1000ull, 1ull << 60})
    try_to(
      [&]() { demand_space(directory.file("text.txt"), MPI_COMM_SELF, size); });
  list_files(directory);

  limit_file_size(RLIM_INFINITY);
  std::cout << "the file is still the first version: ";
  std::ifstream in(directory.file("text.txt"));
  std::cout << in.rdbuf();

  std::cout << "and then there is room again" << std::endl;
  try_to([&]() { history.add_level(LevelRecord(), {}, {}); });
  list_files(directory);

  std::cout << "a directory below a file" << std::endl;
  try_to([&]() { RunDirectory("atomic-test/a/text.txt/b"); });
  std::cout << "a file instead of a directory" << std::endl;
  try_to([&]() { RunDirectory("atomic-test/a/text.txt"); });
}

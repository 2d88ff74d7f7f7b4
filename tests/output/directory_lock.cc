// A directory has one run at a time: the second one says who has it, a lock
// that was left by another run keeps no run out, and without locks there is a
// warning.

#include <common/input_error.h>
#include <common/output/directory_lock.h>
#include <sys/syscall.h>
#include <tests/support/check.h>
#include <tests/support/test.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <regex>

using namespace Friction;

namespace
{
  // The answer of a file system that is asked for a lock, or 0 for the real
  // one.
  int its_error = 0;
} // namespace



// This one takes the place of the function of the system, in the library as
// well.
extern "C" int
flock(int descriptor, int operation) noexcept
{
  if (its_error == 0)
    return syscall(SYS_flock, descriptor, operation);
  errno = its_error;
  return -1;
}



namespace test_directory_lock
{
  // Without what is another one in each run.
  std::string
  anonymous(const std::string &text)
  {
    const std::regex owner(
      "process [0-9]+ on [^ ,]+, since [0-9]{4}-[0-9]{2}-[0-9]{2} "
      "[0-9]{2}:[0-9]{2}:[0-9]{2} UTC");
    return std::regex_replace(text, owner, "OWNER");
  }



  std::string
  attempt(const RunDirectory &directory)
  {
    try
      {
        const DirectoryLock lock(directory, MPI_COMM_WORLD);
        return lock.warning().empty() ? "locked" : lock.warning();
      }
    catch (const InputError &error)
      {
        return anonymous(error.what());
      }
  }
} // namespace test_directory_lock

TEST(directory_lock)
{
  const bool first =
    dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  if (first)
    std::filesystem::remove_all("lock-test");
  MPI_Barrier(MPI_COMM_WORLD);
  const RunDirectory directory("lock-test", MPI_COMM_WORLD);
  const std::string  file = directory.file(".lock");

  const auto print = [&](const std::string &what) {
    if (first)
      std::cout << what << std::endl;
  };
  const auto check_no_file = [&]() {
    MPI_Barrier(MPI_COMM_WORLD);
    Tests::check_everywhere(!std::filesystem::exists(file), "no file is left");
  };

  {
    const DirectoryLock lock(directory, MPI_COMM_WORLD);
    MPI_Barrier(MPI_COMM_WORLD);
    std::ifstream in(file);
    std::string   text;
    std::getline(in, text);
    print(anonymous(text));
    Tests::check_everywhere(
      !first || text.find("process " + std::to_string(getpid()) + " on ") == 0,
      "it names this process");
    print(attempt(directory));
    print(attempt(directory));
    MPI_Barrier(MPI_COMM_WORLD);
    Tests::check_everywhere(std::filesystem::exists(file),
                            "the first one still has it");

    // Runs elsewhere are of no concern.
    const RunDirectory other("lock-test/other", MPI_COMM_WORLD);
    print(attempt(other));
  }
  check_no_file();

  // Left by a run that was killed, with a text that may be anything.
  if (first)
    std::ofstream(file) << "process 1 on another, since long" << '\x1b'
                        << std::string(100000, 'x');
  MPI_Barrier(MPI_COMM_WORLD);
  print(attempt(directory));
  check_no_file();

  // The owner has not yet written, or has written nonsense.
  {
    const DirectoryLock lock(directory, MPI_COMM_WORLD);
    if (first)
      std::ofstream(file) << "";
    print(attempt(directory));
    if (first)
      std::ofstream(file) << '\x1b' << std::string(100000, 'x');
    const std::string sentence = attempt(directory);
    Tests::check_everywhere(sentence.size() < 500 &&
                              sentence.find('\x1b') == sentence.npos,
                            "nonsense is not repeated");
  }
  check_no_file();

  if (first)
    std::filesystem::create_directory(file);
  MPI_Barrier(MPI_COMM_WORLD);
  print(attempt(directory));
  MPI_Barrier(MPI_COMM_WORLD);
  if (first)
    std::filesystem::remove(file);

  // Its file was removed by hand, and another run has begun: the file is the
  // one of that run then, and stays.
  {
    auto lock = std::make_unique<DirectoryLock>(directory, MPI_COMM_WORLD);
    MPI_Barrier(MPI_COMM_WORLD);
    if (first)
      std::filesystem::remove(file);
    MPI_Barrier(MPI_COMM_WORLD);
    const DirectoryLock other(directory, MPI_COMM_WORLD);
    lock.reset();
    MPI_Barrier(MPI_COMM_WORLD);
    Tests::check_everywhere(std::filesystem::exists(file),
                            "the file of another run stays");
    print(attempt(directory));
  }
  check_no_file();

  // What file systems without locks answer.
  for (const int error : {ENOLCK, EOPNOTSUPP, ENOSYS})
    {
      its_error                  = error;
      const std::string sentence = attempt(directory);
      its_error                  = 0;
      Tests::check_everywhere(!first ||
                                sentence.find("Warning: the directory "
                                              "'lock-test' cannot be locked") ==
                                  0,
                              "without locks there is a warning");
      check_no_file();
    }
}

#include <deal.II/base/mpi.h>

#include <cstdlib>
#include <iostream>
#include <map>
#include <tests/support/test.h>

namespace Tests
{
  namespace
  {
    // Not a variable, since registrations are made before main() in any order.
    std::map<std::string, void (*)()> &
    tests()
    {
      static std::map<std::string, void (*)()> all;
      return all;
    }

    std::vector<std::string> given_arguments;
  } // namespace



  Registration::Registration(const char *name, void (*run)())
  {
    tests().emplace(name, run);
  }



  const std::vector<std::string> &
  arguments()
  {
    return given_arguments;
  }
} // namespace Tests



int
main(int argc, char **argv)
{
  std::vector<std::string> words(argv + 1, argv + argc);
  if (const char *const name = std::getenv("FRICTION_TEST"))
    words.insert(words.begin(), name);
  const auto &tests = Tests::tests();
  const auto  test  = tests.find(words.empty() ? "" : words.front());
  if (test == tests.end())
    {
      std::cerr << "Which test? There are";
      for (const auto &known : tests)
        std::cerr << ' ' << known.first;
      std::cerr << '.' << std::endl;
      return 2;
    }
  Tests::given_arguments.assign(words.begin() + 1, words.end());
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test->second();
  return 0;
}

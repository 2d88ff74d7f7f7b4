#include <deal.II/base/mpi.h>

#include <tests/benchmarks/benchmark.h>

#include <iostream>
#include <map>
#include <string>

namespace Benchmark
{
  namespace
  {
    // Not a variable, since registrations are made before main() in any order.
    std::map<std::string, int (*)(int, char **)> &
    benchmarks()
    {
      static std::map<std::string, int (*)(int, char **)> all;
      return all;
    }
  } // namespace



  Registration::Registration(const char *name, int (*run)(int, char **))
  {
    benchmarks().emplace(std::string("benchmark-") + name, run);
  }
} // namespace Benchmark



int
main(int argc, char **argv)
{
  std::string name = argv[0];
  name.erase(0, name.rfind('/') + 1);
  const auto &benchmarks = Benchmark::benchmarks();
  const auto  benchmark  = benchmarks.find(name);
  if (benchmark == benchmarks.end())
    {
      std::cerr << "Which benchmark? It has to be called as one of";
      for (const auto &known : benchmarks)
        std::cerr << ' ' << known.first;
      std::cerr << '.' << std::endl;
      return 2;
    }
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return benchmark->second(argc, argv);
}

#ifndef tests_benchmarks_benchmark_h
#define tests_benchmarks_benchmark_h

// Benchmarks are one program that has several names, benchmark-cost and so on,
// since the headers of deal.II take longer to compile than any of them. Its
// main() starts MPI and calls that whose name it was called by, for the exit
// status:
//
//   namespace benchmark_cost
//   {
//     ... what it needs
//   }
//
//   BENCHMARK(cost)
//   {
//     ... what it does with argc and argv; names of benchmark_cost are known
//     here
//   }
#define BENCHMARK(name)                                                         \
  namespace benchmark_##name                                                    \
  {                                                                             \
    static int                           run_benchmark(int argc, char *argv[]); \
    static const Benchmark::Registration is_benchmark(#name, &run_benchmark);   \
  }                                                                             \
  static int benchmark_##name::run_benchmark(int argc, char *argv[])

namespace Benchmark
{
  /** That there is a benchmark. */
  struct Registration
  {
    Registration(const char *name, int (*run)(int, char **));
  };
} // namespace Benchmark

#endif

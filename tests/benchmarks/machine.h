#ifndef friction_tests_benchmarks_machine_h
#define friction_tests_benchmarks_machine_h

#include <deal.II/base/timer.h>

#include <common/nodes/huge_pages.h>
#include <common/nodes/instructions.h>

#include <algorithm>
#include <cstddef>
#include <functional>

// What the machine can do at best.
namespace Benchmark
{
  inline double
  best_of(const unsigned int n, const std::function<void()> &work)
  {
    double best = 1e300;
    for (unsigned int i = 0; i < n; ++i)
      {
        dealii::Timer timer;
        work();
        best = std::min(best, timer.wall_time());
      }
    return best;
  }



  /** Bytes per second of a triad on vectors far larger than any cache, in large
   * pages as matrices are. */
  inline double
  triad_bandwidth()
  {
    const std::size_t                n = 20000000;
    Friction::HugePageVector<double> a(n, 0.), b(n, 1.), c(n, 2.);
    const double                     seconds = best_of(5, [&]() {
      for (std::size_t i = 0; i < n; ++i)
        a[i] = b[i] + 3. * c[i];
    });
    // Read b and c, read and write a.
    return 4. * n * sizeof(double) / seconds + (a[n / 2] < 0 ? 1. : 0.);
  }



  // Products and sums of numbers in registers, as many as are independent of
  // each other that none has to wait.
  namespace PeakArithmetic
  {
    constexpr unsigned int n_vectors = 12, n_turns = 1000000;

    template <typename Vector>
    inline DEAL_II_ALWAYS_INLINE void
    work(double *result)
    {
      Vector sums[n_vectors] = {}, factor = {}, more = {};
      for (unsigned int i = 0; i < sizeof(Vector) / sizeof(double); ++i)
        {
          factor[i] = result[0];
          more[i]   = result[1];
        }
      for (unsigned int turn = 0; turn < n_turns; ++turn)
        for (unsigned int v = 0; v < n_vectors; ++v)
          sums[v] = sums[v] * factor + more;
      for (unsigned int v = 0; v < n_vectors; ++v)
        for (unsigned int i = 0; i < sizeof(Vector) / sizeof(double); ++i)
          result[2] += sums[v][i];
    }

    inline void
    common(double *result)
    {
      typedef double Pair __attribute__((vector_size(16)));
      work<Pair>(result);
    }

#if defined(__x86_64__) && defined(__GNUC__)
    __attribute__((target("avx2,fma"))) inline void
    avx2(double *result)
    {
      typedef double Quad __attribute__((vector_size(32)));
      work<Quad>(result);
    }
#endif
  } // namespace PeakArithmetic



  /** Products and sums per second, with the instructions that the kernels use.
   */
  inline double
  peak_arithmetic()
  {
    double       result[3]  = {.5, 1., 0.};
    unsigned int per_vector = 2;
    auto         work       = PeakArithmetic::common;
#if defined(__x86_64__) && defined(__GNUC__)
    if (Friction::available_instructions().back() ==
        Friction::Instructions::avx2)
      {
        work       = PeakArithmetic::avx2;
        per_vector = 4;
      }
#endif
    const double seconds = best_of(10, [&]() { work(result); });
    return 2. * per_vector * PeakArithmetic::n_vectors *
      PeakArithmetic::n_turns / seconds +
      (result[2] < 0 ? 1. : 0.);
  }
} // namespace Benchmark

#endif

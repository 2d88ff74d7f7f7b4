#ifndef friction_tests_support_random_h
#define friction_tests_support_random_h

#include <random>

namespace Tests
{
  /**
   * Random numbers that are the same on every machine. The distributions of the
   * standard library are not, its generators are.
   */
  class Random
  {
  public:
    explicit Random(const unsigned int seed)
      : generator(seed)
    {}

    /** Uniform in [low, high). */
    double
    operator()(const double low, const double high)
    {
      return low + (high - low) * (generator() / 4294967296.);
    }

    bool
    chance(const double probability)
    {
      return (*this)(0., 1.) < probability;
    }

    /** 0, ..., n-1. */
    unsigned int
    below(const unsigned int n)
    {
      return generator() % n;
    }

  private:
    std::mt19937 generator;
  };
} // namespace Tests

#endif

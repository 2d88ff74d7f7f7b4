#ifndef friction_parallel_owned_values_h
#define friction_parallel_owned_values_h

#include <common/parallel/vector_type.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  // Vector operations on the values that a process owns. Ghosts stay as they
  // are, and hold values of before until the next exchange. In debug mode
  // deal.II from 9.7 on refuses this to its own operators, where a vector has
  // ghosts that a GhostExchange has brought, of which deal.II does not know.

  /** v := factor v. */
  inline void
  scale_owned(VectorType &v, const double factor)
  {
    AssertIsFinite(factor);
    double            *values = v.begin();
    const unsigned int n      = v.locally_owned_size();
    DEAL_II_OPENMP_SIMD_PRAGMA
    for (unsigned int i = 0; i < n; ++i)
      values[i] *= factor;
  }

  /** u := a u + b v. */
  inline void
  combine_owned(VectorType       &u,
                const double      a,
                const double      b,
                const VectorType &v)
  {
    AssertIsFinite(a);
    AssertIsFinite(b);
    AssertDimension(u.locally_owned_size(), v.locally_owned_size());
    double            *values = u.begin();
    const double      *added  = v.begin();
    const unsigned int n      = u.locally_owned_size();
    DEAL_II_OPENMP_SIMD_PRAGMA
    for (unsigned int i = 0; i < n; ++i)
      values[i] = a * values[i] + b * added[i];
  }

  /** u := u + factor v. */
  inline void
  add_owned(VectorType &u, const double factor, const VectorType &v)
  {
    combine_owned(u, 1., factor, v);
  }

  /** term(0) + ... + term(n-1), by four sums at once: with a single one, every
   * addition would have to wait for the one before. */
  template <typename Term>
  inline double
  sum_of_terms(const unsigned int n, const Term &term)
  {
    double       sums[4] = {0., 0., 0., 0.};
    unsigned int i       = 0;
    for (; i + 4 <= n; i += 4)
      for (unsigned int lane = 0; lane < 4; ++lane)
        sums[lane] += term(i + lane);
    for (; i < n; ++i)
      sums[0] += term(i);
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
  }

  /** This process' share of u . v. */
  inline double
  dot_owned(const VectorType &u, const VectorType &v)
  {
    AssertDimension(u.locally_owned_size(), v.locally_owned_size());
    const double *a = u.begin(), *b = v.begin();
    return sum_of_terms(u.locally_owned_size(),
                        [=](const unsigned int i) { return a[i] * b[i]; });
  }

  /** The largest absolute value that this process has. */
  inline double
  largest_owned(const VectorType &v)
  {
    double        largest[4] = {0., 0., 0., 0.};
    const double *values     = v.begin();
    for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
      largest[i % 4] = std::max(largest[i % 4], std::abs(values[i]));
    return std::max(std::max(largest[0], largest[1]),
                    std::max(largest[2], largest[3]));
  }
} // namespace Friction

#endif

#ifndef friction_parallel_owned_values_h
#define friction_parallel_owned_values_h

#include <deal.II/lac/la_parallel_vector.h>

namespace Friction
{
  /**
   * Vector operations on the values that a process owns. Ghosts stay as they
   * are, and hold values of before until the next exchange. In debug mode
   * deal.II from 9.7 on refuses this to its own operators, where a vector has
   * ghosts that a GhostExchange has brought, of which deal.II does not know.
   */
  using OwnedValues = dealii::LinearAlgebra::distributed::Vector<double>;

  /** v := factor v. */
  inline void
  scale_owned(OwnedValues &v, const double factor)
  {
    AssertIsFinite(factor);
    double            *values = v.begin();
    const unsigned int n      = v.locally_owned_size();
    DEAL_II_OPENMP_SIMD_PRAGMA
    for (unsigned int i = 0; i < n; ++i)
      values[i] *= factor;
  }

  /** u := u + factor v. */
  inline void
  add_owned(OwnedValues &u, const double factor, const OwnedValues &v)
  {
    AssertIsFinite(factor);
    AssertDimension(u.locally_owned_size(), v.locally_owned_size());
    double            *values = u.begin();
    const double      *added  = v.begin();
    const unsigned int n      = u.locally_owned_size();
    DEAL_II_OPENMP_SIMD_PRAGMA
    for (unsigned int i = 0; i < n; ++i)
      values[i] += factor * added[i];
  }
} // namespace Friction

#endif

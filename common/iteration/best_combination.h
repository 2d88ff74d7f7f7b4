#ifndef friction_iteration_best_combination_h
#define friction_iteration_best_combination_h

#include <vector>

namespace Friction
{
  /**
   * The coefficients c_0, ..., c_{n-1} of the combination of n vectors b_i that
   * comes closest to a vector x in a scalar product, from the scalar products
   * alone: the normal equations.
   *
   * @param products   for each i the product of b_i with x, then those of b_i
   *                   with b_0, ..., b_i: n (n+3) / 2 numbers, which can be
   *                   summed over all processes at once.
   * @param n          the number of vectors, a few. Those that are sums of
   *                   others up to rounding have the coefficient zero, and so
   *                   have vectors of length zero.
   * @return n coefficients, or none where they would not be finite.
   */
  std::vector<double> best_combination(const std::vector<double> &products,
                                       const unsigned int         n);
} // namespace Friction

#endif

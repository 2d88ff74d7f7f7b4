#include <common/dense_algebra.h>
#include <common/iteration/best_combination.h>

#include <cmath>

namespace Friction
{
  std::vector<double>
  best_combination(const std::vector<double> &products, const unsigned int n)
  {
    Eigen::MatrixXd gram(n, n);
    Eigen::VectorXd rhs(n), scale(n);
    auto            product = products.begin();
    for (unsigned int i = 0; i < n; ++i)
      {
        rhs(i) = *product++;
        for (unsigned int j = 0; j <= i; ++j)
          gram(i, j) = gram(j, i) = *product++;
        scale(i) = gram(i, i) > 0 ? 1. / std::sqrt(gram(i, i)) : 0.;
      }
    if (n == 0)
      return {};

    // Scaled to a unit diagonal; what depends on the others is left out by the
    // pivoted factorisation.
    const Eigen::VectorXd coefficients = scale.asDiagonal() *
      least_squares(scale.asDiagonal() * gram * scale.asDiagonal(),
                    scale.asDiagonal() * rhs);
    if (!coefficients.allFinite())
      return {};
    return {coefficients.data(), coefficients.data() + n};
  }
} // namespace Friction

#include <common/algorithms/mixed_fixed_point.h>
#include <common/iteration/best_combination.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  namespace
  {
    double
    share(const std::vector<double> &a, const std::vector<double> &b)
    {
      double sum = 0;
      for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
      return sum;
    }



    std::vector<double>
    difference(const std::vector<double> &a, const std::vector<double> &b)
    {
      std::vector<double> result(a);
      for (std::size_t i = 0; i < a.size(); ++i)
        result[i] -= b[i];
      return result;
    }
  } // namespace



  MixedFixedPoint::MixedFixedPoint(const unsigned int depth,
                                   const double       damping,
                                   const MPI_Comm     communicator)
    : depth(depth)
    , communicator(communicator)
    , present_damping(damping)
  {}



  std::vector<double>
  MixedFixedPoint::next(const std::vector<double> &given,
                        const std::vector<double> &found)
  {
    // A residual this much larger than the smallest one is not worth learning
    // from.
    constexpr double too_large = 2.;
    // No smaller parts of the way than this.
    constexpr double smallest_damping = 1. / 64.;

    std::vector<double> point = given, residual = difference(found, given);
    if (depth == 0)
      {
        for (std::size_t i = 0; i < point.size(); ++i)
          point[i] += present_damping * residual[i];
        return point;
      }

    const double size =
      std::sqrt(sum_over_processes(share(residual, residual), communicator));
    if (smallest < 0 || size < smallest)
      {
        smallest      = size;
        best_point    = point;
        best_residual = residual;
      }
    else if (size > too_large * smallest && !steps.empty())
      {
        point           = best_point;
        residual        = best_residual;
        present_damping = std::min(
          present_damping, std::max(present_damping / 2., smallest_damping));
        steps.clear();
        changes.clear();
        has_last = false;
      }

    if (has_last)
      {
        steps.push_front(difference(point, last_point));
        changes.push_front(difference(residual, last_residual));
        if (steps.size() > depth)
          {
            steps.pop_back();
            changes.pop_back();
          }
      }
    has_last      = true;
    last_point    = point;
    last_residual = residual;

    // The combination of changes that comes closest to the residual; all scalar
    // products in one reduction.
    const unsigned int  n = steps.size();
    std::vector<double> products;
    for (unsigned int i = 0; i < n; ++i)
      {
        products.push_back(share(changes[i], residual));
        for (unsigned int j = 0; j <= i; ++j)
          products.push_back(share(changes[i], changes[j]));
      }
    sum_over_processes(products, communicator);
    std::vector<double> coefficients = best_combination(products, n);
    coefficients.resize(n, 0.);

    for (std::size_t i = 0; i < point.size(); ++i)
      {
        double p = point[i], r = residual[i];
        for (unsigned int k = 0; k < n; ++k)
          {
            p -= coefficients[k] * steps[k][i];
            r -= coefficients[k] * changes[k][i];
          }
        point[i] = std::max(0., p + present_damping * r);
      }
    return point;
  }
} // namespace Friction

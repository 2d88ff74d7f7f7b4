#include <common/algorithms/basis_inverse.h>
#include <common/nodes/dense_kernels.h>

#include <Eigen/Core>

namespace Friction
{
  namespace
  {
    // Squares on the diagonal of Cholesky's factor, as parts of what was there,
    // that betray a singular matrix.
    constexpr double singular = 1e-13;
  } // namespace



  bool
  BasisInverse::factorize(const std::vector<double> &S,
                          const std::vector<char>   &is_unit)
  {
    matrix = &S;
    columns.clear();
    units.clear();
    changes.clear();
    const std::size_t n = is_unit.size();
    for (unsigned int k = 0; k < n; ++k)
      (is_unit[k] ? units : columns).push_back(k);
    const std::size_t m = columns.size();
    factor.resize(m * m);
    for (std::size_t j = 0; j < m; ++j)
      for (std::size_t i = 0; i < m; ++i)
        factor[j * m + i] = S[columns[j] * n + columns[i]];
    n_products += m * m * m / 6.;
    const Eigen::Map<const Eigen::MatrixXd> L(factor.data(), m, m);
    const Eigen::VectorXd                   diagonal = L.diagonal();
    return m == 0 ||
      (DenseKernels::eliminate(factor.data(), m, m) &&
       (L.diagonal().array().square() > singular * diagonal.array()).all());
  }



  void
  BasisInverse::apply(std::vector<double> &x) const
  {
    const std::size_t n = x.size(), m = columns.size();
    Eigen::VectorXd   y(m);
    for (std::size_t k = 0; k < m; ++k)
      y(k) = x[columns[k]];
    const Eigen::Map<const Eigen::MatrixXd> L(factor.data(), m, m);
    L.triangularView<Eigen::Lower>().solveInPlace(y);
    L.transpose().triangularView<Eigen::Upper>().solveInPlace(y);
    for (std::size_t k = 0; k < m; ++k)
      {
        const double *const S     = &(*matrix)[columns[k] * n];
        const double        value = y(k);
        for (const unsigned int i : units)
          x[i] -= S[i] * value;
        x[columns[k]] = value;
      }
    n_products += m * n;

    for (const Change &change : changes)
      {
        if (change.image.empty())
          {
            x[change.position] += change.factor * x[change.from];
            continue;
          }
        const double value = x[change.position] / change.factor;
        if (value == 0)
          continue;
        for (std::size_t i = 0; i < n; ++i)
          x[i] -= change.image[i] * value;
        x[change.position] = value;
        n_products += n;
      }
  }



  void
  BasisInverse::exchange(const unsigned int         position,
                         const std::vector<double> &image)
  {
    changes.push_back({position, position, image[position], image});
  }



  void
  BasisInverse::add_row(const unsigned int to,
                        const unsigned int from,
                        const double       factor)
  {
    changes.push_back({to, from, factor, {}});
  }



  std::size_t
  BasisInverse::memory_consumption() const
  {
    std::size_t bytes =
      factor.capacity() * sizeof(double) + changes.capacity() * sizeof(Change);
    for (const Change &change : changes)
      bytes += change.image.capacity() * sizeof(double);
    return bytes;
  }
} // namespace Friction

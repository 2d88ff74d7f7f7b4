#include <common/contact/local_problem.h>

#include <cmath>

namespace Friction
{
  namespace
  {
    // The minimiser of  a z^2 / 2 - b z + s |z|.
    inline double
    shrink(const double a, const double b, const double s)
    {
      if (std::abs(b) <= s)
        return 0.;
      return (b > 0 ? b - s : b + s) / a;
    }
  } // namespace



  template <>
  LocalProblem<2>::LocalProblem(const std::array<double, 4> &block,
                                const double                 gap,
                                const unsigned int           n_free_tangents)
    : a(block)
    , gap(gap)
    , n_free_tangents(n_free_tangents)
  {}



  template <>
  LocalSolution<2>
  LocalProblem<2>::solve(const std::array<double, 2> &b,
                         const double                 bound,
                         const std::array<double, 1> &prescribed) const
  {
    const double a_nn = a[0], a_tn = a[1], a_tt = a[3];

    LocalSolution<2> z;

    // Without the obstacle.
    z.tangential[0] = n_free_tangents == 0
      ? prescribed[0]
      : shrink(a_tt - a_tn * a_tn / a_nn, b[1] - a_tn * b[0] / a_nn, bound);
    z.normal        = (b[0] - a_tn * z.tangential[0]) / a_nn;
    z.in_contact    = !(z.normal < gap);

    // With it.
    if (z.in_contact)
      {
        z.normal = gap;
        if (n_free_tangents > 0)
          z.tangential[0] = shrink(a_tt, b[1] - a_tn * gap, bound);
      }

    z.sticks = n_free_tangents > 0 && bound > 0 && z.tangential[0] == 0.;
    return z;
  }
} // namespace Friction

#include <common/contact/slip_problem.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Friction
{
  namespace
  {
    // The minimiser of  a z^2 / 2 - b z + kappa |z|.
    inline double
    shrink(const double a, const double b, const double kappa)
    {
      if (std::abs(b) <= kappa)
        return 0.;
      return (b > 0 ? b - kappa : b + kappa) / a;
    }



    // |b|^2 - kappa^2, where b is close to the edge of the cone of friction the
    // difference of large numbers: the products have to be exact. So are the
    // sums where it matters.
    inline double
    square_difference(const std::array<double, 2> &b, const double kappa)
    {
      const double large = std::max(std::abs(b[0]), std::abs(b[1])),
                   small = std::min(std::abs(b[0]), std::abs(b[1]));
      const double l2 = large * large, k2 = kappa * kappa, m2 = small * small;
      return ((l2 - k2) + m2) +
        ((std::fma(large, large, -l2) + std::fma(small, small, -m2)) -
         std::fma(kappa, kappa, -k2));
    }



    struct Direction
    {
      double cosine, sine;
    };



    // k t + d t/sqrt(1+t^2) = r,   k, d, r >= 0. What r-d is may be known
    // better than as a difference.
    struct EquationForSlip
    {
      double k, d, r, r_minus_d;
    };



    // The direction (1,t)/sqrt(1+t^2), t >= 0, where t solves the equation, to
    // rounding of its coefficients. Where t > 1, the equation times c = 1/t is
    //
    //   (r-d) c + d (c - c/sqrt(1+c^2)) = k,
    //
    // all of whose terms can be computed without cancellation. Either way the
    // unknown lies in [0,1], and Halley's iteration, the one of third order, is
    // enclosed by a bracket.
    //
    // It begins at a guess of t if that turns out to be a good one. Towards the
    // end of a solution nearly all are, and one or two steps are enough.
    Direction
    find_direction(const EquationForSlip &equation,
                   const double           guess,
                   unsigned int          *n_iterations)
    {
      constexpr double       sqrt_half     = 0.70710678118654752;
      constexpr unsigned int maximum_steps = 100;

      // The error after a step of this relative size is the cube of it.
      constexpr double tolerance = 4e-6;

      // A guess from which the first step is no larger.
      constexpr double good = .1;

      const double k = equation.k, d = equation.d, r = equation.r,
                   r_minus_d = equation.r_minus_d;
      const bool flat        = (k + sqrt_half * d >= r); // t <= 1

      // A step from x, and with its left side minus its right one.
      double     f;
      const auto step_from = [&](const double x) {
        const double u2 = 1. / (1. + x * x), u = std::sqrt(u2);
        double       f_1, f_2;
        if (flat)
          {
            f   = x * (k + d * u) - r;
            f_1 = k + d * u * u2;
            f_2 = -3. * d * x * u * u2 * u2;
          }
        else
          {
            const double one_minus_u = x * x * u2 / (1. + u);
            f                        = x * (r_minus_d + d * one_minus_u) - k;
            f_1 = r_minus_d + d * one_minus_u * (1. + u + u2);
            f_2 = 3. * d * x * u * u2 * u2;
          }
        return x - f * f_1 / (f_1 * f_1 - .5 * f * f_2);
      };

      // A bound of t from below: the left side is concave, and below its
      // tangent in zero. Of c = 1/t: with u = 1/sqrt(1+c^2), the second term is
      // d c (1-u), and 1-u <= c^2/2.
      double lower = flat ? std::min(1., r / (k + d))
        : r_minus_d < 0.  ? std::min(1., std::sqrt(-2. * r_minus_d / d))
                          : 0.;
      double upper = 1.;

      // Far below the bound the iteration may come to rest where there is no
      // solution: for r < d the left side decreases at first.
      unsigned int n    = 0;
      bool         done = false;
      double       x    = (flat || guess == 0.) ? guess : 1. / guess;
      if (x > 0. && x <= 1. && x >= .9 * lower)
        {
          const double next   = step_from(x);
          const double change = std::abs(next - x) / x;
          n                   = 1;
          done                = change <= tolerance;
          // Not a good one, or not a number.
          x = change <= good ? std::min(next, 1.) : 0.;
        }
      else
        x = 0.;
      if (x == 0.)
        {
          if (flat)
            x = lower;
          else
            {
              // Also 1-u >= gamma c^2. Therefore c is below the root of
              // (r-d) c + gamma d c^3 = k, and that is below
              const double gamma_d = (1. - sqrt_half) * d;
              const double cubic   = std::cbrt(k / gamma_d);
              x                    = r_minus_d > 0
                                   ? std::min(k / r_minus_d, cubic) // d may be zero
                                   : std::sqrt(cubic * cubic - r_minus_d / gamma_d);
              x                    = std::min(x, 1.);
            }
        }

      while (!done && n < maximum_steps)
        {
          ++n;
          double next             = step_from(x);
          (f < 0 ? lower : upper) = x;
          if (!(next >= lower && next <= upper))
            next = .5 * (lower + upper);
          const double change = std::abs(next - x);
          x                   = next;
          done                = change <= tolerance * x;
        }
      if (n_iterations != nullptr)
        *n_iterations = n;

      const double u = 1. / std::sqrt(1. + x * x);
      return flat ? Direction{u, x * u} : Direction{x * u, u};
    }
  } // namespace



  SlipProblem<1>::SlipProblem(const std::array<double, 1> &block,
                              const unsigned int           n_free_components,
                              const LocalSolver)
    : a(block[0])
    , n_free_components(n_free_components)
  {}



  std::array<double, 1>
  SlipProblem<1>::solve(const std::array<double, 1> &b,
                        const double                 kappa,
                        const std::array<double, 1> &before) const
  {
    return n_free_components == 0
      ? before
      : std::array<double, 1>{{shrink(a, b[0], kappa)}};
  }



  SlipProblem<2>::SlipProblem(const std::array<double, 4> &block,
                              const unsigned int           n_free_components,
                              const LocalSolver            solver)
    : a_11(block[0])
    , a_12(block[1])
    , n_free_components(n_free_components)
    , solver(solver)
  {
    // A Jacobi rotation by at most 45 degrees from the axis of the larger
    // diagonal entry.
    const double a_22 = block[3];
    const double half = .5 * std::abs(a_11 - a_22),
                 root = std::hypot(half, a_12);
    const double t    = root > 0 ? a_12 / (half + root) : 0.;
    const double c    = 1. / std::sqrt(1. + t * t);
    axis_c            = a_11 >= a_22 ? c : t * c;
    axis_s            = a_11 >= a_22 ? t * c : c;
    a_1               = std::max(a_11, a_22) + t * a_12;
    difference        = 2. * root;

    // The small eigenvalue from the determinant, the difference of products
    // that have to be exact. If it is lost in the rounding of the entries, any
    // value of that size will do.
    const double product = a_12 * a_12;
    const double determinant =
      std::fma(a_11, a_22, -product) - std::fma(a_12, a_12, -product);
    a_2 = determinant > 0 ? determinant / a_1
                          : std::numeric_limits<double>::epsilon() * a_1;
  }



  inline std::array<double, 2>
  SlipProblem<2>::to_eigenbasis(const std::array<double, 2> &z) const
  {
    return {{axis_c * z[0] + axis_s * z[1], -axis_s * z[0] + axis_c * z[1]}};
  }



  inline std::array<double, 2>
  SlipProblem<2>::from_eigenbasis(const double z_1, const double z_2) const
  {
    return {{axis_c * z_1 - axis_s * z_2, axis_s * z_1 + axis_c * z_2}};
  }



  // The positive root ell of  2 kappa ell e^T a e + ell^2 |a e|^2 = excess,
  // where the excess is |b|^2 - kappa^2.
  inline double
  SlipProblem<2>::amount_of_slip(const double e_1,
                                 const double e_2,
                                 const double kappa,
                                 const double excess) const
  {
    const double ae_1 = a_1 * e_1, ae_2 = a_2 * e_2;
    const double kappa_eae = kappa * (e_1 * ae_1 + e_2 * ae_2);
    return excess /
      (kappa_eae +
       std::sqrt(kappa_eae * kappa_eae + excess * (ae_1 * ae_1 + ae_2 * ae_2)));
  }



  std::array<double, 2>
  SlipProblem<2>::solve(const std::array<double, 2> &b,
                        const double                 kappa,
                        const std::array<double, 2> &before) const
  {
    if (n_free_components == 2)
      return solver == LocalSolver::uzawa
        ? solve_uzawa(b, kappa)
        : solve_secular_equation(b, kappa, before);
    if (n_free_components == 0)
      return before;

    // One component is left. That the other one is prescribed to be no more
    // than the smallest of numbers makes no difference.
    const double w = before[1], force = b[0] - a_12 * w, k = a_11 * std::abs(w);
    if (k < std::numeric_limits<double>::min() || kappa == 0.)
      return {{shrink(a_11, force, kappa), w}};
    const double    r = std::abs(force);
    const Direction slip =
      find_direction({k, kappa, r, r - kappa}, 0., nullptr);
    const double magnitude = std::abs(w) * (slip.sine / slip.cosine);
    return {{std::copysign(magnitude, force), w}};
  }



  std::array<double, 2>
  SlipProblem<2>::solve_secular_equation(const std::array<double, 2> &b,
                                         const double                 kappa,
                                         const std::array<double, 2> &before,
                                         unsigned int *n_iterations) const
  {
    if (n_iterations != nullptr)
      *n_iterations = 0;
    const std::array<double, 2> force = to_eigenbasis(b);
    if (kappa == 0.)
      return from_eigenbasis(force[0] / a_1, force[1] / a_2);

    const double excess = square_difference(b, kappa);
    if (excess <= 0.)
      return {{0., 0.}};

    // Close to the edge of the cone, how much b_2 differs from kappa is taken
    // from the excess, since the rotation is subject to rounding.
    const double b_1 = std::abs(force[0]), b_2 = std::abs(force[1]);
    const double b_2_minus_kappa = excess < kappa * kappa
      ? (excess - b_1 * b_1) / (b_2 + kappa)
      : b_2 - kappa;
    // Nothing can be guessed from a node at rest, or that has moved along an
    // axis.
    const std::array<double, 2> slip = to_eigenbasis(before);
    const Direction             e =
      find_direction({a_2 * b_1,
                      difference * kappa,
                      a_1 * b_2,
                      a_1 * b_2_minus_kappa + a_2 * kappa},
                     slip[0] != 0. ? std::abs(slip[1] / slip[0]) : 0.,
                     n_iterations);
    const double ell = amount_of_slip(e.cosine, e.sine, kappa, excess);
    return from_eigenbasis(std::copysign(ell * e.cosine, force[0]),
                           std::copysign(ell * e.sine, force[1]));
  }



  std::array<double, 2>
  SlipProblem<2>::solve_uzawa(const std::array<double, 2> &b,
                              const double                 kappa,
                              unsigned int                *n_iterations) const
  {
    if (n_iterations != nullptr)
      *n_iterations = 0;
    const double excess = square_difference(b, kappa);
    if (kappa == 0. || excess <= 0.)
      return solve_secular_equation(b, kappa);

    const std::array<double, 2> force = to_eigenbasis(b);
    const double                scale = std::hypot(b[0], b[1]);
    const double step  = 2. * a_1 * (a_2 / (a_1 + a_2)) / kappa; // rho kappa
    double       eta_1 = force[0] / scale, eta_2 = force[1] / scale;
    for (unsigned int n = 1; n <= maximum_uzawa_steps; ++n)
      {
        eta_1 += step * (force[0] - kappa * eta_1) / a_1;
        eta_2 += step * (force[1] - kappa * eta_2) / a_2;
        const double modulus = std::hypot(eta_1, eta_2);
        if (modulus > 1.)
          {
            eta_1 /= modulus;
            eta_2 /= modulus;
          }
        if (n_iterations != nullptr)
          *n_iterations = n;

        // If the slip is tiny, b - kappa eta has lost its digits, and so has z.
        // The direction is that of eta, and its amount is found from that.
        const double e_1 = eta_1 / std::min(modulus, 1.),
                     e_2 = eta_2 / std::min(modulus, 1.);
        const double ell = amount_of_slip(e_1, e_2, kappa, excess);
        if (std::hypot(force[0] - (kappa + ell * a_1) * e_1,
                       force[1] - (kappa + ell * a_2) * e_2) <=
            uzawa_tolerance * scale)
          return from_eigenbasis(ell * e_1, ell * e_2);
      }

    unsigned int                n_more;
    const std::array<double, 2> z =
      solve_secular_equation(b, kappa, {{}}, &n_more);
    if (n_iterations != nullptr)
      *n_iterations = maximum_uzawa_steps + n_more;
    return z;
  }
} // namespace Friction

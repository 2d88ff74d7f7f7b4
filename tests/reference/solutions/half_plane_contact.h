#ifndef tests_reference_solutions_half_plane_contact_h
#define tests_reference_solutions_half_plane_contact_h

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace Reference
{
  /**
   * A long elastic cylinder (plane strain) pressed on a rigid flat obstacle
   * with the whole load in one step: Hertz's problem with the static law of
   * Coulomb friction, for a contact that is small beside the radius.
   *
   * <h4>The law</h4>
   *
   * In contact the normal displacement equals the gap. In the stick zone
   * |x| < c the *total* tangential displacement vanishes (its free constant is
   * zero by symmetry), which for the half-plane says du_T/dx = 0. In
   * c < |x| < a the body has slipped inwards, and the obstacle drags it
   * outwards with q = F p sgn(x). Spence (1973, 1975) treats progressive
   * loading, where a point keeps the displacement that it had on entering the
   * stick zone; his stick zone is a different one.
   *
   * u_T and u_n are taken in the frame of the *body*: along its arc and its
   * normal, as the project's scene has it by default. It is this frame for
   * which a half-plane stands in: pressure acts along the body's normal, shear
   * along its arc. (A contact turns the arc flat, and the tractions with it, so
   * that this is also what a theory of large rotations reduces to.) In the
   * frame of the obstacle a pressure along the vertical has a component +p x/R
   * along the arc, outwards like the friction: in effect F becomes F + |x|/R.
   * This is nothing as long as a/R << F, the limit computed here, in which the
   * frames agree; but it more than doubles the friction at the edge when a/R =
   * 0.06 and F = 0.05, and so enlarges a stick zone that is exponentially small
   * in beta/F. All else that the half-plane neglects is of relative order a/R.
   *
   * <h4>Equations</h4>
   *
   * Surface gradients of the half-plane (Johnson, Contact Mechanics, 1985,
   * (2.25); they follow from Flamant's solution), in units with
   * 2(1-nu^2)/E = 1, R = 1 and a = 1:
   *   u_x' = -beta p(x) - 1/pi PV int q(s)/(x-s) ds
   *   u_z' = -1/pi PV int p(s)/(x-s) ds + beta q(x)
   * with Dundurs' constant for a rigid partner, beta = (1-2nu)/(2(1-nu)), and
   * u_z' = -x in contact. Without friction p = sqrt(1-x^2).
   *
   * <h4>Discretisation</h4>
   *
   * Piecewise linear p (even) and q (odd) on a mesh graded towards 0 < c < a,
   * the equations collocated at the midpoints of the elements. The stick ratio
   * k = c/a is given and F an unknown: continuity of q at c supplies exactly
   * the missing equation. An outer secant iteration then finds k for given F.
   */
  class HalfPlaneContact
  {
  public:
    /**
     * Whether the shear traction acts back on the pressure. `uncoupled`
     * neglects it (Goodman's approximation), for which the stick ratio is known
     * in closed form.
     */
    enum class Coupling
    {
      full,
      uncoupled
    };

    /**
     * Solve for given nu and F > 0. `n` is the number of elements in the half
     * width; four fifths of them are in the slip zone.
     */
    HalfPlaneContact(const double       poisson_ratio,
                     const double       friction_coefficient,
                     const unsigned int n        = 200,
                     const Coupling     coupling = Coupling::full)
      : beta((1. - 2. * poisson_ratio) / (2. * (1. - poisson_ratio)))
      , coupling(coupling)
    {
      if (friction_coefficient == 0.)
        {
          solve_frictionless(n);
          return;
        }
      if (!(friction_coefficient > 0.))
        throw std::runtime_error("Reference: F is negative.");

      // Secant iteration in logit(k) over log(F), from the closed form.
      const double k_0   = closed_form_stick_ratio(friction_coefficient, beta);
      double       y_old = std::log(k_0 / (1. - k_0)), y = y_old + 0.05;
      double       r_old =
        std::log(friction_of_stick_ratio(k_0, n) / friction_coefficient);
      for (unsigned int step = 0; step < 50; ++step)
        {
          k = 1. / (1. + std::exp(-y));
          const double r =
            std::log(friction_of_stick_ratio(k, n) / friction_coefficient);
          if (std::abs(r) < 1e-11)
            {
              finish();
              return;
            }
          const double y_new = y - r * (y - y_old) / (r - r_old);
          y_old              = y;
          r_old              = r;
          y                  = std::clamp(y_new, y - 2., y + 2.);
        }
      throw std::runtime_error("Reference: the stick ratio was not found.");
    }

    /// c/a
    double
    stick_ratio() const
    {
      return k;
    }

    /// a/a_H, where a_H = sqrt(4 N R (1-nu^2)/(pi E)) for the same load N
    double
    half_width_factor() const
    {
      return 1. / hertz_half_width;
    }

    /// p(0)/p_H, where p_H = 2N/(pi a_H) for the same load N
    double
    peak_pressure_factor() const
    {
      return p[0] / hertz_half_width;
    }

    /// p(x/a)/p_H at a relative position in [-1,1]
    double
    pressure(const double relative_x) const
    {
      return interpolate(p, std::abs(relative_x)) / hertz_half_width;
    }

    /// q(x/a)/p_H, the traction on the body along the tangent
    double
    shear(const double relative_x) const
    {
      return std::copysign(interpolate(q, std::abs(relative_x)), relative_x) /
        hertz_half_width;
    }

    /// F that was solved for, as the discrete solution has it.
    double
    friction_coefficient() const
    {
      return F;
    }

    /// Hertz's half-width for load per length N.
    static double
    hertz_width(const double N, const double R, const double E, const double nu)
    {
      return std::sqrt(4. * N * R * (1. - nu * nu) / (M_PI * E));
    }

    /// Hertz's peak pressure for load per length N.
    static double
    hertz_pressure(const double N,
                   const double R,
                   const double E,
                   const double nu)
    {
      return 2. * N / (M_PI * hertz_width(N, R, E, nu));
    }

    /**
     * The uncoupled stick ratio, the root of
     * F/beta = E(k) / (K(k') - E(k')), k'^2 = 1 - k^2.
     */
    static double
    closed_form_stick_ratio(const double F, const double beta)
    {
      double low = -40., high = 40.; // of logit(k)
      for (unsigned int step = 0; step < 200; ++step)
        {
          const double y       = 0.5 * (low + high);
          const double k       = 1. / (1. + std::exp(-y)),
                       l       = 1. / (1. + std::exp(y));
          const double k_prime = std::sqrt(l * (1. + k));
          const double ratio   = k < 1e-8 ? 0.5 * M_PI / (std::log(4. / k) - 1.)
                                          : std::comp_ellint_2(k) /
              (std::comp_ellint_1(k_prime) - std::comp_ellint_2(k_prime));
          (ratio < F / beta ? low : high) = y;
        }
      return 1. / (1. + std::exp(-low));
    }

    /**
     * The largest violation of what the solution did not impose, relative to
     * the peak pressure or to the slope at the edge: p >= 0, |q| <= F p in the
     * stick zone, slip inwards in the slip zone, and no penetration outside.
     * Zero for an admissible solution.
     */
    double
    inadmissibility() const
    {
      double             violation = 0.;
      const unsigned int n         = x.size() - 1;
      for (unsigned int j = 0; j <= n; ++j)
        {
          violation = std::max(violation, -p[j] / p[0]);
          if (x[j] < k)
            violation = std::max(violation, (std::abs(q[j]) - F * p[j]) / p[0]);
        }
      // u_x' < 0 all through the slip zone is more than is needed, u_x < 0.
      double u_x = 0.;
      for (unsigned int i = 0; i < n; ++i)
        if (x[i] >= k && F > 0.)
          {
            const double y = 0.5 * (x[i] + x[i + 1]);
            u_x += (x[i + 1] - x[i]) *
              (-beta * 0.5 * (p[i] + p[i + 1]) - cauchy_row(y, -1.).dot(q));
            violation = std::max(violation, u_x / beta);
          }
      for (double y = 1.001; y < 4.; y *= 1.01)
        violation = std::max(violation, -(y - cauchy_row(y, 1.).dot(p)));
      return violation;
    }

  private:
    /**
     * 1/pi PV int f(s)/(y-s) ds over [-1,1], as a row over the nodal values of
     * f on [0,1], f being extended evenly (parity 1) or oddly (-1).
     */
    Eigen::VectorXd
    cauchy_row(const double y, const double parity) const
    {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(x.size());
      for (unsigned int j = 0; j + 1 < x.size(); ++j)
        {
          const double a = x[j], b = x[j + 1], h = b - a;
          // int 1/(y-s) and int (s-a)/h / (y-s) over [a,b], then over its
          // mirror image.
          const double l0 = std::log(std::abs((y - a) / (y - b))),
                       l1 = ((y - a) * l0 - h) / h;
          const double m0 = std::log1p(h / (y + a)),
                       m1 = (h - (y + a) * m0) / h;
          row[j] += l0 - l1 + parity * (m0 - m1);
          row[j + 1] += l1 + parity * m1;
        }
      return row / M_PI;
    }

    /**
     * A mesh whose elements shrink quadratically towards c on both sides and
     * towards a, where p and q behave like (fractional) powers of the distance;
     * in the slip zone it is geometric in between, since c may be tiny.
     */
    void
    make_mesh(const double c, const unsigned int n)
    {
      n_stick = std::max(4u, n / 5);
      x.clear();
      for (unsigned int i = 0; i < n_stick; ++i)
        x.push_back(c * std::sin(0.5 * M_PI * i / n_stick));
      const unsigned int n_slip = n - n_stick;
      for (unsigned int i = 0; i <= n_slip; ++i)
        x.push_back(
          std::exp(0.5 * std::log(c) * (1. + std::cos(M_PI * i / n_slip))));
      x[n_stick] = c;
      x.back()   = 1.;
    }

    /**
     * Solve for given c = k (and a = 1): Newton's method for p, q and F.
     */
    double
    friction_of_stick_ratio(const double c, const unsigned int n)
    {
      make_mesh(c, n);
      const unsigned int m = n_stick;

      Eigen::MatrixXd C_p(n, n + 1), C_q(n, n + 1);
      for (unsigned int i = 0; i < n; ++i)
        {
          const double y = 0.5 * (x[i] + x[i + 1]);
          C_p.row(i)     = cauchy_row(y, 1.).transpose();
          C_q.row(i)     = cauchy_row(y, -1.).transpose();
        }

      // The solution for another c, if there is one, is a good start.
      if (p.size() != static_cast<Eigen::Index>(n + 1))
        {
          p = Eigen::VectorXd(n + 1);
          q = Eigen::VectorXd::Zero(n + 1);
          for (unsigned int j = 0; j <= n; ++j)
            p[j] = std::sqrt(1. - x[j] * x[j]);
          F = 0.5 * beta;
        }

      // Unknowns p_0..p_{n-1} (p_n = 0), q_1..q_{m-1} (q_0 = 0), F; from m on
      // q = F p.
      const double    back = coupling == Coupling::full ? beta : 0.;
      Eigen::VectorXd residual(n + m);
      Eigen::MatrixXd jacobian(n + m, n + m);
      for (unsigned int step = 0; step < 40; ++step)
        {
          for (unsigned int j = m; j <= n; ++j)
            q[j] = F * p[j];
          jacobian.setZero();
          for (unsigned int i = 0; i < n + m; ++i)
            {
              // Rows: the n normal equations, then the m tangential ones.
              const bool         normal = i < n;
              const unsigned int e      = normal ? i : i - n;
              Eigen::RowVectorXd by_p, by_q;
              Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(n + 1);
              mean[e] = mean[e + 1] = 0.5;
              if (normal)
                {
                  by_p = C_p.row(e);
                  by_q = -back * mean;
                }
              else
                {
                  by_p = beta * mean;
                  by_q = C_q.row(e);
                }
              residual[i] = by_p.dot(p) + by_q.dot(q) -
                (normal ? 0.5 * (x[e] + x[e + 1]) : 0.);
              for (unsigned int j = 0; j < n; ++j)
                jacobian(i, j) = by_p[j] + (j >= m ? F * by_q[j] : 0.);
              for (unsigned int j = 1; j < m; ++j)
                jacobian(i, n + j - 1) = by_q[j];
              jacobian(i, n + m - 1) =
                by_q.segment(m, n + 1 - m).dot(p.segment(m, n + 1 - m));
            }
          const Eigen::VectorXd change =
            jacobian.partialPivLu().solve(residual);
          p.head(n) -= change.head(n);
          q.segment(1, m - 1) -= change.segment(n, m - 1);
          F -= change[n + m - 1];
          if (change.cwiseAbs().maxCoeff() < 1e-12)
            {
              for (unsigned int j = m; j <= n; ++j)
                q[j] = F * p[j];
              return F;
            }
        }
      throw std::runtime_error("Reference: Newton's method for the half-plane "
                               "did not converge.");
    }

    /// F = 0 has no stick zone: the normal equations alone.
    void
    solve_frictionless(const unsigned int n)
    {
      x.clear();
      for (unsigned int i = 0; i <= n; ++i)
        x.push_back(std::sin(0.5 * M_PI * i / n));
      x.back() = 1.;
      Eigen::MatrixXd matrix(n, n);
      Eigen::VectorXd right(n);
      for (unsigned int i = 0; i < n; ++i)
        {
          right[i]      = 0.5 * (x[i] + x[i + 1]);
          matrix.row(i) = cauchy_row(right[i], 1.).head(n).transpose();
        }
      p         = Eigen::VectorXd::Zero(n + 1);
      p.head(n) = matrix.partialPivLu().solve(right);
      q         = Eigen::VectorXd::Zero(n + 1);
      F = k = 0.;
      finish();
    }

    void
    finish()
    {
      double N = 0.;
      for (unsigned int j = 0; j + 1 < x.size(); ++j)
        N += (x[j + 1] - x[j]) * (p[j] + p[j + 1]);
      // In the units of this class Hertz has N = pi/2 a^2 and p(0) = a.
      hertz_half_width = std::sqrt(2. * N / M_PI);
    }

    double
    interpolate(const Eigen::VectorXd &values, const double y) const
    {
      if (y >= 1.)
        return 0.;
      const unsigned int j =
        std::upper_bound(x.begin(), x.end(), y) - x.begin() - 1;
      const double t = (y - x[j]) / (x[j + 1] - x[j]);
      return (1. - t) * values[j] + t * values[j + 1];
    }

    const double   beta;
    const Coupling coupling;

    std::vector<double> x; ///< nodes in [0,1]
    unsigned int        n_stick = 0;
    Eigen::VectorXd     p, q;
    double              F = 0., k = 0., hertz_half_width = 1.;
  };

  /**
   * What a test compares with: stick ratio c/a, a/a_H and p(0)/p_H.
   */
  struct HertzFactors
  {
    double stick_ratio;
    double half_width;
    double peak_pressure;
  };

  /**
   * The factors, extrapolated from n and 2n elements: the discretisation is of
   * second order on its graded meshes. With n = 100 good to 1e-5 for F <= 1.
   *
   * For small F the pressure has a narrow peak in the centre, of the width of
   * the stick zone, which a computation must resolve if it is to see it.
   */
  inline HertzFactors
  hertz_factors(const double       poisson_ratio,
                const double       friction_coefficient,
                const unsigned int n = 100)
  {
    const HalfPlaneContact coarse(poisson_ratio, friction_coefficient, n),
      fine(poisson_ratio, friction_coefficient, 2 * n);
    const auto extrapolate = [](const double from_coarse,
                                const double from_fine) {
      return from_fine + (from_fine - from_coarse) / 3.;
    };
    return {
      extrapolate(coarse.stick_ratio(), fine.stick_ratio()),
      extrapolate(coarse.half_width_factor(), fine.half_width_factor()),
      extrapolate(coarse.peak_pressure_factor(), fine.peak_pressure_factor())};
  }
} // namespace Reference

#endif

// The half-plane solution of static Hertz contact with friction: its limits,
// its order of convergence, the closed form of the uncoupled problem, and that
// it satisfies the inequalities which it did not impose.

#include <cstdio>

#include <tests/reference/solutions/half_plane_contact.h>

#include <tests/support/test.h>

using namespace Reference;

TEST(half_plane_contact)
{
  {
    const HertzFactors frictionless = hertz_factors(0.3, 0.);
    std::printf("frictionless: a/a_H = %.5f, p0/p_H = %.5f\n",
                frictionless.half_width,
                frictionless.peak_pressure);
    const HalfPlaneContact hertz(0.3, 0., 200);
    double                 error = 0.;
    for (double x = -0.95; x < 1.; x += 0.1)
      error =
        std::max(error, std::abs(hertz.pressure(x) - std::sqrt(1. - x * x)));
    std::printf("  ellipse of Hertz within 1e-4: %s\n",
                error < 1e-4 ? "yes" : "no");
  }

  // The coupling vanishes with beta for an incompressible body.
  std::printf("nu = 0.48, F = 0.4: a/a_H = %.3f, p0/p_H = %.3f\n",
              hertz_factors(0.48, 0.4).half_width,
              hertz_factors(0.48, 0.4).peak_pressure);

  for (const auto &[nu, F] : {std::pair<double, double>{0.3, 0.4},
                              {0.325, 0.4},
                              {0.3, 1.},
                              {0.325, 0.05}})
    {
      const double beta  = (1. - 2. * nu) / (2. * (1. - nu));
      const double exact = HalfPlaneContact::closed_form_stick_ratio(F, beta);
      double       error[2];
      for (unsigned int i = 0; i < 2; ++i)
        error[i] = std::abs(
          HalfPlaneContact(
            nu, F, i == 0 ? 50 : 100, HalfPlaneContact::Coupling::uncoupled)
            .stick_ratio() -
          exact);
      // Tiny stick zones are resolved so well that no order shows.
      std::printf(
        "uncoupled nu = %.3f, F = %.2f: c/a = %.6f, second order or "
        "better than 1e-4: %s\n",
        nu,
        F,
        exact,
        (error[1] < 1e-3 * exact && std::log2(error[0] / error[1]) > 1.9) ||
            error[1] < 1e-4 * exact
          ? "yes"
          : "no");
    }

  for (const auto &[nu, F] : {std::pair<double, double>{0.3, 0.4},
                              {0.3, 1.},
                              {0.325, 0.05},
                              {0.325, 0.4},
                              {0.325, 1.}})
    {
      const HertzFactors factors = hertz_factors(nu, F);
      std::printf(
        "coupled nu = %.3f, F = %.2f: c/a = %.6f, a/a_H = %.5f, "
        "p0/p_H = %.5f, admissible: %s\n",
        nu,
        F,
        factors.stick_ratio,
        factors.half_width,
        factors.peak_pressure,
        HalfPlaneContact(nu, F, 100).inadmissibility() < 1e-10 ? "yes" : "no");
    }
}

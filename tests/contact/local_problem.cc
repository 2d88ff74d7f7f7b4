// The local problem of a contact node,
//
//   minimise  1/2 z^T a z - b^T z + s |z_T|   over  z_n <= g,
//
// is strictly convex, so that its solution is characterised by an inclusion:
// with the force r = b - a z that remains at the node,
//
//   r_n >= 0,  z_n <= g,  r_n (g - z_n) = 0,
//   |r_T| <= s,  and  r_T = s z_T/|z_T|  where z_T is not zero.
//
// Checked for random blocks with condition numbers up to 1e12, to rounding of
// the terms that r is a sum of: nothing better can be asked, and nothing worse
// is given away. For blocks that are well conditioned the solution itself is
// compared with that of an enumeration of all six cases.

#include <common/contact/local_problem.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>

#include <tests/support/check.h>
#include <tests/support/random.h>
#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;
using namespace Tests;

namespace test_local_problem
{
  constexpr double infinity = std::numeric_limits<double>::infinity();

  struct Data
  {
    std::array<double, 4> a;
    std::array<double, 2> b;
    double                gap, bound;

    double
    energy(const double n, const double t) const
    {
      return .5 * (a[0] * n * n + 2 * a[1] * n * t + a[3] * t * t) - b[0] * n -
        b[1] * t + bound * std::abs(t);
    }

    // The largest of the terms that the remaining forces are sums of.
    double
    scale(const LocalSolution<2> &z) const
    {
      const double n = std::abs(z.normal), t = std::abs(z.tangential[0]);
      return std::max(std::abs(b[0]) + std::abs(a[0]) * n + std::abs(a[1]) * t,
                      std::abs(b[1]) + std::abs(a[1]) * n + std::abs(a[3]) * t +
                        bound);
    }
  };



  // By how much the inclusion is violated, relative to rounding. A tangential
  // displacement that is prescribed asks nothing of the tangential force.
  double
  violation(const Data             &data,
            const LocalSolution<2> &z,
            const bool              tangent_is_free)
  {
    const double r_n =
      data.b[0] - data.a[0] * z.normal - data.a[1] * z.tangential[0];
    const double r_t =
      data.b[1] - data.a[1] * z.normal - data.a[3] * z.tangential[0];
    const double scale = data.scale(z);

    double result = std::max(0., -r_n / scale);
    if (z.normal > data.gap)
      return infinity;
    if (z.in_contact != (z.normal == data.gap) && z.in_contact)
      return infinity;
    if (!z.in_contact)
      result = std::max(result, std::abs(r_n) / scale);
    if (tangent_is_free)
      {
        result = std::max(result, (std::abs(r_t) - data.bound) / scale);
        if (z.tangential[0] != 0)
          result = std::max(
            result,
            std::abs(r_t - std::copysign(data.bound, z.tangential[0])) / scale);
        if (z.sticks != (data.bound > 0 && z.tangential[0] == 0.))
          return infinity;
      }
    return result;
  }



  // The minimiser by enumeration: open or in contact, slipping to one side or
  // the other or not at all. Each case is a smooth problem; the minimum is the
  // case of least energy among those that are admissible.
  std::array<double, 2>
  enumerate(const Data &d)
  {
    std::array<double, 2> best{};
    double                least = infinity;
    const double          det   = d.a[0] * d.a[3] - d.a[1] * d.a[1];
    const auto            offer = [&](const double n, const double t) {
      if (n <= d.gap && d.energy(n, t) < least)
        {
          least = d.energy(n, t);
          best  = {{n, t}};
        }
    };
    for (const double sign : {-1., 1.})
      {
        const double b_t = d.b[1] - sign * d.bound;
        const double n   = (d.a[3] * d.b[0] - d.a[1] * b_t) / det;
        const double t   = (d.a[0] * b_t - d.a[1] * d.b[0]) / det;
        if (sign * t >= 0)
          offer(n, t);
        const double t_contact = (b_t - d.a[1] * d.gap) / d.a[3];
        if (sign * t_contact >= 0)
          offer(d.gap, t_contact);
      }
    offer(d.b[0] / d.a[0], 0.);
    offer(d.gap, 0.);
    return best;
  }



  // A random symmetric positive definite block.
  std::array<double, 4>
  random_block(const double condition, const double scale, Random &random)
  {
    const double angle = random(0., 2 * numbers::PI);
    const double c = std::cos(angle), s = std::sin(angle);
    const double large = scale, small = scale / condition;
    return {{large * c * c + small * s * s,
             (large - small) * c * s,
             (large - small) * c * s,
             large * s * s + small * c * c}};
  }



  void
  test_random()
  {
    Random       random(1);
    double       worst = 0, worst_difference = 0, worst_prescribed = 0;
    unsigned int n_open = 0, n_slip = 0, n_stick = 0, n_open_stick = 0,
                 n_open_slip = 0;
    for (unsigned int i = 0; i < 20000; ++i)
      {
        const double condition = std::pow(10., random(0., i % 2 ? 12. : 3.));
        const double scale     = std::pow(10., random(-10., 10.));
        Data         data;
        data.a         = random_block(condition, scale, random);
        const double u = std::pow(10., random(-4., 4.)); // displacements
        data.b   = {{scale * u * random(-1., 1.), scale * u * random(-1., 1.)}};
        data.gap = random.chance(.1) ? 0. : u * random(-.5, 1.);
        data.bound = random.chance(.2) ? 0. : scale * u * random(0., 1.);

        const LocalProblem<2> problem(data.a, data.gap, 1);
        const auto            z = problem.solve(data.b, data.bound, {{0.}});
        worst                   = std::max(worst, violation(data, z, true));

        if (z.in_contact)
          ++(z.sticks ? n_stick : n_slip);
        else if (data.bound > 0)
          ++(z.sticks ? n_open_stick : n_open_slip);
        else
          ++n_open;

        if (condition < 100.)
          {
            const auto exact = enumerate(data);
            worst_difference =
              std::max(worst_difference,
                       (std::abs(z.normal - exact[0]) +
                        std::abs(z.tangential[0] - exact[1])) /
                         (std::abs(exact[0]) + std::abs(exact[1]) + u * 1e-3));
          }

        // The tangent is held at some value, as on a symmetry plane.
        const double          held = u * random(-1., 1.);
        const LocalProblem<2> half(data.a, data.gap, 0);
        const auto            y = half.solve(data.b, data.bound, {{held}});
        worst_prescribed        = std::max({worst_prescribed,
                                            violation(data, y, false),
                                            std::abs(y.tangential[0] - held)});
        if (y.sticks)
          worst_prescribed = infinity;
      }
    check_below(worst, 1e-14, "the inclusion, 20000 random blocks");
    check_below(worst_difference,
                1e-11,
                "the minimiser by enumeration, blocks of condition below 100");
    check_below(worst_prescribed, 1e-14, "the same with prescribed tangent");
    check(std::min({n_open, n_slip, n_stick, n_open_stick, n_open_slip}) > 500,
          "all five phases occur often");
  }



  // Where two cases meet, either is right, and the solution must not jump.
  void
  test_biactive()
  {
    Random random(2);
    double worst = 0, jump = 0;
    for (unsigned int i = 0; i < 2000; ++i)
      {
        Data data;
        data.a                = random_block(random(1., 100.), 1., random);
        data.gap              = random.chance(.3) ? 0. : random(-1., 1.);
        data.bound            = random.chance(.3) ? 0. : random(0., 1.);
        const bool   touching = random.chance(.7); // z_n = g, but r_n = 0
        const bool   at_cone  = !touching || random.chance(.5);
        const double side     = random.chance(.5) ? 1. : -1.;
        const double slip     = at_cone ? 0. : random(-1., 1.);
        const double pressing = touching ? 0. : random(0., 1.);
        const double r_t =
          at_cone ? side * data.bound : std::copysign(data.bound, slip);
        data.b = {{data.a[0] * data.gap + data.a[1] * slip + pressing,
                   data.a[1] * data.gap + data.a[3] * slip + r_t}};

        const LocalProblem<2> problem(data.a, data.gap, 1);
        const auto            z = problem.solve(data.b, data.bound, {{0.}});
        worst                   = std::max(worst, violation(data, z, true));
        jump                    = std::max({jump,
                                            std::abs(z.normal - data.gap),
                                            std::abs(z.tangential[0] - slip)});
      }
    check_below(worst, 1e-14, "the inclusion where two cases meet");
    check_below(jump, 1e-12, "the solution there");

    // To the last bit: nothing presses, nothing pulls.
    const LocalProblem<2> problem({{2., 0., 0., 4.}}, 0., 1);
    const auto            rest = problem.solve({{0., 0.}}, 1., {{0.}});
    check(rest.in_contact && rest.sticks && rest.normal == 0.,
          "a node at rest on the obstacle touches and sticks");
    const auto edge = problem.solve({{1., 1.}}, 1., {{0.}});
    check(edge.in_contact && edge.sticks, "on the edge of the cone it sticks");
    const auto beyond = problem.solve({{1., 2.}}, 1., {{0.}});
    check(!beyond.sticks && beyond.tangential[0] == .25, "beyond it slips");
    const auto pulled = problem.solve({{-1., .5}}, 1., {{0.}});
    check(!pulled.in_contact && pulled.sticks && pulled.normal == -.5,
          "given friction holds a node that is pulled off the obstacle");
    const auto smooth = problem.solve({{1., 0.}}, 0., {{0.}});
    check(smooth.in_contact && !smooth.sticks, "without friction none sticks");
  }
} // namespace test_local_problem

TEST(local_problem)
{
  test_random();
  test_biactive();
}

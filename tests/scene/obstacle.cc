// Gaps and directions towards a plane, discs and rods, and their rotation.

#include <common/scene/obstacle.h>
#include <common/scene/scene.h>

#include <deal.II/base/function.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

#include <tests/support/check.h>
#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;
using namespace Tests;

TEST(obstacle)
{
  std::cout.precision(5);

  const Tensor<1, 2> down({0., -1.}), up({0., 1.}), right({1., 0.});
  const Tensor<1, 2> slanted({.6, -.8});
  {
    std::cout << "plane" << std::endl;
    const auto plane = Obstacle<2>::half_space(Point<2>(5, -1), 3. * down);
    std::cout << plane.gap(Point<2>(0, 0), down) << ' '
              << plane.gap(Point<2>(0, 0), slanted) << ' '
              << plane.gap(Point<2>(0, -1.5), down) << ' '
              << plane.gap(Point<2>(0, 0), right) << ' '
              << plane.gap(Point<2>(0, 0), up) << ' '
              << plane.normal(Point<2>(0, 0)) << std::endl;
  }
  {
    // Two discs below the unit disc. Along the radius of the latter the gap has
    // a closed form.
    std::cout << "discs" << std::endl;
    const double   r = .5, R = 1.;
    const Point<2> c(.75, -1.5 * std::sqrt(.75));
    const auto     discs =
      Obstacle<2>::make_rods({c, Point<2>(-c[0], c[1])}, {}, r);
    for (const double degrees : {-30., -20., -35.})
      {
        const double       angle = degrees * numbers::PI / 180.;
        const Tensor<1, 2> n({std::sin(-angle), -std::cos(angle)});
        const double       cn = c * n;
        std::cout << discs.gap(Point<2>(R * n), n) << ' '
                  << (cn - R) - std::sqrt(r * r - c.norm_square() + cn * cn)
                  << std::endl;
      }
    std::cout << discs.gap(Point<2>(), down) << ' ' // between the two
              << discs.gap(Point<2>(), up) << ' '   // away from both
              << discs.gap(Point<2>(c + .3 * up), down) << ' '
              << discs.gap(Point<2>(c - .3 * up), down) << ' '
              << discs.gap(Point<2>(c[0] + r, 0.), down) << ' ' // tangential
              << discs.normal(Point<2>(0.1, 0)) << ' '
              << discs.normal(Point<2>(-0.1, 0)) << std::endl;
  }
  {
    std::cout << "rods" << std::endl;
    const Tensor<1, 3> z({0., 0., 2.}), n({0., -1., 0.});
    const Tensor<1, 3> s({0., -.6, .8});
    const auto rods = Obstacle<3>::make_rods({Point<3>(0, -2, 7)}, {z}, .5);
    std::cout << rods.gap(Point<3>(0, 0, 1), n) << ' '
              << rods.gap(Point<3>(0, 0, 1), s) << ' '
              << rods.gap(Point<3>(0, -1.6, 1), n) << ' '
              << rods.normal(Point<3>(2, 0, 1)) << std::endl;

    // From 6 to 8.
    const auto short_rods =
      Obstacle<3>::make_rods({Point<3>(0, -2, 7)}, {z}, .5, 2.);
    std::cout << short_rods.gap(Point<3>(0, 0, 8), n) << ' '
              << short_rods.gap(Point<3>(0, 0, 8.1), n) << ' '
              << short_rods.gap(Point<3>(0, 0, 5), n) << ' '
              << short_rods.gap(Point<3>(0, 0, 5), s) << std::endl;
  }
  {
    // Rods below the unit cylinder, parallel to it, and across. Along the
    // normal of the cylinder the gap has a closed form; from across it is that
    // of the rod's own circle.
    std::cout << "rods below a cylinder" << std::endl;
    const double       r = .5, R = 1.;
    const Point<3>     c(.75, -1.5 * std::sqrt(.75), 1.);
    const Tensor<1, 3> along({0., 0., 1.}), across({1., 0., 0.});
    const auto         parallel =
      Obstacle<3>::make_rods({c, Point<3>(-c[0], c[1], 1.)}, {along, along}, r);
    const auto crossing =
      Obstacle<3>::make_rods({Point<3>(0., -1.5, .5)}, {across}, r);
    for (const double degrees : {-30., -20., -35.})
      {
        const double       angle = degrees * numbers::PI / 180.;
        const Tensor<1, 3> n({std::sin(-angle), -std::cos(angle), 0.});
        const Tensor<1, 3> center({c[0], c[1], 0.});
        const double       cn = center * n;
        const double       z  = .3;
        std::cout << parallel.gap(Point<3>(R * n + z * along), n) << ' '
                  << (cn - R) -
            std::sqrt(r * r - center.norm_square() + cn * cn)
                  << ", " << crossing.gap(Point<3>(R * n + z * along), n) << ' '
                  << (1.5 - std::sqrt(r * r - .2 * .2)) / std::cos(angle) - R
                  << std::endl;
      }
  }
  {
    std::cout << "holes and balls" << std::endl;
    // In a hole it is as far as its radius and the way to its middle say, in
    // all directions; out of the hole, the way back.
    Obstacle<2> hole;
    hole.add({Point<2>(1, 2), Tensor<1, 2>(), 3., 1e300, true});
    Obstacle<3> ball, cavity;
    ball.add({Point<3>(1, 2, 3), Tensor<1, 3>(), 2., 1e300});
    cavity.add({Point<3>(1, 2, 3), Tensor<1, 3>(), 2., 1e300, true});
    std::cout << hole.gap(Point<2>(1, 2), slanted) << ' '
              << hole.gap(Point<2>(1, 1), down) << ' '
              << hole.gap(Point<2>(1, 1), up) << ' '
              << hole.gap(Point<2>(1, -1.5), down) << ' '
              << hole.gap(Point<2>(1, -1.5), up) << ' '
              << hole.normal(Point<2>(1, 1)) << ", "
              << ball.gap(Point<3>(1, 2, 0), Tensor<1, 3>({0., 0., 1.})) << ' '
              << ball.gap(Point<3>(1, 2, 0), Tensor<1, 3>({0., .6, .8})) << ' '
              << ball.normal(Point<3>(1, 2, 0)) << ", "
              << cavity.gap(Point<3>(1, 2, 4), Tensor<1, 3>({0., 0., 1.}))
              << ' '
              << cavity.gap(Point<3>(1, 2, 4), Tensor<1, 3>({0., 0., -1.}))
              << ' ' << cavity.normal(Point<3>(1, 2, 4)) << std::endl;
  }
  {
    // A body is in one of several holes, whose wall is not that of the others.
    // Where a rod has ended, the next one counts that is still there.
    std::cout << "several holes, and rods that end" << std::endl;
    Obstacle<2> holes;
    holes.add({Point<2>(0, 0), Tensor<1, 2>(), 1., 1e300, true});
    holes.add({Point<2>(3, 0), Tensor<1, 2>(), 1., 1e300, true});
    for (const double side : {-1., 1.})
      {
        const Point<2> p(side > 0 ? 3.6 : -.6, 0);
        check_below(std::abs(holes.gap(p, side * right) - .4) +
                      (holes.normal(p) - side * right).norm(),
                    1e-14,
                    "the wall of the hole around a point");
      }
    const Tensor<1, 3> along({0., 0., 1.});
    const auto         staggered = Obstacle<3>::make_rods(
      {Point<3>(0., 0., .5), Point<3>(.3, 0., 1.5)}, {along, along}, .1, 1.);
    const Point<3>     p(.1, .5, 1.5);
    const Tensor<1, 3> to_second = Point<3>(.3, 0., 1.5) - p;
    check_below((staggered.normal(p) - to_second / to_second.norm()).norm() +
                  std::abs(staggered.gap(p, staggered.normal(p)) -
                           (to_second.norm() - .1)),
                1e-14,
                "the rod that has not ended");

    // A bore that gets narrower at z = 1.
    Obstacle<3> bore;
    bore.add({Point<3>(0., 0., .5), along, .2, 1., true});
    bore.add({Point<3>(0., 0., 1.5), along, .1, 1., true});
    const Tensor<1, 3> sideways({1., 0., 0.});
    for (const double z : {.5, 1.5})
      {
        const Point<3> q(.05, 0., z);
        check_below((bore.normal(q) - sideways).norm() +
                      std::abs(bore.gap(q, sideways) - (z < 1 ? .15 : .05)),
                    1e-14,
                    "the part of the bore around a point");
      }
  }
  {
    // The same surface as a disc and by formulas, one a distance, one not.
    std::cout << "surfaces" << std::endl;
    const Point<2> c(.3, -1.5);
    const double   r       = .7;
    const auto     disc    = Obstacle<2>::make_rods({c}, {}, r);
    const auto     surface = [&](const auto &function) {
      Obstacle<2> obstacle;
      obstacle.add(std::make_shared<const LevelSurface<2>>(
        std::make_shared<const ScalarFunctionFromFunctionObject<2>>(function),
        2.));
      return obstacle;
    };
    const auto distance =
      surface([&](const Point<2> &p) { return p.distance(c) - r; });
    const auto level      = surface([&](const Point<2> &p) {
      return std::exp(p.distance_square(c)) - std::exp(r * r);
    });
    double     difference = 0;
    for (const Obstacle<2> *other : {&distance, &level})
      for (double angle = 0; angle < 6.28; angle += .1)
        for (const double along : {.9, 1., 1.1, 1.5, 2.})
          {
            const Tensor<1, 2> way({std::cos(angle), std::sin(angle)});
            const Point<2>     p       = c + r * along * way;
            const Tensor<1, 2> towards = -way,
                               askew({towards[0] * .96 - towards[1] * .28,
                                      towards[1] * .96 + towards[0] * .28});
            difference = std::max(
              {difference,
               (other->normal(p) - disc.normal(p)).norm(),
               std::abs(other->gap(p, towards) - disc.gap(p, towards)),
               std::isfinite(disc.gap(p, askew))
                 ? std::abs(other->gap(p, askew) - disc.gap(p, askew))
                 : std::isfinite(other->gap(p, askew)) * 1.,
               along > 1. ? std::isfinite(other->gap(p, way)) * 1. : 0.});
          }
    check_below(difference, 1e-9, "as by formulas for the disc");

    const auto rough = surface([&](const Point<2> &p) {
      return 5. * (p[1] + 1. - .01 * std::cos(20. * p[0]));
    });
    difference       = 0;
    for (double x = -1; x < 1; x += .01)
      difference = std::max(difference,
                            std::abs(rough.gap(Point<2>(x, -.9), down) -
                                     (.1 - .01 * std::cos(20. * x))));
    check_below(difference, 1e-12, "gaps over a rough plane");
    // Straight down the slope, whatever the function's own size.
    const Tensor<1, 2> slope({.2 * std::sin(20. * .14), 1.});
    check_below(
      (rough.normal(Point<2>(.14, -.99)) + slope / slope.norm()).norm(),
      1e-10,
      "straight to a rough plane");
  }
  {
    // The same in space: a ball by its kind and by a formula that is no
    // distance, and a road that is rough in both directions.
    std::cout << "surfaces in space" << std::endl;
    const Point<3> c(.3, -.2, -1.5);
    const double   r = .7;
    Obstacle<3>    ball;
    ball.add({c, Tensor<1, 3>(), r, 1e300});
    const auto surface = [&](const auto &function) {
      Obstacle<3> obstacle;
      obstacle.add(std::make_shared<const LevelSurface<3>>(
        std::make_shared<const ScalarFunctionFromFunctionObject<3>>(function),
        2.));
      return obstacle;
    };
    const auto level      = surface([&](const Point<3> &p) {
      return std::exp(p.distance_square(c)) - std::exp(r * r);
    });
    double     difference = 0;
    for (double angle = .05; angle < 3.14; angle += .2)
      for (double turn = 0; turn < 6.28; turn += .3)
        for (const double along : {.9, 1.1, 2.})
          {
            const Tensor<1, 3> way({std::sin(angle) * std::cos(turn),
                                    std::sin(angle) * std::sin(turn),
                                    std::cos(angle)});
            const Tensor<1, 3> side =
              cross_product_3d(way, Tensor<1, 3>({0., 0., 1.}));
            const Point<3>     p     = c + r * along * way;
            const Tensor<1, 3> askew = -.96 * way + .28 * side / side.norm();
            const double       gap   = ball.gap(p, askew);
            difference               = std::max(
              {difference,
                             (level.normal(p) - ball.normal(p)).norm(),
                             std::abs(level.gap(p, -way) - ball.gap(p, -way)),
               std::isfinite(gap) ? std::abs(level.gap(p, askew) - gap)
                                                : std::isfinite(level.gap(p, askew)) * 1.});
          }
    check_below(difference, 1e-9, "as by formulas for the ball");

    const auto height = [](const double x, const double y) {
      return .01 * std::cos(20. * x) + .02 * std::sin(10. * y);
    };
    const auto rough = surface(
      [&](const Point<3> &p) { return 5. * (p[2] + 1. - height(p[0], p[1])); });
    difference = 0;
    for (double x = -1; x < 1; x += .07)
      for (double y = -1; y < 1; y += .07)
        difference = std::max(
          difference,
          std::abs(rough.gap(Point<3>(x, y, -.9), Tensor<1, 3>({0., 0., -1.})) -
                   (.1 - height(x, y))));
    check_below(difference, 1e-12, "gaps over a rough plane in space");
  }
  {
    std::cout << "rotated" << std::endl;
    std::ofstream("scene.prm") << "subsection Scene\n"
                                  "  set Rotation angle = 90\n"
                                  "end\n"
                                  "subsection Obstacle\n"
                                  "  set Kind = plane\n"
                                  "  set Point = 0, -0.25\n"
                                  "end\n"
                                  "subsection Boundary conditions\n"
                                  "  set Displacement = 3: x, 2*y\n"
                                  "end\n"
                                  "subsection Contact\n"
                                  "  set Friction law = Tresca\n"
                                  "  set Friction bound = x\n"
                                  "end\n";
    const Scene<2> scene(read_parameters("scene.prm"));
    // (1, 2) of the scene as written is (-2, 1) after a quarter turn.
    const Point<2> p(-2, 1);
    const auto    &u = *scene.dirichlet_conditions()[0].displacement;
    std::cout << scene.contact_conditions()[0].obstacle.gap(Point<2>(), right)
              << "; "
              << scene.contact_conditions()[0].obstacle.normal(Point<2>())
              << "; " << u.value(p, 0) << ' ' << u.value(p, 1) << "; "
              << scene.contact_conditions()[0].friction_bound->value(p) << "; "
              << u.gradient(p, 0) << "; " << u.gradient(p, 1) << std::endl;
  }
  {
    // No friction is no friction, whatever it is called.
    std::ofstream("scene.prm") << "subsection Boundary conditions\n"
                                  "  set Displacement = 3: 0, 0\n"
                                  "end\n";
    const Scene<2> scene(read_parameters("scene.prm"));
    std::cout << (scene.contact_conditions()[0].friction_law ==
                  FrictionLaw::none)
              << ' '
              << (scene.contact_conditions()[0].boundary_id ==
                  numbers::invalid_boundary_id)
              << ' ' << scene.contact_conditions()[0].obstacle.empty() << ' '
              << (scene.body_force() == nullptr) << std::endl;
  }
}

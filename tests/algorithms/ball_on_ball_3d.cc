// The scene ball-on-ball against Hertz's law for two balls: with 1/R = 1/R1 +
// 1/R2 and a force P, the radius of contact is a = (3 P R/(4 E*))^(1/3), the
// largest pressure 3 P/(2 pi a^2), and the approach d = a^2/R. What the platen
// moves is the approach and what the rest of the body gives way, in proportion
// to the force: (s - d)/P is the same for all forces, up to higher powers of
// a/R and what the mesh leaves. On more nodes it is nearer to that; argument
// "Refinement/Maximum dofs=20000".

#include <common/algorithms/nested_iteration.h>
#include <common/contact/contact_forces.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

TEST(ball_on_ball_3d)
{
  // Another mesh than that of the test, for more digits.
  const bool        is_finer = !Tests::arguments().empty();
  const std::string size =
    is_finer ? Tests::arguments()[0] : "Refinement/Maximum dofs=5000";
  NestedIteration<3> nest(without_safeguards(
    read_parameters(SCENES_3D_DIR "/ball-on-ball.prm", {size})));
  const double       R = 2. / 3, E = 1 / (1 - .3 * .3), start = .01;

  double pressure_error = 0, radius_error = 0, least = 1e300, most = -1e300,
         largest_way = 0, largest_force = 0;
  unsigned int most_cycles = 0, n_steps = 0;
  bool         converged = true;
  const auto   add_step  = [&]() {
    ++n_steps;
    converged = converged && nest.report().converged;
    most_cycles =
      std::max<unsigned int>(most_cycles, nest.report().cycles.size());
    double P = 0, p = 0, area = 0, spacing = 0;
    for (unsigned int i = 0; i < nest.state().size(); ++i)
      {
        const ContactNode<3> &node = nest.discretization().contact()[i];
        const double          force =
          -contact_force(node, nest.report().residual) * node.normal();
        P += force * -node.normal()[2];
        p = std::max(p, force / node.measure);
        if (nest.state().in_contact(i))
          {
            area += node.measure;
            spacing = std::max(spacing, std::sqrt(node.measure));
          }
      }
    const double a = std::cbrt(3 * P * R / (4 * E)), d = a * a / R;
    const double s =
      start - (*nest.scene().dirichlet_conditions()[0].platen->position)[2];
    // That of a disc of the same area as the nodes in contact stand for. The
    // outermost of them touch where the bodies do so anywhere within half the
    // distance to the next node, and their measure goes on for as much, so that
    // it may be larger than that of the bodies by a whole distance.
    const double radius = std::sqrt(area / numbers::PI);
    radius_error   = std::max(radius_error, std::abs(radius - a) / spacing);
    pressure_error = std::max(
      pressure_error, std::abs(p / (1.5 * P / (numbers::PI * a * a)) - 1));
    least         = std::min(least, (s - d) / P);
    most          = std::max(most, (s - d) / P);
    largest_way   = std::max(largest_way, s);
    largest_force = std::max(largest_force, P);
    if (is_finer)
      std::cout << "P " << P << ", a " << a << ", measured " << radius << ", p "
                << p << ", s " << s << ", d " << d << ", (s-d)/P "
                << (s - d) / P << std::endl;
  };

  nest.begin();
  do
    nest.solve();
  while (nest.advance());
  add_step();
  while (nest.begin_next_load_step())
    {
      nest.solve();
      add_step();
    }
  check(converged && n_steps == 4, "four forces");
  check_below(std::abs(largest_force / .0021978 - 1),
              1e-5,
              "the obstacle exerts the force of the platen");
  check_below(
    pressure_error, is_finer ? .005 : .04, "the largest pressure is Hertz's");
  check_below(radius_error,
              1.,
              "the radius of the zone of contact is Hertz's, to a node");
  check_below((most - least) * largest_force / largest_way,
              is_finer ? .012 : .05,
              "the platen's way is Hertz's approach and a part in proportion");
  check_below(most_cycles, 20, "few cycles for each force");
}

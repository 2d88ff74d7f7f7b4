// The certificate is a function of a displacement and the residual that belongs
// to it, so that a pair that satisfies the law of contact and friction can be
// written down without solving anything: pick a phase for each contact node and
// give it a displacement and a force of that phase. The certificate of such a
// pair vanishes. Then each condition is violated alone, by a known amount, and
// must show in its own entry with that amount and in no other, but for the
// state of the node where that says something else.
//
// Units are those of the peak pressure: forces at nodes that are held, a
// hundred times larger, make no difference, nor do lengths far from contact.
// Where nothing touches the largest stress is the unit; without any force or
// displacement everything is in order.
//
// Also: without friction the state of the nodes holds not one byte for it.

#include <common/contact/certificate.h>

#include <array>
#include <iostream>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_certificate
{
  constexpr double friction = .4;

  template <int dim>
  struct Solution
  {
    VectorType   u, r;
    ContactState state;

    // Adds to the value at a contact node in a direction of its frame.
    static void
    add(VectorType             &v,
        const ContactNode<dim> &p,
        const unsigned int      direction,
        const double            value)
    {
      for (unsigned int d = 0; d < dim; ++d)
        v.local_element(dim * p.node + d) += value * p.frame[direction][d];
    }
  };



  // Node p: open, sliding and sticking in turn; the first of each kind is what
  // the violations are made at.
  template <int dim>
  Solution<dim>
  make_solution(const RandomProblem<dim> &problem, Random &random)
  {
    const auto   &contact = problem.contact();
    Solution<dim> s{problem.leaf_vector(),
                    problem.leaf_vector(),
                    ContactState(contact.size(), true)};
    using S = Solution<dim>;
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const auto &node = contact[p];
        if (p % 3 == 0)
          {
            S::add(s.u, node, 0, node.gap - random(.1, .5));
            for (unsigned int t = 1; t < dim && p > 0; ++t)
              S::add(s.u, node, t, random(-.5, .5));
          }
        else
          {
            const double tau = random(.2, 1.);
            s.state.set(p, true, p % 3 == 2);
            s.state.set_normal_force(p, tau);
            S::add(s.u, node, 0, node.gap);
            S::add(s.r, node, 0, tau);
            Tensor<1, dim> direction;
            for (unsigned int t = 1; t < dim; ++t)
              direction[t] = random(.1, 1.);
            direction /= direction.norm();
            for (unsigned int t = 1; t < dim; ++t)
              {
                if (p % 3 == 1)
                  S::add(s.u, node, t, 3. * direction[t]);
                S::add(s.r,
                       node,
                       t,
                       (p % 3 == 1 ? 1. : .5) * friction * tau * direction[t]);
              }
          }
      }
    // Prescribed nodes take forces, and the first node is moved off the
    // obstacle, so that scales are known.
    S::add(s.u,
           contact[0],
           0,
           contact[0].gap - 4. - normal_component(contact[0], s.u));
    for (unsigned int i = 0; i < problem.constraints().n_owned_nodes(); ++i)
      if (problem.constraints().is_fixed(i) &&
          !problem.constraints().is_hanging(i))
        s.r.local_element(dim * i) = -2.;
    return s;
  }



  template <int dim>
  void
  test()
  {
    Random                   random(1);
    const RandomProblem<dim> problem(
      block_parameters<dim>(FrictionLaw::coulomb, friction), 2, .5, random);
    const auto         &contact     = problem.contact();
    const auto         &constraints = problem.constraints();
    const Solution<dim> exact       = make_solution<dim>(problem, random);
    const auto         &open = contact[0], &sliding = contact[1],
               &sticking = contact[2];
    using S              = Solution<dim>;

    const auto evaluate = [&](const S &s, const bool coulomb) {
      return make_certificate(
        problem.friction_problem(
          friction, coulomb ? FrictionLaw::coulomb : FrictionLaw::tresca),
        s.u,
        s.r,
        s.state);
    };
    std::cout << dim << "D" << std::endl;
    for (const bool coulomb : {true, false})
      check_below(evaluate(exact, coulomb).largest(),
                  1e-14,
                  std::string("zero for an exact solution, ") +
                    (coulomb ? "Coulomb" : "Tresca"));

    // The unit of stress and the contact zone, which are those of nodes that
    // are said to touch, and what a node needs for a displacement.
    const auto units_of = [&](const ContactState &state) {
      std::array<double, 2> units{};
      for (unsigned int p = 0; p < contact.size(); ++p)
        if (state.in_contact(p))
          {
            units[0] = std::max(units[0],
                                normal_component(contact[p], exact.r) /
                                  contact[p].measure);
            units[1] += contact[p].measure;
          }
      return units;
    };
    const double pressure  = units_of(exact.state)[0];
    const double zone      = units_of(exact.state)[1];
    const auto   stiffness = [&](const ContactNode<dim> &p,
                               const unsigned int      direction) {
      const double *A =
        problem.discretization.stiffness().diagonal_block(p.node);
      double sum = 0;
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int r = 0; r < dim; ++r)
          sum += p.frame[direction][r] * A[c * dim + r] * p.frame[direction][c];
      return sum;
    };

    const double delta  = 1e-3;
    const auto   expect = [&](const std::string &name,
                            double Certificate::*const entry,
                            const double               value,
                            const auto                &violate) {
      S s = exact;
      violate(s);
      Certificate  c   = evaluate(s, true);
      const double got = c.*entry;
      c.*entry = c.state = 0.;
      check(std::abs(got - value) < 1e-10 * value && c.largest() < 1e-13, name);
    };

    unsigned int inner = 0;
    while ([&]() {
      for (const auto &p : contact)
        if (p.node == inner)
          return true;
      return !constraints.is_free(inner);
    }())
      ++inner;
    // Where cells bear more than the peak pressure, that counts.
    const auto inside = [&](const S &s, const unsigned int i) {
      const auto &A   = problem.matrix();
      double      sum = 0;
      for (unsigned int j = 0; j < A.n_rows(); ++j)
        if (A.find(i, j) < A.row_end(i))
          {
            const NodeBlock<dim> block = A.value(i, A.find(i, j));
            Tensor<1, dim>       force;
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int r = 0; r < dim; ++r)
                force[r] += block[c * dim + r] *
                  (s.u.local_element(dim * j + c) -
                   s.u.local_element(dim * i + c));
            sum += .5 * force.norm();
          }
      return sum;
    };
    const auto &faces = problem.discretization.problem().face_measures;
    expect("equilibrium",
           &Certificate::equilibrium,
           delta / std::max(pressure * faces[inner], inside(exact, inner)),
           [&](S &s) { s.r.local_element(dim * inner + dim - 1) = -delta; });
    check(inside(exact, inner) > 0, "cells around that node bear something");
    const auto unit = [&](const ContactNode<dim> &p) {
      return pressure * p.measure;
    };
    const auto of_zone = [&](const ContactNode<dim> &p) {
      return std::pow(p.measure / std::max(p.measure, zone), 1. / (dim - 1));
    };
    expect("penetration",
           &Certificate::penetration,
           stiffness(sticking, 0) * delta * of_zone(sticking) / unit(sticking),
           [&](S &s) { S::add(s.u, sticking, 0, delta); });
    expect("tension", &Certificate::tension, delta / unit(open), [&](S &s) {
      S::add(s.r, open, 0, -delta);
    });
    expect("force at a distance",
           &Certificate::complementarity,
           delta / unit(open),
           [&](S &s) { S::add(s.r, open, 0, delta); });
    const double small = 1e-3 * unit(sticking) / stiffness(sticking, 0);
    expect("distance with a force",
           &Certificate::complementarity,
           1e-3,
           [&](S &s) { S::add(s.u, sticking, 0, -small); });
    expect("cone", &Certificate::cone, delta / unit(sticking), [&](S &s) {
      // From half of the bound to delta beyond it.
      const double r_t = dim == 2
        ? std::abs(tangential_components<dim>(sticking, s.r)[0])
        : std::hypot(tangential_components<dim>(sticking, s.r)[0],
                     tangential_components<dim>(sticking, s.r)[dim - 2]);
      const double factor =
        (friction * normal_component(sticking, s.r) + delta) / r_t;
      const auto r_T = tangential_components<dim>(sticking, exact.r);
      for (unsigned int t = 1; t < dim; ++t)
        S::add(s.r, sticking, t, (factor - 1) * r_T[t - 1]);
    });
    // It slides, with too small a force, but not far; where it does slide, the
    // force points the wrong way, or is too small.
    const double little = 1e-3 * unit(sticking) / stiffness(sticking, 1);
    expect("slip where it sticks", &Certificate::slip, 1e-3, [&](S &s) {
      S::add(s.u, sticking, 1, little);
    });
    const double drag = friction * normal_component(sliding, exact.r);
    expect("slip direction",
           &Certificate::slip,
           2. * drag / unit(sliding),
           [&](S &s) {
             const auto r_T = tangential_components<dim>(sliding, s.r);
             for (unsigned int t = 1; t < dim; ++t)
               S::add(s.r, sliding, t, -2 * r_T[t - 1]);
           });
    expect("slip below the bound",
           &Certificate::slip,
           delta / unit(sliding),
           [&](S &s) {
             const auto r_T = tangential_components<dim>(sliding, s.r);
             for (unsigned int t = 1; t < dim; ++t)
               S::add(s.r, sliding, t, -delta / drag * r_T[t - 1]);
           });

    // What the state of a node says, which is a violation of nothing else: a
    // force, or a length as a force of the contact zone.
    const auto says = [&](const unsigned int p,
                          const bool         touches,
                          const bool         sticks,
                          const bool         is_length) {
      S s = exact;
      s.state.set(p, touches, sticks);
      const auto units = units_of(s.state);
      return evaluate(s, true).state * units[0] * contact[p].measure /
        (is_length ? std::pow(contact[p].measure / units[1], 1. / (dim - 1))
                   : 1.);
    };
    const auto equal = [](const double a, const double b) {
      return std::abs(a - b) < 1e-10 * b;
    };
    check(
      equal(says(1, false, false, false), normal_component(sliding, exact.r)),
      "a node that touches is said to be open");
    check(
      equal(says(0, true, false, true),
            stiffness(open, 0) * (open.gap - normal_component(open, exact.u))),
      "an open node is said to touch");
    check(says(1, true, true, true) > delta, "a sliding node is said to stick");
    check(equal(says(2, true, false, false),
                .5 * friction * normal_component(sticking, exact.r)),
          "a sticking node is said to slide");

    // Rounding in the displacement of a sticking node is no violation.
    S s = exact;
    S::add(s.u, sticking, 1, 1e-17);
    check_below(evaluate(s, true).largest(), 1e-12, "rounding where it sticks");

    // With the law of Tresca the given forces count, with Coulomb's those of
    // the residual: only the former notices a change of the state.
    s = exact;
    for (unsigned int p = 0; p < contact.size(); ++p)
      s.state.set_normal_force(p, 0.);
    check(evaluate(s, true).largest() < 1e-14 && evaluate(s, false).cone > .01,
          "whose normal force bounds friction");

    // Forces where the body is held, and lengths where nothing touches.
    S wrong = exact;
    S::add(wrong.r, open, 0, -delta);
    const double there = evaluate(wrong, true).largest();
    for (unsigned int i = 0; i < constraints.n_owned_nodes(); ++i)
      if (constraints.is_fixed(i) && !constraints.is_hanging(i))
        wrong.r.local_element(dim * i) *= 100.;
    S::add(wrong.u, contact[3], 0, -1.);
    check(equal(evaluate(wrong, true).largest(), there),
          "nothing that is far off makes a difference");

    // Without contact the largest stress is the unit, and with nothing at all
    // there is nothing wrong.
    s = {problem.leaf_vector(),
         problem.leaf_vector(),
         ContactState(contact.size(), true)};
    for (const auto &p : contact)
      S::add(s.u, p, 0, std::min(0., p.gap));
    const double rest = evaluate(s, true).largest();
    for (unsigned int i = 0; i < dim * constraints.n_owned_nodes(); ++i)
      if (!constraints.is_hanging(i / dim))
        s.u.local_element(i) = random(0., .01);
    for (const auto &p : contact)
      S::add(s.u, p, 0, -.1);
    double stress = 0;
    for (unsigned int i = 0; i < constraints.n_owned_nodes(); ++i)
      if (!constraints.is_hanging(i))
        stress = std::max(stress, inside(s, i) / faces[i]);
    s.r.local_element(dim * inner) = 1e-3;
    check(
      rest == 0. &&
        equal(evaluate(s, true).equilibrium, 1e-3 / (stress * faces[inner])),
      "no contact");

    // Not a number is never overlooked.
    for (unsigned int i = 0; i < constraints.n_owned_nodes(); ++i)
      if (constraints.is_free(i))
        {
          s                          = exact;
          s.r.local_element(dim * i) = std::numeric_limits<double>::quiet_NaN();
          break;
        }
    check(!(evaluate(s, true).largest() < 1e-3), "not a number in a force");
    s = exact;
    s.u.local_element(dim * sticking.node) =
      std::numeric_limits<double>::quiet_NaN();
    check(!(evaluate(s, true).largest() < 1e-3),
          "not a number in a displacement");
  }



  void
  test_state()
  {
    ContactState without(100, false), with(100, true);
    for (ContactState *state : {&without, &with})
      {
        state->set(7, true, true);
        state->set(8, true, false);
        state->set(9, false, true);
        state->set_normal_force(7, 1.);
      }
    check(without.friction_memory() == 0, "no friction, no memory for it");
    check(with.friction_memory() >= 100 * (sizeof(double) + sizeof(char)),
          "friction takes a flag and a force per node");
    check(!without.has_friction() && without.n_contact() == 2 &&
            without.n_sticking() == 0 && !without.sticks(7) &&
            without.normal_force(7) == 0.,
          "without friction nodes touch but do not stick");
    check(with.has_friction() && with.n_contact() == 2 &&
            with.n_sticking() == 1 && with.sticks(7) && with.sticks(9) &&
            !with.sticks(8) && with.normal_force(7) == 1.,
          "sticking nodes are counted in contact only");
  }
} // namespace test_certificate

TEST(certificate)
{
  test<2>();
  test<3>();
  test_state();
}

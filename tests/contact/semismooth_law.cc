// The law of contact and friction as semismooth equations. Displacement and
// force at a node are two independent vectors here, so that nothing has to be
// solved:
// - a pair that fulfils the law violates no equation, and its phases are those
//   that it was made with, also where slip counts from an earlier load step;
// - by how much an equation is violated changes with displacement and force as
//   the linearisation says: a step that solves the linearised equations leaves
//   a violation of second order. This is asked in all phases, with Coulomb's
//   bound, with a given one, and where slip is prescribed;
// - a step is one of the semismooth* Newton method of Gfrerer, Mandlmayr,
//   Outrata and Valdman (2023): from a pair it goes to one that fulfils the
//   law, and ends in the tangent space of all such pairs there;
// - the stiffnesses of a zone are those of its nodes over the root of their
//   number in 3D, and over their number in 2D.

#include <common/contact/semismooth_law.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_semismooth_law
{
  constexpr double friction = .4;

  template <int dim>
  using Tangent = typename SemismoothLaw<dim>::Tangent;

  // Displacement and force at a node, in its frame.
  template <int dim>
  struct Pair
  {
    std::array<double, dim> u{}, r{};
  };

  template <int dim>
  SemismoothLaw<dim>
  law_of(const DiscreteProblem<dim> &problem,
         const ContactNode<dim>     &node,
         const double                c,
         const Pair<dim>            &pair,
         const double                given = 0.)
  {
    VectorType u(problem.constraints.partitioner()), r(u);
    for (unsigned int d = 0; d < dim; ++d)
      {
        u.local_element(dim * node.node + d) = node.slip_origin[d];
        for (unsigned int e = 0; e < dim; ++e)
          {
            u.local_element(dim * node.node + d) +=
              pair.u[e] * node.frame[e][d];
            r.local_element(dim * node.node + d) +=
              pair.r[e] * node.frame[e][d];
          }
      }
    return linearize_law(problem, node, {c, given}, u, r);
  }



  template <int dim>
  double
  norm(const std::array<double, dim> &v)
  {
    double sum = 0;
    for (const double x : v)
      sum += x * x;
    return std::sqrt(sum);
  }



  // The pair after a step that solves the linearised equations, but for the
  // parts that these leave open, which are random; scaled by t.
  template <int dim>
  Pair<dim>
  stepped(const Pair<dim>          &pair,
          const SemismoothLaw<dim> &law,
          const unsigned int        n_free,
          const double              t,
          Random                    random)
  {
    std::array<double, dim> du{}, w{};
    for (unsigned int e = 0; e <= n_free; ++e)
      {
        du[e] = random(-1., 1.);
        w[e]  = random(-1., 1.);
      }
    if (law.in_contact)
      du[0] = law.known_step[0];
    else
      w[0] = pair.r[0];
    for (unsigned int s = 0; s < n_free; ++s)
      switch (law.tangent)
        {
          case Tangent<dim>::free:
            w[s + 1] = pair.r[s + 1];
            break;
          case Tangent<dim>::sticks:
            du[s + 1] = law.known_step[s + 1];
            break;
          case Tangent<dim>::slides:
            w[s + 1] = law.rhs[s] + law.slope[s] * w[0];
            for (unsigned int q = 0; q < n_free; ++q)
              w[s + 1] -= law.curvature[q * (dim - 1) + s] * du[q + 1];
        }
    Pair<dim> result = pair;
    for (unsigned int e = 0; e < dim; ++e)
      {
        result.u[e] += t * du[e];
        result.r[e] -= t * w[e];
      }
    return result;
  }



  // A short step takes away its share of the violation, up to second order.
  template <int dim>
  double
  second_order(const DiscreteProblem<dim> &problem,
               const ContactNode<dim>     &node,
               const Pair<dim>            &pair,
               const Random               &random,
               const double                given = 0.)
  {
    constexpr double         c = 2., t = 1e-4;
    const SemismoothLaw<dim> law = law_of(problem, node, c, pair, given);
    const SemismoothLaw<dim> after =
      law_of(problem,
             node,
             c,
             stepped(pair, law, node.n_free_tangents, t, random),
             given);
    if (after.in_contact != law.in_contact || after.tangent != law.tangent)
      return 1e300;
    std::array<double, dim> rest{};
    for (unsigned int e = 0; e <= node.n_free_tangents; ++e)
      rest[e] = after.violation[e] - (1 - t) * law.violation[e];
    return norm<dim>(rest) / (t * norm<dim>(law.violation));
  }



  // By how much a whole step is not one of the semismooth* Newton method: the
  // pair that fulfils the law and has the same r + c u, and the residual of the
  // equations of the tangent space there in the pair after the step. No
  // derivative of a projection occurs.
  template <int dim>
  double
  off_tangent_space(const DiscreteProblem<dim> &problem,
                    const ContactNode<dim>     &node,
                    const Pair<dim>            &pair,
                    const Random               &random,
                    const double                given = 0.)
  {
    constexpr double c       = 2.;
    const bool       coulomb = given == 0.;
    Pair<dim>        on_graph;
    on_graph.r[0]      = std::max(0., pair.r[0] + c * (pair.u[0] - node.gap));
    on_graph.u[0]      = pair.u[0] + (pair.r[0] - on_graph.r[0]) / c;
    const double bound = friction * (coulomb ? on_graph.r[0] : given);
    double       size  = 0;
    for (unsigned int e = 1; e < dim; ++e)
      size += std::pow(pair.r[e] + c * pair.u[e], 2);
    size = std::sqrt(size);
    for (unsigned int e = 1; e < dim; ++e)
      {
        const double z = pair.r[e] + c * pair.u[e];
        on_graph.r[e]  = size > bound ? z * bound / size : z;
        on_graph.u[e]  = (z - on_graph.r[e]) / c;
      }
    const SemismoothLaw<dim> there = law_of(problem, node, c, on_graph, given);
    double                   wrong = norm<dim>(there.violation);

    const Pair<dim> after = stepped(pair,
                                    law_of(problem, node, c, pair, given),
                                    node.n_free_tangents,
                                    1.,
                                    random);
    const auto      add   = [&](const double x) {
      wrong = std::max(wrong, std::abs(x));
    };
    std::array<double, dim> du, dr;
    double                  slip = 0, along = 0;
    for (unsigned int e = 0; e < dim; ++e)
      {
        du[e] = after.u[e] - on_graph.u[e];
        dr[e] = after.r[e] - on_graph.r[e];
        if (e > 0)
          slip += on_graph.u[e] * on_graph.u[e];
      }
    add(on_graph.r[0] > 0 ? du[0] : dr[0]);
    for (unsigned int e = 1; e < dim; ++e)
      along += on_graph.u[e] * du[e];
    for (unsigned int e = 1; e < dim; ++e)
      if (slip == 0)
        add(du[e]);
      else
        {
          const double direction = on_graph.u[e] / std::sqrt(slip);
          add(dr[e] - (coulomb ? friction * direction * dr[0] : 0.) -
              bound / std::sqrt(slip) *
                (du[e] - direction * along / std::sqrt(slip)));
        }
    return wrong;
  }



  template <int dim>
  void
  test()
  {
    std::cout << dim << "D" << std::endl;
    Random                   random(17);
    const RandomProblem<dim> made(
      block_parameters<dim>(FrictionLaw::coulomb, friction), 2, .3, random);
    DiscreteProblem<dim> problem = made.discretization.problem();
    ContactNode<dim>     node    = made.contact()[0];
    constexpr double     c       = 2.;
    using Law                    = SemismoothLaw<dim>;
    for (const ContactNode<dim> &p : made.contact())
      if (p.n_free_tangents == dim - 1)
        node = p;
    node.gap         = .1;
    node.slip_origin = .3 * node.frame[1];

    // Exact pairs.
    Pair<dim> open, sticking, sliding;
    open.u[0]     = -.2;
    open.u[1]     = .7;
    sticking.u[0] = node.gap;
    sticking.r[0] = 1.5;
    sticking.r[1] = .9 * friction * 1.5;
    sliding       = sticking;
    sliding.u[1]  = -.3;
    sliding.u[dim - 1] -= .4;
    std::array<double, dim> slip = sliding.u;
    slip[0]                      = 0;
    for (unsigned int e = 1; e < dim; ++e)
      sliding.r[e] = friction * 1.5 * slip[e] / norm<dim>(slip);
    const auto is = [&](const Pair<dim>            &pair,
                        const bool                  touches,
                        const typename Law::Tangent tangent) {
      const Law law = law_of(problem, node, c, pair);
      return norm<dim>(law.violation) < 1e-14 && law.in_contact == touches &&
        law.tangent == tangent;
    };
    check(is(open, false, Law::Tangent::free), "an open node");
    check(is(sticking, true, Law::Tangent::sticks), "a node that sticks");
    check(is(sliding, true, Law::Tangent::slides), "a node that slides");

    // Pairs that violate the law, in all phases.
    const auto check_order = [&](Pair<dim>          pair,
                                 const std::string &what,
                                 const double       given = 0.) {
      double largest = 0, off = 0;
      for (unsigned int i = 0; i < 20; ++i)
        {
          Pair<dim> wrong = pair;
          for (unsigned int e = 0; e <= node.n_free_tangents; ++e)
            {
              wrong.u[e] += random(-.01, .01);
              wrong.r[e] += random(-.01, .01);
            }
          largest = std::max(largest,
                             second_order(problem, node, wrong, random, given));
          if (node.n_free_tangents == dim - 1)
            off = std::max(
              off, off_tangent_space(problem, node, wrong, random, given));
        }
      check_below(largest, 3e-2, what);
      if (node.n_free_tangents == dim - 1)
        check_below(off, 1e-12, "and they are steps of the semismooth* method");
    };
    check_order(open, "steps of an open node");
    check_order(sticking, "of one that sticks");
    check_order(sliding, "of one that slides");

    problem.friction_law = FrictionLaw::tresca;
    check_order(sliding, "of one that slides with a given bound", 1.5);
    Pair<dim> held = open;
    held.u[1]      = 0;
    check_order(held, "of one that given friction holds without contact", 2.);
    problem.friction_law = FrictionLaw::coulomb;
    if (dim == 3)
      {
        node.n_free_tangents = 1;
        Pair<dim> pulled     = sticking;
        pulled.u[dim - 1]    = .2;
        check(law_of(problem, node, c, pulled).tangent == Law::Tangent::slides,
              "where slip is prescribed the node slides");
        check_order(pulled, "and its steps");
      }

    // Stiffnesses.
    ContactState state(made.contact().size(), true);
    const auto   whole = stiffnesses_of_zone(problem, state);
    double       size  = 0;
    for (const ContactNode<dim> &p : made.contact())
      size += p.measure;
    state.set(0, true, false);
    const auto single = stiffnesses_of_zone(problem, state);
    check_below(
      std::abs(whole[0] / single[0] *
                 std::pow(size / made.contact()[0].measure, 1. / (dim - 1)) -
               1.),
      1e-12,
      "a zone is softer than a node");
  }
} // namespace test_semismooth_law



TEST(semismooth_law)
{
  test<2>();
  test<3>();
}

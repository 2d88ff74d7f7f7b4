// The certificate is a function of a displacement and the residual that belongs
// to it, so that a pair that satisfies the law of contact and friction can be
// written down without solving anything: pick a phase for each contact node and
// give it a displacement and a force of that phase. The certificate of such a
// pair vanishes. Then each condition is violated alone, by a known amount, and
// must show in its own entry with that amount and in no other.
//
// Also: without friction the state of the nodes holds not one byte for it.

#include <common/contact/certificate.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>

using namespace Tests;

namespace
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
    // A prescribed node takes the largest force, 2, so that scales are known;
    // the first node is moved by 4 off the obstacle for the same reason.
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
      const DiscreteProblem<dim> discrete = problem.friction_problem(
        friction, coulomb ? FrictionLaw::coulomb : FrictionLaw::tresca);
      return make_certificate(discrete, s.u, s.r, s.state);
    };
    std::cout << dim << "D" << std::endl;
    for (const bool coulomb : {true, false})
      check_below(evaluate(exact, coulomb).largest(),
                  1e-15,
                  std::string("zero for an exact solution, ") +
                    (coulomb ? "Coulomb" : "Tresca"));

    // Scales: force 2, length 4.
    const double delta  = 1e-3;
    const auto   expect = [&](const std::string &name,
                            double Certificate::*const entry,
                            const double               value,
                            const auto                &violate) {
      S s = exact;
      violate(s);
      Certificate  c   = evaluate(s, true);
      const double got = c.*entry;
      c.*entry         = 0.;
      check(std::abs(got - value) < 1e-12 && c.largest() < 1e-15, name);
    };

    expect("equilibrium", &Certificate::equilibrium, delta / 2, [&](S &s) {
      for (unsigned int i = 0; i < constraints.n_owned_nodes(); ++i)
        {
          bool is_contact_node = false;
          for (const auto &p : contact)
            is_contact_node = is_contact_node || p.node == i;
          if (!is_contact_node && constraints.is_free(i))
            {
              s.r.local_element(dim * i + dim - 1) = -delta;
              break;
            }
        }
    });
    expect("penetration", &Certificate::penetration, delta / 4, [&](S &s) {
      S::add(s.u, sticking, 0, delta);
    });
    expect("tension", &Certificate::tension, delta / 2, [&](S &s) {
      S::add(s.r, open, 0, -delta);
    });
    expect("complementarity",
           &Certificate::complementarity,
           delta / 2,
           [&](S &s) { S::add(s.r, open, 0, delta); });
    expect("cone", &Certificate::cone, delta / 2, [&](S &s) {
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
    expect("slip where it sticks", &Certificate::slip, delta / 4, [&](S &s) {
      S::add(s.u, sticking, 1, delta);
    });
    expect("slip direction",
           &Certificate::slip,
           friction * normal_component(sliding, exact.r),
           [&](S &s) {
             const auto r_T = tangential_components<dim>(sliding, s.r);
             for (unsigned int t = 1; t < dim; ++t)
               S::add(s.r, sliding, t, -2 * r_T[t - 1]);
           });
    expect("slip below the bound", &Certificate::slip, delta / 2, [&](S &s) {
      const auto   r_T    = tangential_components<dim>(sliding, s.r);
      const double factor = delta / (friction * normal_component(sliding, s.r));
      for (unsigned int t = 1; t < dim; ++t)
        S::add(s.r, sliding, t, -factor * r_T[t - 1]);
    });

    // Rounding in the displacement of a sticking node is no violation.
    S s = exact;
    S::add(s.u, sticking, 1, 1e-17);
    check_below(evaluate(s, true).largest(), 1e-15, "rounding where it sticks");

    // With the law of Tresca the given forces count, with Coulomb's those of
    // the residual: only the former notices a change of the state.
    s = exact;
    for (unsigned int p = 0; p < contact.size(); ++p)
      s.state.set_normal_force(p, 0.);
    check(evaluate(s, true).largest() < 1e-15 && evaluate(s, false).cone > .01,
          "whose normal force bounds friction");

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
} // namespace

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test<2>();
  test<3>();
  test_state();
}

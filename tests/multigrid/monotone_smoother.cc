// The leading relaxation with given normal forces. The energy it is about is
//
//   J(u) = 1/2 u^T A u - f^T u + sum_p F tau(p) |u_T(p)|,   u_n(p) <= g(p).
//
// One node after the other is moved to the minimum of J with respect to that
// node. Each such step is looked at alone, by holding all other nodes: J does
// not increase, no other displacement of this node is any better, and the
// iterate stays admissible. So do whole sweeps, in either direction, from
// random admissible starts, with friction and without, with bounds that hold
// nodes above the obstacle, and with a tangent prescribed. What many sweeps
// converge to satisfies the law of contact and friction, and stays.

#include <common/contact/certificate.h>
#include <common/multigrid/monotone_smoother.h>
#include <common/solvers/tresca_functional.h>

#include <iostream>
#include <limits>

#include <tests/support/random_problem.h>

using namespace Tests;

namespace
{
  constexpr int    dim      = 2;
  constexpr double infinity = std::numeric_limits<double>::infinity();

  VectorType
  random_start(const RandomProblem<dim> &problem, Random &random)
  {
    VectorType u = problem.leaf_vector();
    for (auto &value : u)
      value = random(-.05, .05);
    problem.constraints().impose(u);
    for (const auto &p : problem.contact())
      {
        const double excess = normal_component(p, u) - p.gap;
        if (excess > 0)
          for (unsigned int d = 0; d < dim; ++d)
            u.local_element(dim * p.node + d) -=
              (excess + (random.chance(.5) ? .01 : 0.)) * p.normal()[d];
      }
    // A prescribed tangent stays.
    problem.constraints().impose(u);
    for (unsigned int i = 0; i < problem.constraints().n_nodes(); ++i)
      if (problem.constraints().is_hanging(i))
        for (unsigned int d = 0; d < dim; ++d)
          u.local_element(dim * i + d) = 0.;
    return u;
  }



  // Random normal forces at some of the nodes, whether they touch or not.
  ContactState
  random_state(const RandomProblem<dim> &problem,
               const double              friction,
               Random                   &random)
  {
    ContactState state(problem.contact().size(), friction > 0);
    for (unsigned int p = 0; p < state.size(); ++p)
      if (random.chance(.7))
        state.set_normal_force(p, random(0., .02));
    return state;
  }



  // All nodes but one held at where they are: the relaxation of that node.
  void
  test_single_nodes(const RandomProblem<dim> &problem,
                    const double              friction,
                    Random                   &random)
  {
    const auto                 &disc = *problem.discretization;
    const TrescaFunctional<dim> functional(disc.problem());
    VectorType                  u     = random_start(problem, random);
    ContactState                state = random_state(problem, friction, random);

    double       increase = 0, better = 0, penetration = -infinity, moved = 0;
    unsigned int n_lowered = 0;
    for (unsigned int i = 0; i < problem.constraints().n_nodes(); ++i)
      {
        if (problem.constraints().is_fixed(i))
          continue;
        NodalConstraints<dim> held = problem.constraints();
        for (unsigned int j = 0; j < held.n_nodes(); ++j)
          if (j != i && !held.is_hanging(j))
            for (unsigned int d = 0; d < dim; ++d)
              held.prescribe(j, d, u.local_element(dim * j + d));
        const ContactBoundary<dim> contact(disc.mapping,
                                           disc.dof_handler,
                                           disc.hanging,
                                           held,
                                           problem.scene.contact_boundary_id(),
                                           problem.scene.obstacle(),
                                           problem.scene.contact_normal());
        AssertThrow(contact.size() <= 1, ExcInternalError());
        ContactState single(contact.size(), friction > 0);
        unsigned int number = 0;
        if (contact.size() > 0)
          {
            while (problem.contact()[number].node != i)
              ++number;
            single.set_normal_force(0, state.normal_force(number));
          }
        const MonotoneSmoother<dim> smoother(
          problem.matrix(), held, contact, friction);
        const VectorType before = u;
        const double     energy = functional.energy(u, state);
        smoother.sweep(u, disc.forces, single, false, random.chance(.5));
        const double now = functional.energy(u, state);
        increase         = std::max(increase, now - energy);
        n_lowered += now < energy - 1e-8;
        penetration = std::max(penetration, functional.largest_penetration(u));
        for (unsigned int j = 0; j < held.n_nodes(); ++j)
          for (unsigned int d = 0; d < dim; ++d)
            if (held.is_prescribed(j, d))
              moved = std::max(moved,
                               std::abs(u.local_element(dim * j + d) -
                                        before.local_element(dim * j + d)));

        for (unsigned int attempt = 0; attempt < 5; ++attempt)
          {
            VectorType   other(u);
            const double size = std::pow(10., random(-6., -2.));
            for (unsigned int d = 0; d < dim; ++d)
              if (!problem.constraints().is_prescribed(i, d))
                other.local_element(dim * i + d) += size * random(-1., 1.);
            if (functional.largest_penetration(other) <= 0)
              better = std::max(better, now - functional.energy(other, state));
          }
      }
    check_below(increase, 1e-16, "single nodes: the energy does not increase");
    check(n_lowered > 20, "it is lowered often");
    check_below(better, 1e-15, "no other displacement of the node is better");
    check_below(penetration, 1e-14, "the node does not penetrate");
    check_below(moved, 0., "no other node is moved");
  }



  void
  test_sweeps(const RandomProblem<dim> &problem,
              const double              friction,
              Random                   &random)
  {
    const auto                 &disc = *problem.discretization;
    const TrescaFunctional<dim> functional(disc.problem());
    const MonotoneSmoother<dim> smoother(
      problem.matrix(), problem.constraints(), problem.contact(), friction);
    double       increase = 0, penetration = -infinity, prescribed = 0;
    double       residuals     = 0;
    bool         flags_right   = true;
    unsigned int n_open_sticks = 0;
    for (unsigned int start = 0; start < 5; ++start)
      {
        VectorType   u     = random_start(problem, random);
        ContactState state = random_state(problem, friction, random);
        double       last  = functional.energy(u, state);
        for (unsigned int sweep = 0; sweep < 20; ++sweep)
          {
            smoother.sweep(u, disc.forces, state, false, random.chance(.5));
            const double energy = functional.energy(u, state);
            increase            = std::max(increase, energy - last);
            last                = energy;
            penetration =
              std::max(penetration, functional.largest_penetration(u));
            for (unsigned int i = 0; i < problem.constraints().n_nodes(); ++i)
              for (unsigned int d = 0; d < dim; ++d)
                if (problem.constraints().is_prescribed(i, d))
                  prescribed = std::max(
                    prescribed,
                    std::abs(
                      u.local_element(dim * i + d) -
                      problem.constraints().prescribed_values().local_element(
                        dim * i + d)));
            for (unsigned int p = 0; p < problem.contact().size(); ++p)
              {
                const auto  &node = problem.contact()[p];
                const double room = node.gap - normal_component(node, u);
                const double u_t  = tangential_components<dim>(node, u)[0];
                flags_right       = flags_right &&
                  (!state.in_contact(p) || room < 1e-14) &&
                  (!state.sticks(p) || std::abs(u_t) < 1e-15) &&
                  (!state.sticks(p) || state.normal_force(p) > 0);
                n_open_sticks += state.sticks(p) && !state.in_contact(p);
              }
          }

        // Several sweeps at once are as many single ones.
        VectorType                             v(u), r(u), expected(u);
        ContactState                           other = state;
        typename MonotoneSmoother<dim>::Sweeps three;
        three.n         = 3;
        three.backwards = start % 2;
        smoother.sweeps(v, disc.forces, other, three, &r);
        for (unsigned int sweep = 0; sweep < 3; ++sweep)
          smoother.sweep(u, disc.forces, state, false, three.backwards);
        problem.matrix().residual(
          expected.begin(), disc.forces.begin(), u.begin());
        expected -= r;
        u -= v;
        residuals =
          std::max({residuals, u.linfty_norm(), expected.linfty_norm()});
      }
    check_below(increase, 1e-16, "sweeps: the energy does not increase");
    check_below(penetration, 1e-14, "iterates are admissible");
    check_below(prescribed, 0., "prescribed components stay");
    check(flags_right, "nodes flagged touch and stick");
    check((n_open_sticks > 0) == (friction > 0),
          "given friction holds nodes off the obstacle too");
    check_below(residuals, 0., "three sweeps at once, and their residual");
  }



  void
  test_fixed_point(const RandomProblem<dim> &problem,
                   const double              friction,
                   const bool                coulomb,
                   Random                   &random)
  {
    const auto                 &disc = *problem.discretization;
    const MonotoneSmoother<dim> smoother(
      problem.matrix(), problem.constraints(), problem.contact(), friction);
    VectorType   u     = random_start(problem, random);
    ContactState state = random_state(problem, friction, random);
    for (unsigned int sweep = 0; sweep < 2500; ++sweep)
      smoother.sweep(u, disc.forces, state, coulomb, sweep % 2);

    VectorType   v(u), r(u);
    ContactState after = state;
    smoother.sweep(v, disc.forces, after, coulomb, false);
    smoother.sweep(v, disc.forces, after, coulomb, true);
    problem.matrix().residual(r.begin(), disc.forces.begin(), u.begin());
    const Certificate certificate = make_certificate<dim>(
      u, r, problem.constraints(), problem.contact(), state, friction, coulomb);
    v -= u;
    bool same = state.n_contact() == after.n_contact() &&
      state.n_sticking() == after.n_sticking();
    const std::string law = friction == 0 ? "no friction"
      : coulomb                           ? "Coulomb"
                                          : "Tresca";
    check_below(v.linfty_norm() / u.linfty_norm(),
                1e-12,
                law + ": a solution is a fixed point");
    check(same && state.n_contact() > 0, law + ": and so is its state");
    check_below(certificate.largest(), 1e-9, law + ": and certified");
  }



  void
  test(const Parameters &parameters, const std::string &what)
  {
    Random                   random(1);
    const RandomProblem<dim> problem(parameters, 2, .5, random);
    const double             friction = problem.scene.friction_coefficient();
    std::cout << what << ", " << problem.contact().size() << " contact nodes, "
              << problem.n_hanging() << " nodes hang" << std::endl;
    test_single_nodes(problem, friction, random);
    test_sweeps(problem, friction, random);
    test_fixed_point(problem, friction, false, random);
    if (friction > 0)
      test_fixed_point(problem, friction, true, random);
  }
} // namespace

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  // The obstacle leans a little, so that some nodes stay off it.
  const auto leaning = [](const FrictionLaw law, const double friction) {
    Parameters parameters      = block_parameters<dim>(law, friction);
    parameters.obstacle.normal = {.03, -1.};
    return parameters;
  };
  test(leaning(FrictionLaw::none, 0.), "F=0");
  test(leaning(FrictionLaw::coulomb, .4), "F=0.4");

  Parameters held = leaning(FrictionLaw::coulomb, .4);
  held.boundary_conditions.displacement.push_back({"0", {"0.001", "free"}});
  test(held, "F=0.4, a tangent prescribed");

  // Normals in all directions.
  Parameters disc;
  disc.scene.geometry               = GeometryKind::half_disc;
  disc.scene.radius                 = 1.;
  disc.obstacle.kind                = ObstacleKind::plane;
  disc.obstacle.point               = {0., -1.};
  disc.obstacle.normal              = {0., -1.};
  disc.contact.boundary_id          = 0;
  disc.contact.friction_law         = FrictionLaw::coulomb;
  disc.contact.friction_coefficient = .4;
  disc.boundary_conditions.displacement.push_back({"1", {"0.05", "-0.2"}});
  test(disc, "half disc, F=0.4");
}

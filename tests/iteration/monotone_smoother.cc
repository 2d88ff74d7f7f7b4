// The leading relaxation with given normal forces. The energy it is about is
//
//   J(u) = 1/2 u^T A u - f^T u + sum_p F tau(p) |u_T(p)|,   u_n(p) <= g(p).
//
// One node after the other is moved to the minimum of J with respect to that
// node. Each such step is looked at alone, by holding all other nodes: J does
// not increase, no other displacement of this node is any better, and the
// iterate stays admissible. So do whole sweeps from random admissible starts,
// with friction and without, with bounds that hold nodes above the obstacle,
// and with a tangent prescribed. What many sweeps converge to satisfies the law
// of contact and friction, and stays.
//
// In 3D nodes hang on the contact boundary. They have no part in any of this:
// whatever value is written there, it is not read, nor is it changed. And the
// local problems can be solved in two ways, which must not make a difference.
//
// Out of the obstacle's reach a sweep is block Gauss-Seidel that takes the
// nodes, contact nodes and all, in the order of their numbers.

#include <common/contact/certificate.h>
#include <common/iteration/monotone_smoother.h>
#include <common/iteration/tresca_functional.h>

#include <iostream>
#include <limits>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_monotone_smoother
{
  constexpr double infinity = std::numeric_limits<double>::infinity();

  template <int dim>
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
  template <int dim>
  ContactState
  random_state(const RandomProblem<dim> &problem,
               const double              friction,
               Random                   &random)
  {
    ContactState state(problem.contact().size(), friction > 0);
    for (unsigned int p = 0; p < state.size(); ++p)
      if (random.chance(.7))
        state.set_normal_force(p, random(0., dim == 2 ? .02 : .002));
    return state;
  }



  // All nodes but one held at where they are: the relaxation of that node.
  template <int dim>
  void
  test_single_nodes(const RandomProblem<dim> &problem,
                    const double              friction,
                    Random                   &random)
  {
    const auto                 &d    = problem.discretization;
    const DiscreteProblem<dim>  disc = problem.friction_problem(friction);
    const TrescaFunctional<dim> functional(disc);
    VectorType                  u = random_start<dim>(problem, random);
    ContactState state = random_state<dim>(problem, friction, random);

    double       increase = 0, better = 0, penetration = -infinity, moved = 0;
    unsigned int n_lowered = 0;
    for (unsigned int i = 0; i < problem.constraints().n_nodes(); ++i)
      {
        if (problem.constraints().is_fixed(i))
          continue;
        std::vector<unsigned int> others;
        for (unsigned int j = 0; j < problem.constraints().n_nodes(); ++j)
          if (j != i && !problem.constraints().is_hanging(j))
            others.push_back(j);
        NodalConstraints<dim> held = problem.constraints();
        held.prescribe(others, u);
        const ContactBoundary<dim> contact(
          d.mapping(), d.dof_handler(), d.hanging_nodes(), held, problem.scene);
        const DiscreteProblem<dim> of_node = {disc.stiffness,
                                              disc.forces,
                                              held,
                                              contact,
                                              disc.face_measures,
                                              disc.friction_law,
                                              disc.friction_coefficient};
        AssertThrow(contact.size() <= 1, ExcInternalError());
        ContactState single(contact.size(), friction > 0);
        unsigned int number = 0;
        if (contact.size() > 0)
          {
            while (problem.contact()[number].node != i)
              ++number;
            single.set_normal_force(0, state.normal_force(number));
          }
        const MonotoneSmoother<dim> smoother(of_node);
        const VectorType            before = u;
        const double                energy = functional.energy(u, state);
        sweep(smoother, u, single, false);
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



  template <int dim>
  void
  test_sweeps(const RandomProblem<dim> &problem,
              const double              friction,
              Random                   &random)
  {
    const DiscreteProblem<dim>  disc = problem.friction_problem(friction);
    const TrescaFunctional<dim> functional(disc);
    const MonotoneSmoother<dim> smoother(disc);
    double       increase = 0, penetration = -infinity, prescribed = 0;
    double       residuals     = 0;
    bool         flags_right   = true;
    unsigned int n_open_sticks = 0;
    for (unsigned int start = 0; start < 5; ++start)
      {
        VectorType   u     = random_start<dim>(problem, random);
        ContactState state = random_state<dim>(problem, friction, random);
        double       last  = functional.energy(u, state);
        for (unsigned int n = 0; n < 20; ++n)
          {
            sweep(smoother, u, state, false);
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
                double       slip = 0;
                for (const double u_t : tangential_components<dim>(node, u))
                  slip = std::max(slip, std::abs(u_t));
                flags_right = flags_right &&
                  (!state.in_contact(p) || room < 1e-14) &&
                  (!state.sticks(p) || slip < 1e-15) &&
                  (!state.sticks(p) || state.normal_force(p) > 0);
                n_open_sticks += state.sticks(p) && !state.in_contact(p);
              }
          }

        // Several sweeps at once are as many single ones.
        VectorType         v(u), expected(u);
        ContactState       other = state;
        Iterate            x(v, other);
        const unsigned int n_sweeps = start % 2 ? 3 : 8;
        smoother.relax(x, n_sweeps);
        for (unsigned int n = 0; n < n_sweeps; ++n)
          sweep(smoother, u, state, false);
        disc.stiffness.residual(expected, disc.forces, u);
        expected -= x.residual;
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
    check_below(residuals, 0., "several sweeps at once, and their residual");
  }



  template <int dim>
  double
  largest_difference(VectorType u, const VectorType &v)
  {
    u -= v;
    return u.linfty_norm();
  }



  // What is written at hanging nodes, and how local problems are solved, makes
  // no difference.
  template <int dim>
  void
  test_hanging_nodes(const RandomProblem<dim> &problem,
                     const double              friction,
                     Random                   &random)
  {
    const DiscreteProblem<dim>  disc = problem.friction_problem(friction);
    const auto                 &constraints = problem.constraints();
    const MonotoneSmoother<dim> smoother(disc);
    const MonotoneSmoother<dim> uzawa(disc, LocalSolver::uzawa);
    double                      difference = 0, disagreement = 0;
    bool                        untouched = true, same_states = true;
    unsigned int                n_hanging[2] = {0, 0};
    for (unsigned int start = 0; start < 3; ++start)
      {
        VectorType u = random_start<dim>(problem, random), v(u), w(u);
        for (unsigned int i = 0; i < constraints.n_nodes(); ++i)
          if (constraints.is_hanging(i))
            for (unsigned int d = 0; d < dim; ++d)
              v.local_element(dim * i + d) = random(-1e3, 1e3);
        const VectorType written(v);
        ContactState     state = random_state<dim>(problem, friction, random);
        ContactState     state_v(state), state_w(state);
        for (unsigned int n = 0; n < 6; ++n)
          {
            const bool coulomb = start == 2 && n > 2;
            sweep(smoother, u, state, coulomb);
            sweep(smoother, v, state_v, coulomb);
            sweep(uzawa, w, state_w, coulomb);
            disagreement = std::max(
              disagreement, largest_difference<dim>(u, w) / u.linfty_norm());
            for (unsigned int p = 0; p < state.size(); ++p)
              for (const ContactState *other : {&state_v, &state_w})
                same_states = same_states &&
                  state.in_contact(p) == other->in_contact(p) &&
                  state.sticks(p) == other->sticks(p);
          }
        for (unsigned int i = 0; i < constraints.n_nodes(); ++i)
          for (unsigned int d = dim * i; d < dim * (i + 1); ++d)
            if (constraints.is_hanging(i))
              untouched =
                untouched && v.local_element(d) == written.local_element(d);
            else
              difference = std::max(
                difference, std::abs(u.local_element(d) - v.local_element(d)));
        for (const bool sticking : {false, true})
          n_hanging[sticking] +=
            problem.n_hanging_at_contact([&](const unsigned int p) {
              return state.in_contact(p) && state.sticks(p) == sticking;
            });
      }
    check((n_hanging[0] + n_hanging[1] > 0) == (dim == 3),
          dim == 2 ? "in 2D no node hangs on the contact boundary"
                   : "nodes hang at nodes in contact");
    if (dim == 3)
      std::cout << "        some of which " << (n_hanging[0] > 0 ? "slide" : "")
                << (n_hanging[1] > 0 ? ", others stick" : "") << std::endl;
    check_below(difference, 0., "values at hanging nodes are not read");
    check(untouched, "nor are they changed");
    check_below(disagreement,
                dim == 2 ? 0. : 1e-10,
                "both solvers of local problems agree");
    check(same_states, "and so do the states");
  }



  // The obstacle is out of reach.
  template <int dim>
  void
  test_order(Parameters parameters, Random &random)
  {
    for (double &x : parameters.obstacle.point)
      x -= 10.;
    for (auto &center : parameters.obstacle.centers)
      center.back() -= 10.;
    const RandomProblem<dim>    problem(parameters, 2, .5, random);
    const DiscreteProblem<dim>  disc = problem.friction_problem(0.);
    const NodeBlockMatrix<dim> &A    = disc.stiffness.blocks();
    const MonotoneSmoother<dim> smoother(disc);
    ContactState                state(problem.contact().size(), false);
    const auto relax_node = [&](const unsigned int i, VectorType &u) {
      if (A.is_empty(i))
        return;
      NodeBlock<dim> block;
      std::copy_n(A.diagonal(i), dim * dim, block.begin());
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int q = 0; q < dim; ++q)
          if (problem.constraints().is_prescribed(i, c) ||
              problem.constraints().is_prescribed(i, q))
            block[c * dim + q] = 0.;
      const NodeBlock<dim> inverse =
        pseudo_inverse<dim>(block, 1e-10 * trace<dim>(block.data()));
      NodeValue<dim> r = A.row_times(i, u.begin());
      for (unsigned int d = 0; d < dim; ++d)
        r[d] = disc.forces.local_element(dim * i + d) - r[d];
      const NodeValue<dim> step = times<dim>(inverse.data(), r.data());
      for (unsigned int d = 0; d < dim; ++d)
        u.local_element(dim * i + d) += step[d];
    };
    double ascending = 0, descending = 1e300;
    for (unsigned int sample = 0; sample < 5; ++sample)
      {
        VectorType u = random_start<dim>(problem, random), up(u), down(u);
        sweep(smoother, u, state, false);
        for (unsigned int i = 0; i < A.n_rows(); ++i)
          relax_node(i, up);
        for (unsigned int i = A.n_rows(); i-- > 0;)
          relax_node(i, down);
        const double size = u.linfty_norm();
        ascending = std::max(ascending, largest_difference<dim>(up, u) / size);
        descending =
          std::min(descending, largest_difference<dim>(down, u) / size);
      }
    check_below(ascending, 1e-12, "nodes are taken by ascending numbers");
    check(descending > 1e-4 && state.n_contact() == 0,
          "which is not the same as by descending ones");
  }



  template <int dim>
  void
  test_fixed_point(const RandomProblem<dim> &problem,
                   const double              friction,
                   const bool                coulomb,
                   Random                   &random)
  {
    const DiscreteProblem<dim> disc = problem.friction_problem(
      friction, coulomb ? FrictionLaw::coulomb : FrictionLaw::tresca);
    const MonotoneSmoother<dim> smoother(disc);
    VectorType                  u = random_start<dim>(problem, random);
    ContactState state = random_state<dim>(problem, friction, random);
    for (unsigned int n = 0; n < 3500; ++n)
      sweep(smoother, u, state, coulomb);

    VectorType   v(u), r(u);
    ContactState after = state;
    sweep(smoother, v, after, coulomb);
    disc.stiffness.residual(r, disc.forces, u);
    const Certificate certificate = make_certificate(disc, u, r, state);
    v -= u;

    // Sliding nodes once more: in 3D a part of the slip may be prescribed.
    double direction = 0;
    for (unsigned int p = 0; p < state.size(); ++p)
      if (!state.sticks(p) && state.normal_force(p) > 0)
        {
          const auto u_T  = tangential_components<dim>(problem.contact()[p], u);
          const auto r_T  = tangential_components<dim>(problem.contact()[p], r);
          double     slip = 0;
          for (const double u_t : u_T)
            slip = std::hypot(slip, u_t);
          for (unsigned int t = 0; t < problem.contact()[p].n_free_tangents;
               ++t)
            direction = std::max(
              direction,
              std::abs(r_T[t] -
                       friction * state.normal_force(p) * u_T[t] / slip));
        }
    bool same = state.n_contact() == after.n_contact() &&
      state.n_sticking() == after.n_sticking();
    const std::string law = friction == 0 ? "no friction"
      : coulomb                           ? "Coulomb"
                                          : "Tresca";
    check_below(v.linfty_norm() / u.linfty_norm(),
                1e-12,
                law + ": a solution is a fixed point");
    check(same && state.n_contact() > 0, law + ": and so is its state");
    check_below(direction, 1e-12, law + ": friction opposes the slip");
    check_below(certificate.largest(), 1e-9, law + ": and certified");
  }



  template <int dim>
  void
  test(const Parameters &parameters, const std::string &what)
  {
    Random                   random(1);
    const RandomProblem<dim> problem(parameters, 2, .5, random);
    const double             friction =
      problem.scene.contact_conditions()[0].friction_coefficient;
    std::cout << dim << "D, " << what << ", " << problem.contact().size()
              << " contact nodes, " << problem.n_hanging() << " nodes hang"
              << std::endl;
    test_single_nodes<dim>(problem, friction, random);
    test_sweeps<dim>(problem, friction, random);
    test_hanging_nodes<dim>(problem, friction, random);
    test_order<dim>(parameters, random);
    test_fixed_point<dim>(problem, friction, false, random);
    if (friction > 0)
      test_fixed_point<dim>(problem, friction, true, random);
  }

  template <int dim>
  void
  test_all()
  {
    // The obstacle leans a little, so that some nodes stay off it.
    const auto leaning = [](const FrictionLaw law, const double friction) {
      Parameters parameters = block_parameters<dim>(law, friction);
      parameters.obstacle.normal =
        std::vector<double>(dim, dim == 2 ? .03 : -.006);
      parameters.obstacle.normal.back() = -1.;
      return parameters;
    };
    test<dim>(leaning(FrictionLaw::none, 0.), "F=0");
    test<dim>(leaning(FrictionLaw::coulomb, .4), "F=0.4");

    Parameters               held = leaning(FrictionLaw::coulomb, .4);
    std::vector<std::string> displacement(dim, "free");
    displacement[0] = "0.001";
    held.boundary_conditions.displacement.push_back({"0", displacement});
    test<dim>(held, "F=0.4, a tangent prescribed");

    // Normals in all directions.
    test<dim>(curved_parameters<dim>(FrictionLaw::coulomb, .4),
              "curved, F=0.4");
  }
} // namespace test_monotone_smoother

TEST(monotone_smoother)
{
  test_all<2>();
  test_all<3>();
}

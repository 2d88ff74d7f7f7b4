// The constrained Newton linearisation: for states in which every phase occurs,
// the free subspace of each contact node is that of its phase; on it, the
// linearised residual and omega'' are the derivatives of the energy at given
// friction bounds; and the bounds of the monotone correction contain zero, and
// keep any correction within them admissible and free of changes of phase.
//
// In 2D the energy is quadratic as long as no node changes its direction of
// slip, so that differences are derivatives, up to rounding. In 3D slip may
// turn, and what is left out is of higher order: with r = T (f - A u - omega')
// and H = T (A + omega'') T, for v in the free subspace,
//
//   J(u+hv) = J(u) - h r.v + h^2/2 v.Hv + O(h^3),
//   r(u+hv) = r(u) - h H v + O(h^2).
//
// The orders are measured. Without omega'' they are less by one, which shows
// that they measure something.
//
// The level matrices depend on omega'', so that it is computed anew only where
// it has changed by more than a tenth, of itself and of the stiffness that it
// is added to: that, too, is checked, and that the changes do not add up.

#include <common/iteration/linearization.h>
#include <common/iteration/tresca_functional.h>

#include <iostream>
#include <limits>

#include <tests/support/check.h>
#include <tests/support/dense.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_linearization
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double friction = .4;

  enum Phase
  {
    open,       // above the obstacle, no friction
    open_slip,  // above it, and sliding with given friction
    open_stick, // above it, and held by given friction
    slip,       // in contact and sliding
    smooth,     // in contact, without normal force
    stick,      // in contact and held
    n_phases
  };

  struct Sample
  {
    VectorType         u;
    ContactState       state;
    std::vector<Phase> phases;
  };

  bool
  is_held(const Phase phase)
  {
    return phase == stick || phase == open_stick;
  }



  template <int dim>
  Tensor<1, dim>
  slip_of(const ContactNode<dim> &node, const VectorType &u)
  {
    Tensor<1, dim> result;
    const auto     u_T = tangential_components<dim>(node, u);
    for (unsigned int t = 1; t < dim; ++t)
      result += u_T[t - 1] * node.frame[t];
    return result;
  }



  // Moves a contact node by a vector.
  template <int dim>
  void
  shift(VectorType &u, const ContactNode<dim> &node, const Tensor<1, dim> &by)
  {
    for (unsigned int d = 0; d < dim; ++d)
      u.local_element(dim * node.node + d) += by[d];
  }



  // A node slides along a prescribed tangent whatever friction does; it cannot
  // be held.
  template <int dim>
  Sample
  make_sample(const RandomProblem<dim> &problem, Random &random)
  {
    const auto &contact = problem.contact();
    Sample it{problem.leaf_vector(), ContactState(contact.size(), true), {}};
    for (auto &value : it.u)
      value = random(-.1, .1);
    problem.constraints().impose(it.u);
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const auto &node  = contact[p];
        Phase       phase = static_cast<Phase>(random.below(n_phases));
        if (node.n_free_tangents < dim - 1 && is_held(phase))
          phase = (phase == stick ? slip : open_slip);
        const bool touches = phase >= slip;
        shift<dim>(it.u,
                   node,
                   (node.gap - (touches ? 0. : random(.01, .1)) -
                    normal_component(node, it.u)) *
                     node.normal());
        if (is_held(phase))
          shift<dim>(it.u, node, -slip_of<dim>(node, it.u));
        it.phases.push_back(phase);
        it.state.set(p, touches, is_held(phase));
        it.state.set_normal_force(
          p, phase == open || phase == smooth ? 0. : random(.1, 1.));
      }
    // To the last bit.
    problem.constraints().impose(it.u);
    return it;
  }



  template <int dim>
  Eigen::Matrix<double, dim, dim>
  to_matrix(const NodeBlock<dim> &block)
  {
    return Eigen::Map<const Eigen::Matrix<double, dim, dim>>(block.data());
  }



  template <int dim>
  Eigen::Matrix<double, dim, 1>
  to_eigen(const Tensor<1, dim> &t)
  {
    Eigen::Matrix<double, dim, 1> result;
    for (unsigned int d = 0; d < dim; ++d)
      result(d) = t[d];
    return result;
  }



  // What it should be, in the words of the documentation.
  template <int dim>
  Eigen::Matrix<double, dim, dim>
  expected_projector(const ContactNode<dim> &node, const Phase phase)
  {
    Eigen::Matrix<double, dim, dim> T = Eigen::Matrix<double, dim, dim>::Zero();
    if (phase < slip)
      T +=
        to_eigen<dim>(node.normal()) * to_eigen<dim>(node.normal()).transpose();
    if (!is_held(phase))
      for (unsigned int t = 1; t <= node.n_free_tangents; ++t)
        T += to_eigen<dim>(node.frame[t]) *
          to_eigen<dim>(node.frame[t]).transpose();
    return T;
  }



  template <int dim>
  Eigen::Matrix<double, dim, dim>
  expected_curvature(const ContactNode<dim> &node,
                     const VectorType       &u,
                     const double            bound)
  {
    const auto T = expected_projector<dim>(node, slip);
    const auto v = to_eigen<dim>(slip_of<dim>(node, u));
    const auto n = to_eigen<dim>(node.normal());
    const auto I = Eigen::Matrix<double, dim, dim>::Identity();
    return T * (I - n * n.transpose() - v * v.transpose() / v.squaredNorm()) *
      T * (bound / v.norm());
  }



  template <int dim>
  VectorType
  linearized_residual(const RandomProblem<dim> &problem,
                      const Linearization<dim> &linearization,
                      const VectorType         &u,
                      const ContactState       &state)
  {
    VectorType   v(u), r(u);
    ContactState present(state);
    Iterate      x(v, present);
    x.residual.reinit(u);
    problem.discretization.stiffness().residual(
      x.residual, problem.discretization.loads(), u);
    linearization.linearize_residual(r, x);
    return r;
  }



  template <int dim>
  void
  update(Linearization<dim> &linearization,
         const VectorType   &u,
         const ContactState &state)
  {
    VectorType   v(u);
    ContactState present(state);
    linearization.update(Iterate(v, present));
  }



  // H v.
  template <int dim>
  VectorType
  second_derivative(const RandomProblem<dim> &problem,
                    const Truncation<dim>    &truncation,
                    const VectorType         &v)
  {
    VectorType Hv = problem.leaf_vector();
    problem.matrix().vmult(Hv.begin(), v.begin());
    for (unsigned int i = 0; i < problem.constraints().n_owned_nodes(); ++i)
      {
        const auto more =
          times<dim>(truncation.curvature(i).data(), v.begin() + dim * i);
        for (unsigned int d = 0; d < dim; ++d)
          Hv.local_element(dim * i + d) += more[d];
      }
    truncation.apply(Hv.begin());
    return Hv;
  }



  // Sums of what is left out by the expansions of first and second order of
  // the energy, and of zeroth and first order of the residual, at three h each
  // of which is half of the one before.
  struct Remainders
  {
    std::array<double, 3> first = {}, second = {}, zeroth = {}, linear = {};

    static double
    order(const std::array<double, 3> &sums)
    {
      return std::min(std::log2(sums[0] / sums[1]),
                      std::log2(sums[1] / sums[2]));
    }
  };



  template <int dim>
  void
  add_remainders(Remainders               &sums,
                 const RandomProblem<dim> &problem,
                 const Linearization<dim> &linearization,
                 const Sample             &it,
                 Random                   &random)
  {
    const TrescaFunctional<dim> functional(problem.discretization.problem());
    const VectorType            r =
      linearized_residual<dim>(problem, linearization, it.u, it.state);
    VectorType v(r);
    for (auto &value : v)
      value = random(-1., 1.);
    linearization.truncation().apply(v.begin());
    double h = 1.;
    for (const auto &node : problem.contact())
      {
        const double u_t = slip_of<dim>(node, it.u).norm(),
                     v_t = slip_of<dim>(node, v).norm();
        if (u_t != 0. && v_t != 0.)
          h = std::min(h, .3 * u_t / v_t);
      }
    const VectorType Hv =
      second_derivative<dim>(problem, linearization.truncation(), v);
    const double energy = functional.energy(it.u, it.state);
    for (unsigned int i = 0; i < 3; ++i, h *= .5)
      {
        VectorType w(it.u);
        w.add(h, v);
        const double difference =
          functional.energy(w, it.state) - energy + h * (r * v);
        sums.first[i] += std::abs(difference);
        sums.second[i] += std::abs(difference - .5 * h * h * (v * Hv));
        VectorType change =
          linearized_residual<dim>(problem, linearization, w, it.state);
        change -= r;
        sums.zeroth[i] += change.l2_norm();
        change.add(h, Hv);
        sums.linear[i] += change.l2_norm();
      }
  }



  template <int dim>
  void
  test_derivatives(const RandomProblem<dim> &problem, Random &random)
  {
    const auto                &contact  = problem.contact();
    const std::string          F        = "omega'': ";
    const DiscreteProblem<dim> discrete = problem.friction_problem(friction);

    std::vector<unsigned int> n_of_phase(n_phases, 0);
    double       projectors = 0, held = 0, truncated = 0, formula = 0;
    double       outside = 0, asymmetric = 0, smallest = 0, second_largest = 0;
    bool         curvature_elsewhere = false, free_bits = true;
    unsigned int n_curved = 0, n_curved_masters = 0, n_held_masters = 0;
    Remainders   with, without;
    for (unsigned int sample = 0; sample < 30; ++sample)
      {
        const Sample it   = make_sample<dim>(problem, random);
        const auto   make = [&](const TruncationVariant variant) {
          Linearization<dim> result(discrete, variant);
          update(result, it.u, it.state);
          return result;
        };
        const Linearization<dim>
          linearization = make(TruncationVariant::phases),
          all_contact   = make(TruncationVariant::contact),
          flat          = make(TruncationVariant::phases_without_second_order);

        // The table of phases, and omega''.
        double     n_held = 0;
        const auto curved = [&](const unsigned int p) {
          return it.phases[p] == slip || it.phases[p] == open_slip;
        };
        for (unsigned int p = 0; p < contact.size(); ++p)
          {
            const auto &node  = contact[p];
            const Phase phase = it.phases[p];
            const auto  T     = expected_projector<dim>(node, phase);
            using Matrix      = Eigen::Matrix<double, dim, dim>;
            ++n_of_phase[phase];
            n_held +=
              (phase < slip ? 0. : 1.) + (is_held(phase) ? dim - 1. : 0.);
            const auto difference = [&](const Linearization<dim> &l,
                                        const Matrix             &expected) {
              return (to_matrix<dim>(l.truncation().projector(node.node)) -
                      expected)
                .cwiseAbs()
                .maxCoeff();
            };
            projectors = std::max(
              {projectors,
               difference(linearization, T),
               difference(flat, T),
               difference(all_contact, phase < slip ? T : Matrix(0. * T))});
            if (phase < open_stick && node.n_free_tangents == dim - 1)
              free_bits = free_bits &&
                linearization.truncation().projector(node.node) ==
                  identity_block<dim>();

            const auto omega =
              to_matrix<dim>(linearization.truncation().curvature(node.node));
            curvature_elsewhere = curvature_elsewhere ||
              (!(dim == 3 && curved(p)) && omega.norm() != 0.) ||
              to_matrix<dim>(flat.truncation().curvature(node.node)).norm() !=
                0. ||
              to_matrix<dim>(all_contact.truncation().curvature(node.node)) !=
                (phase < slip ? omega : Matrix(0. * omega));
            if (dim == 3 && curved(p))
              {
                const auto expected = expected_curvature<dim>(
                  node, it.u, friction * it.state.normal_force(p));
                const double size = expected.norm();
                ++n_curved;
                formula = std::max(formula, (omega - expected).norm() / size);
                outside =
                  std::max(outside, (T * omega * T - omega).norm() / size);
                asymmetric =
                  std::max(asymmetric,
                           (omega - Matrix(omega.transpose())).norm() / size);
                const Eigen::VectorXd values = eigenvalues(omega);
                smallest = std::max(smallest, -values(0) / size);
                second_largest =
                  std::max(second_largest, values(dim - 2) / size);
              }
          }
        held = std::max(
          held,
          std::abs(linearization.truncation().n_truncated_components() -
                   n_held));
        n_curved_masters += problem.n_hanging_at_contact(curved);
        n_held_masters += problem.n_hanging_at_contact(
          [&](const unsigned int p) { return it.phases[p] == stick; });

        VectorType r =
          linearized_residual<dim>(problem, linearization, it.u, it.state);
        VectorType again(r);
        linearization.truncation().apply(again.begin());
        again -= r;
        truncated = std::max(truncated, again.linfty_norm() / r.linfty_norm());
        for (unsigned int direction = 0; direction < 3; ++direction)
          {
            add_remainders<dim>(with, problem, linearization, it, random);
            add_remainders<dim>(without, problem, flat, it, random);
          }
      }

    check(*std::min_element(n_of_phase.begin(), n_of_phase.end()) > 20,
          "every phase occurs");
    check((n_curved_masters > 0 && n_held_masters > 0) == (dim == 3),
          "nodes hang at sliding and at sticking nodes in 3D, and not in 2D");
    check_below(projectors, 1e-14, "free subspaces of the phases");
    check(free_bits, "the identity to the last bit where everything is free");
    check_below(held, 1e-12, "the number of truncated components");
    check_below(truncated, 1e-15, "the linearised residual is truncated");
    check(!curvature_elsewhere,
          dim == 2 ? "in 2D friction has no second derivative"
                   : "omega'' only where it slides, and not if not wanted");
    if (dim == 2)
      {
        check_below(with.second[0] / with.first[0],
                    1e-9,
                    "first and second derivative of the energy");
        check_below(with.linear[0] / with.zeroth[0],
                    1e-10,
                    "the derivative of the residual");
        return;
      }
    check(n_curved > 100, F + "at many nodes");
    check_below(formula, 1e-14, F + "F tau (I - v v^T / |v|^2) / |v|");
    check_below(outside, 1e-14, F + "on the free subspace");
    check_below(asymmetric, 1e-15, F + "symmetric");
    check_below(smallest, 1e-15, F + "positive semidefinite");
    check_below(second_largest, 1e-15, F + "of rank one");
    check(Remainders::order(with.first) > 1.9, "energy: first derivative");
    check(Remainders::order(with.second) > 2.9, "energy: second derivative");
    check(Remainders::order(with.zeroth) > .9 &&
            Remainders::order(with.linear) > 1.9,
          "residual: derivative");
    check(std::abs(Remainders::order(without.second) - 2) < .1 &&
            std::abs(Remainders::order(without.linear) - 1) < .1,
          "without omega'' they are less accurate by one order");
  }



  // Before a second correction: the nodes that the first one would have reverse
  // their slip come to rest, are held there, and what is left of the residual
  // is that of the linearised problem.
  template <int dim>
  void
  test_second_correction(const RandomProblem<dim> &problem, Random &random)
  {
    const auto                 &contact  = problem.contact();
    const DiscreteProblem<dim>  discrete = problem.friction_problem(friction);
    const TrescaFunctional<dim> functional(discrete);

    // The same forces without friction: slip is free to reverse.
    const DiscreteProblem<dim>  frictionless = problem.friction_problem(0.);
    const TrescaFunctional<dim> smooth(frictionless);

    bool         found = true, held = true, elsewhere = true, free = true;
    unsigned int n_reversing = 0, n_others = 0;
    double       slip_left = 0, defect_error = 0, moved = 0;
    for (unsigned int sample = 0; sample < 10; ++sample)
      {
        Sample             it = make_sample<dim>(problem, random);
        Linearization<dim> linearization(discrete, TruncationVariant::phases);
        update(linearization, it.u, it.state);
        const Truncation<dim> before = linearization.truncation();
        const VectorType      r =
          linearized_residual<dim>(problem, linearization, it.u, it.state);
        VectorType v = problem.leaf_vector();
        for (auto &value : v)
          value = random(-.2, .2);
        before.apply(v.begin());

        const std::vector<unsigned int> reversing =
          functional.reversing_nodes(v, it.u, it.state);
        free = free && smooth.reversing_nodes(v, it.u, it.state).empty();
        VectorType moved_to(it.u);
        moved_to += v;
        const VectorType first = v;
        functional.stop(v, it.u, reversing);
        VectorType stopped(it.u);
        stopped += v;
        linearization.hold(reversing, Iterate(it.u, it.state));
        for (unsigned int p = 0; p < contact.size(); ++p)
          {
            const auto &node = contact[p];
            const bool  slides =
              it.phases[p] == slip || it.phases[p] == open_slip;
            const auto slip_before = slip_of<dim>(node, it.u);
            const bool reverses    = slides && node.n_free_tangents > 0 &&
              slip_of<dim>(node, moved_to) * slip_before < 0;
            const bool listed =
              std::find(reversing.begin(), reversing.end(), p) !=
              reversing.end();
            found             = found && reverses == listed;
            const auto &after = linearization.truncation();
            if (listed)
              {
                ++n_reversing;
                slip_left = std::max(
                  slip_left,
                  std::abs(slip_of<dim>(node, stopped) * slip_before) /
                    (slip_before.norm() *
                     (slip_of<dim>(node, moved_to) - slip_before).norm()));
                const auto T = expected_projector<dim>(
                  node, it.phases[p] == slip ? stick : open_stick);
                held = held &&
                  (to_matrix<dim>(after.projector(node.node)) - T)
                      .cwiseAbs()
                      .maxCoeff() < 1e-14 &&
                  after.curvature(node.node) == zero_block<dim>();
              }
            else
              {
                ++n_others;
                elsewhere = elsewhere && after.agrees(before, node.node);
                for (unsigned int d = 0; d < dim; ++d)
                  moved = std::max(moved,
                                   std::abs(v(dim * node.node + d) -
                                            first(dim * node.node + d)));
              }
          }

        VectorType defect(r);
        linearization.linearized_defect(defect, r, v);
        VectorType expected(r);
        linearization.truncation().apply(expected.begin());
        const double size = expected.linfty_norm();
        expected -=
          second_derivative<dim>(problem, linearization.truncation(), v);
        expected -= defect;
        defect_error = std::max(defect_error, expected.linfty_norm() / size);
      }
    check(n_reversing > 10 && n_others > 10, "some nodes reverse their slip");
    check(found, "they are the ones that are found");
    check(free, "none has to stop where there is no friction");
    check_below(slip_left, 1e-13, "they come to rest");
    check(held, "and are held there");
    check(elsewhere && moved == 0, "others are left alone");
    check_below(defect_error, 1e-13, "the defect of the first correction");
  }



  template <int dim>
  void
  test_bounds(const RandomProblem<dim> &problem, Random &random)
  {
    const auto                 &contact     = problem.contact();
    const auto                 &constraints = problem.constraints();
    const TrescaFunctional<dim> functional(problem.discretization.problem());
    const DiscreteProblem<dim>  discrete = problem.friction_problem(friction);
    Linearization<dim> linearization(discrete, TruncationVariant::phases);
    double             prescribed = 0, penetration = -infinity, reversed = 0;
    bool               zero_inside = true, still = true;
    unsigned int       n_at_bound = 0, n_stopped = 0;
    for (unsigned int sample = 0; sample < 30; ++sample)
      {
        const Sample it = make_sample<dim>(problem, random);
        update(linearization, it.u, it.state);
        VectorType lower(it.u), upper(it.u);
        {
          VectorType   u(it.u);
          ContactState state(it.state);
          linearization.bounds(lower, upper, Iterate(u, state));
        }
        for (unsigned int i = 0; i < lower.locally_owned_size(); ++i)
          zero_inside = zero_inside && lower.local_element(i) <= 0. &&
            upper.local_element(i) >= 0.;
        for (unsigned int attempt = 0; attempt < 20; ++attempt)
          {
            // Any point of the box, its corners among them; all the way back
            // now and then.
            VectorType v(it.u);
            const bool all_corners = attempt < 3;
            for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
              {
                const double lo     = std::max(lower.local_element(i), -1.);
                const double up     = std::min(upper.local_element(i), 1.);
                const bool   corner = all_corners || random.chance(.5);
                v.local_element(i)  = corner ? (random.chance(.5) ? lo : up)
                                             : random(0., 1.) * (up - lo) + lo;
                if (all_corners && attempt > 0)
                  v.local_element(i) =
                    -lower.local_element(i) < upper.local_element(i) ? lo : up;
              }
            linearization.truncation().apply(v.begin());
            v += it.u;
            penetration =
              std::max(penetration, functional.largest_penetration(v));
            for (unsigned int p = 0; p < contact.size(); ++p)
              {
                n_at_bound +=
                  normal_component(contact[p], v) > contact[p].gap - 1e-12 &&
                  !it.state.in_contact(p);
                const Tensor<1, dim> before = slip_of<dim>(contact[p], it.u),
                                     after  = slip_of<dim>(contact[p], v);
                if (it.state.sticks(p))
                  still = still && after.norm() < 1e-14;
                else if (it.state.normal_force(p) > 0)
                  {
                    const double along = after * before / before.norm();
                    reversed           = std::max(reversed, -along);
                    n_stopped += along < 1e-12;
                  }
              }
            for (unsigned int i = 0; i < constraints.n_owned_nodes(); ++i)
              for (unsigned int d = 0; d < dim; ++d)
                if (constraints.is_prescribed(i, d))
                  prescribed =
                    std::max(prescribed,
                             std::abs(v.local_element(dim * i + d) -
                                      it.u.local_element(dim * i + d)));
          }
      }
    check(zero_inside, "no correction is within bounds");
    check_below(penetration, 1e-14, "within bounds nothing penetrates");
    check_below(reversed, 1e-14, "nor does slip turn back");
    check(still, "what sticks stays where it is");
    check_below(prescribed, 0., "prescribed components stay");
    check(n_at_bound > 50 && n_stopped > 50, "both bounds can be reached");
  }



  // When omega'' is computed anew, and its cutoff. Only in 3D, at a node in
  // contact that slides.
  void
  test_refresh(const RandomProblem<3> &problem, Random &random)
  {
    const auto  &contact = problem.contact();
    const Sample it      = make_sample<3>(problem, random);
    unsigned int p       = 0;
    while (it.phases[p] != slip || contact[p].n_free_tangents < 2)
      ++p;
    const ContactNode<3> &node      = contact[p];
    const Tensor<1, 3>    original  = slip_of<3>(node, it.u);
    const Tensor<1, 3>    direction = original / original.norm();
    const Tensor<1, 3>    across = cross_product_3d(node.normal(), direction);
    const double          stiffness =
      trace<3>(problem.matrix().diagonal(node.node)) / 3.;

    // A slip so small that omega'' is far larger than the stiffness, and is
    // compared with itself alone.
    const double       bound = friction * it.state.normal_force(p);
    const Tensor<1, 3> start = bound / (1e6 * stiffness) * direction;

    // The curvature for a slip at that node, by an object that may remember.
    const DiscreteProblem<3> discrete = problem.friction_problem(friction);
    VectorType               u(it.u);
    ContactState             state(it.state);
    const auto               make = [&]() {
      return Linearization<3>(discrete, TruncationVariant::phases);
    };
    const auto curvature = [&](Linearization<3>   &linearization,
                               const Tensor<1, 3> &slip) {
      u = it.u;
      shift<3>(u, node, slip - original);
      update(linearization, u, state);
      return to_matrix<3>(linearization.truncation().curvature(node.node));
    };
    const auto fresh = [&](const Tensor<1, 3> &slip) {
      Linearization<3> linearization = make();
      return curvature(linearization, slip);
    };
    const auto turned = [&](const double angle) {
      return std::cos(angle) * start + std::sin(angle) * start.norm() * across;
    };

    // A slip of (1+c)|v| is a change by c/(1+c), of (1+c) omega'', that is; a
    // turn by a small angle one by sqrt(2) times that angle.
    bool kept = true, replaced = true;
    for (const Tensor<1, 3> &slip :
         {1.09 * start, .92 * start, turned(.065), turned(-.065)})
      {
        Linearization<3> linearization = make();
        const auto       first         = curvature(linearization, start);
        kept = kept && first.norm() > 0 && first != fresh(slip) &&
          curvature(linearization, slip) == first;
      }
    for (const Tensor<1, 3> &slip :
         {1.12 * start, .89 * start, turned(.075), turned(-.075), -2. * start})
      {
        Linearization<3> linearization = make();
        curvature(linearization, start);
        replaced = replaced && curvature(linearization, slip) == fresh(slip);
      }
    check(kept, "omega'' is kept if it changes by less than 10 %");
    check(replaced, "computed anew if it changes by more");

    // A slip so large that turning it costs hardly anything compared with the
    // stiffness that omega'' is added to.
    {
      const Tensor<1, 3> large         = bound / (1e-3 * stiffness) * direction;
      Linearization<3>   linearization = make();
      const auto         first         = curvature(linearization, large);
      check(curvature(linearization, 2. * large) == first &&
              curvature(linearization, start) == fresh(start),
            "kept while it is small compared with the stiffness");
    }

    // Small changes one after the other.
    Linearization<3> linearization = make();
    double           deviation     = 0;
    unsigned int     n_kept = 0, n_replaced = 0;
    auto             last = curvature(linearization, start);
    for (unsigned int step = 1; step <= 50; ++step)
      {
        const Tensor<1, 3> slip = std::pow(1.01, step) * turned(.02 * step);
        const auto now = curvature(linearization, slip), exact = fresh(slip);
        deviation = std::max(deviation, (now - exact).norm() / exact.norm());
        (now == last ? n_kept : n_replaced)++;
        last = now;
      }
    check(n_kept > n_replaced && n_replaced > 5 && deviation <= .1 + 1e-12,
          "small changes do not add up to large ones");

    // A change of phase is always noticed.
    Linearization<3> attentive = make();
    const auto       before    = curvature(attentive, start);
    state.set(p, false, false);
    const auto opened = curvature(attentive, 1.01 * start);
    state.set_normal_force(p, 0.);
    const auto without_force = curvature(attentive, start);
    state.set_normal_force(p, it.state.normal_force(p));
    state.set(p, true, true);
    const auto sticking = curvature(attentive, Tensor<1, 3>());
    check(before != opened && opened.norm() > 0 && without_force.norm() == 0 &&
            sticking.norm() == 0,
          "a change of phase is always noticed");

    // Hardly any slip, and none at all.
    state                = it.state;
    const double largest = 1e8 * stiffness;
    double       cutoff = 0, below = 0;
    for (const double size : {1e-12, 1e-20, 1e-100, 0.})
      {
        u = it.u;
        for (unsigned int d = 0; d < 3; ++d)
          u.local_element(3 * node.node + d) = size * across[d];
        Linearization<3> l = make();
        update(l, u, state);
        const double omega =
          to_matrix<3>(l.truncation().curvature(node.node)).norm();
        const double expected = size == 0.
          ? 0.
          : std::min(largest,
                     friction * state.normal_force(p) /
                       slip_of<3>(node, u).norm());
        below                 = std::max(below, omega / largest);
        cutoff = std::max(cutoff, std::abs(omega - expected) / largest);
      }
    check_below(
      cutoff, 1e-13, "cut off where the slip is tiny, zero if there is none");
    check(below > .999 && below < 1.001, "cut off at 1e8 times the stiffness");
  }



  void
  test_refresh(const RandomProblem<2> &, Random &)
  {}



  template <int dim>
  void
  test(const Parameters &parameters, const std::string &what)
  {
    Random                   random(dim == 2 ? 1 : 3);
    const RandomProblem<dim> problem(parameters, 3, dim == 2 ? .6 : .3, random);
    unsigned int             n_fewer = 0;
    for (const auto &node : problem.contact())
      n_fewer += node.n_free_tangents < dim - 1;
    std::cout << dim << "D, " << what << ", " << problem.contact().size()
              << " contact nodes, " << n_fewer << " with a prescribed tangent"
              << std::endl;
    test_derivatives<dim>(problem, random);
    test_bounds<dim>(problem, random);
    test_second_correction<dim>(problem, random);
    test_refresh(problem, random);
  }
} // namespace test_linearization

TEST(linearization)
{
  const auto law = FrictionLaw::coulomb;

  test<2>(block_parameters<2>(law, friction), "normals along y");
  test<3>(block_parameters<3>(law, friction), "normals along z");

  // Held or pushed sideways on the left, so that some contact nodes have one
  // tangent less.
  Parameters held = block_parameters<2>(law, friction);
  held.boundary_conditions.displacement.push_back({"0", {"0", "free"}});
  test<2>(held, "a prescribed tangent");
  held = block_parameters<3>(law, friction);
  held.boundary_conditions.displacement.push_back(
    {"0", {"0.05", "free", "free"}});
  test<3>(held, "a prescribed tangent");

  test<2>(curved_parameters<2>(law, friction), "normals of a disc");
  test<3>(curved_parameters<3>(law, friction), "normals of a rod");
}

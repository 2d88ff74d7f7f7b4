// The constrained Newton linearisation: for states in which every phase occurs,
// the free subspace of each contact node is that of its phase; on it, the
// linearised residual is minus the derivative of the energy at given friction
// bounds; and the bounds of the monotone correction contain zero, and keep any
// correction within them admissible and free of changes of phase.
//
// The energy is quadratic as long as no node changes its direction of slip, so
// that a central difference is the derivative, up to rounding.

#include <common/multigrid/linearization.h>
#include <common/solvers/tresca_functional.h>

#include <iostream>
#include <limits>

#include <tests/support/random_problem.h>

using namespace Tests;

namespace
{
  constexpr int    dim      = 2;
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

  struct Iterate
  {
    VectorType         u;
    ContactState       state;
    std::vector<Phase> phases;
  };



  Iterate
  make_iterate(const RandomProblem<dim> &problem, Random &random)
  {
    const auto &contact = problem.contact();
    Iterate it{problem.leaf_vector(), ContactState(contact.size(), true), {}};
    for (auto &value : it.u)
      value = random(-.1, .1);
    problem.constraints().impose(it.u);
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const auto  &node    = contact[p];
        const Phase  phase   = static_cast<Phase>(random.below(n_phases));
        const bool   touches = phase >= slip;
        const double u_n     = node.gap - (touches ? 0. : random(.01, .1));
        // Where the tangential displacement is prescribed it stays.
        const bool   held  = phase == stick || phase == open_stick;
        const bool   fixed = node.n_free_tangents == 0;
        const double u_t =
          held ? 0. : tangential_components<dim>(node, it.u)[0];
        it.phases.push_back(phase);
        it.state.set(p, touches, held && !fixed);
        it.state.set_normal_force(
          p, phase == open || phase == smooth ? 0. : random(.1, 1.));
        if (fixed)
          it.u.local_element(dim * node.node + 1) = u_n * node.normal()[1];
        else
          for (unsigned int d = 0; d < dim; ++d)
            it.u.local_element(dim * node.node + d) =
              u_n * node.normal()[d] + u_t * node.frame[1][d];
      }
    return it;
  }



  void
  test(const Parameters &parameters, const std::string &what)
  {
    Random                      random(1);
    const RandomProblem<dim>    problem(parameters, 3, .6, random);
    const auto                 &contact     = problem.contact();
    const auto                 &constraints = problem.constraints();
    const TrescaFunctional<dim> functional(problem.discretization->problem());
    std::vector<unsigned int>   n_of_phase(n_phases, 0);

    double projectors = 0, held = 0, derivative = 0, truncated = 0,
           prescribed = 0, penetration = -infinity;
    bool         zero_inside = true, curvature = false, keeps_sign = true;
    unsigned int n_at_bound = 0;

    const NodeBlockMatrix<dim> &matrix = problem.discretization->matrix;
    Linearization<dim>          linearization(
      matrix, constraints, contact, friction, TruncationVariant::phases);
    Linearization<dim> all_contact(
      matrix, constraints, contact, friction, TruncationVariant::contact);
    for (unsigned int sample = 0; sample < 30; ++sample)
      {
        const Iterate it = make_iterate(problem, random);
        linearization.update(it.u, it.state);
        all_contact.update(it.u, it.state);

        // The table of phases.
        double n_held = 0;
        for (unsigned int p = 0; p < contact.size(); ++p)
          {
            const auto &node  = contact[p];
            const Phase phase = it.phases[p];
            ++n_of_phase[phase];
            const bool   has_tangent = node.n_free_tangents > 0;
            const double n           = phase < slip ? 1. : 0.;
            const double t =
              has_tangent && phase != stick && phase != open_stick ? 1. : 0.;
            n_held += (has_tangent ? 2. : 1.) - n - t;
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int r = 0; r < dim; ++r)
                {
                  const double nn = node.normal()[r] * node.normal()[c];
                  const double tt = node.frame[1][r] * node.frame[1][c];
                  projectors =
                    std::max({projectors,
                              std::abs(linearization.truncation().projector(
                                         node.node)[c * dim + r] -
                                       n * nn - t * tt),
                              std::abs(all_contact.truncation().projector(
                                         node.node)[c * dim + r] -
                                       (phase < slip ? n * nn + t * tt : 0.))});
                  curvature = curvature ||
                    linearization.truncation().curvature(
                      node.node)[c * dim + r] != 0.;
                }
          }
        held = std::max(
          held,
          std::abs(linearization.truncation().n_truncated_components() -
                   n_held));

        // The derivative along random free directions.
        VectorType r = problem.leaf_vector();
        problem.matrix().residual(
          r.begin(), problem.discretization->forces.begin(), it.u.begin());
        linearization.linearize_residual(r, it.u, it.state);
        VectorType again(r);
        linearization.truncation().apply(again.begin());
        again -= r;
        truncated = std::max(truncated, again.linfty_norm() / r.linfty_norm());
        for (unsigned int direction = 0; direction < 3; ++direction)
          {
            VectorType v(r);
            for (auto &value : v)
              value = random(-1., 1.);
            linearization.truncation().apply(v.begin());
            double step = 1.;
            for (const auto &node : contact)
              {
                const double u_t = tangential_components<dim>(node, it.u)[0];
                const double v_t = tangential_components<dim>(node, v)[0];
                if (u_t != 0. && v_t != 0.)
                  step = std::min(step, .5 * std::abs(u_t / v_t));
              }
            VectorType plus(it.u), minus(it.u);
            plus.add(step, v);
            minus.add(-step, v);
            const double difference = (functional.energy(plus, it.state) -
                                       functional.energy(minus, it.state)) /
              (2 * step);
            derivative = std::max(derivative,
                                  std::abs(difference + r * v) /
                                    (1. + std::abs(difference)) * step);
          }

        // Bounds: zero is inside; anything inside is harmless.
        VectorType lower(r), upper(r);
        linearization.bounds(lower, upper, it.u, it.state);
        for (unsigned int i = 0; i < lower.locally_owned_size(); ++i)
          zero_inside = zero_inside && lower.local_element(i) <= 0. &&
            upper.local_element(i) >= 0.;
        for (unsigned int attempt = 0; attempt < 20; ++attempt)
          {
            // Any point of the box, its corners among them.
            VectorType v(r);
            for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
              {
                const double lo     = std::max(lower.local_element(i), -1.);
                const double up     = std::min(upper.local_element(i), 1.);
                const bool   corner = random.chance(.5);
                v.local_element(i)  = corner ? (random.chance(.5) ? lo : up)
                                             : random(0., 1.) * (up - lo) + lo;
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
                if (it.state.normal_force(p) > 0)
                  {
                    const double before =
                      tangential_components<dim>(contact[p], it.u)[0];
                    const double after =
                      tangential_components<dim>(contact[p], v)[0];
                    keeps_sign =
                      keeps_sign && after * std::copysign(1., before) > -1e-14;
                    if (it.state.sticks(p))
                      keeps_sign = keeps_sign && std::abs(after) < 1e-14;
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

    std::cout << what << ", " << contact.size() << " contact nodes"
              << std::endl;
    check(*std::min_element(n_of_phase.begin(), n_of_phase.end()) > 20,
          "every phase occurs");
    check_below(projectors, 1e-15, "free subspaces of the phases");
    check_below(held, 1e-12, "the number of truncated components");
    check(!curvature, "in 2D friction has no second derivative");
    check_below(truncated, 1e-15, "the linearised residual is truncated");
    check_below(derivative, 1e-12, "it is minus the derivative of the energy");
    check(zero_inside, "no correction is within bounds");
    check_below(penetration, 1e-14, "within bounds nothing penetrates");
    check(keeps_sign, "within bounds no slip is reversed, and stick sticks");
    check_below(prescribed, 0., "prescribed components stay");
    check(n_at_bound > 50, "the obstacle can be reached");
  }
} // namespace

int
main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  test(block_parameters<dim>(FrictionLaw::coulomb, friction),
       "normals along y");

  // Held sideways on the left, so that one contact node has no free tangent.
  Parameters parameters = block_parameters<dim>(FrictionLaw::coulomb, friction);
  parameters.boundary_conditions.displacement.push_back({"0", {"0", "free"}});
  test(parameters, "a prescribed tangent");

  // The half disc: normals in all directions.
  Parameters disc;
  disc.scene.geometry               = GeometryKind::half_disc;
  disc.scene.radius                 = 1.;
  disc.obstacle.kind                = ObstacleKind::plane;
  disc.obstacle.point               = {0., -1.1};
  disc.obstacle.normal              = {0., -1.};
  disc.contact.boundary_id          = 0;
  disc.contact.friction_law         = FrictionLaw::coulomb;
  disc.contact.friction_coefficient = friction;
  disc.boundary_conditions.displacement.push_back({"1", {"0", "-0.1"}});
  test(disc, "radial normals");
}

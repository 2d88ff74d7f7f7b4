// With given friction bounds (Tresca) the energy must not increase in any part
// of the iteration, and all iterates must be admissible: on meshes with hanging
// nodes, from random starts, for both coarse corrections and both cycles.
//
// The monotone correction takes no look at the energy: it minimises a quadratic
// model within bounds. In 2D the energy is that model. In 3D it is not, since
// the slip may turn: a turn costs less than the model says where the slip gets
// longer at the same time, more where it gets shorter. That the energy does not
// increase is no theorem there, but it was not found to in any of 1400
// corrections from iterates near and far from the solution, with bounds of
// friction from a tenth to a hundred times those of equilibrium; so it is asked
// for. What the model says is looked at besides.

#include <common/algorithms/nested_iteration.h>
#include <common/iteration/monotone_correction.h>

#include <iostream>

#include <tests/support/check.h>

#include "../support/random_problem.h"
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_monotonicity
{
  // Energies are compared up to the rounding of their evaluation, a sum over
  // all nodes.
  constexpr double rounding = 1e-12;



  /**
   * A Tresca problem: a scene on a locally refined mesh, with normal forces
   * like those of its Coulomb solution, but disturbed, and not zero at nodes
   * that are open, so that all phases occur.
   */
  template <int dim>
  class TrescaProblem
  {
  public:
    TrescaProblem(const Parameters  &parameters,
                  const unsigned int refinements,
                  const unsigned int adaptive_refinements)
      : random(17)
      , parameters(parameters)
      , scene(parameters)
      , mesh(make_triangulation<dim>())
      , discretization(scene, *mesh)
    {
      scene.make_coarse_mesh(*mesh);
      mesh->refine_global(refinements);
      for (unsigned int step = 0; step < adaptive_refinements; ++step)
        {
          // Towards the middle of the contact boundary, and here and there.
          unsigned int n = 0;
          for (const auto &cell : mesh->active_cell_iterators())
            {
              for (const unsigned int f : cell->face_indices())
                if (cell->at_boundary(f) &&
                    cell->face(f)->boundary_id() ==
                      scene.contact_conditions()[0].boundary_id &&
                    std::abs(
                      cell->face(f)->center()[0] -
                      (parameters.scene.geometry == GeometryKind::rectangle
                         ? 0.4
                         : 0.)) < 0.3 / (1 << step))
                  cell->set_refine_flag();
              if (++n % 23 == 5)
                cell->set_refine_flag();
            }
          mesh->execute_coarsening_and_refinement();
        }
      discretization.set_up();
      discretization.assemble(elasticity<dim>(scene.materials()));

      VectorType         u = admissible_start(discretization);
      ContactState       state(discretization.contact().size(), true);
      ContactSolver<dim> solver(discretization,
                                without_safeguards(parameters.solver));
      converged      = solver.solve(u, state).converged;
      length         = u.linfty_norm();
      double largest = 0;
      for (unsigned int p = 0; p < state.size(); ++p)
        largest = std::max(largest, state.normal_force(p));
      for (unsigned int p = 0; p < state.size(); ++p)
        normal_forces.push_back(state.normal_force(p) * random(0.5, 1.5) +
                                (p % 3 == 0 ? largest * random(0, 0.02) : 0));
    }

    DiscreteProblem<dim>
    problem() const
    {
      DiscreteProblem<dim> result = discretization.problem();
      result.friction_law         = FrictionLaw::tresca;
      return result;
    }

    ContactState
    initial_state() const
    {
      ContactState state(discretization.contact().size(), true);
      for (unsigned int p = 0; p < state.size(); ++p)
        state.set_normal_force(p, normal_forces[p]);
      return state;
    }

    /** Random at all components that are free, zero elsewhere. */
    VectorType
    random_direction()
    {
      const NodalConstraints<dim> &constraints = discretization.constraints();
      VectorType                   v(constraints.partitioner());
      for (unsigned int node = 0; node < constraints.n_owned_nodes(); ++node)
        for (unsigned int c = 0; c < dim; ++c)
          if (!constraints.is_hanging(node) &&
              !constraints.is_prescribed(node, c))
            v.local_element(dim * node + c) = random(-1, 1);
      return v;
    }

    /** Random, but admissible; some contact nodes touch. */
    VectorType
    random_start()
    {
      VectorType u = admissible_start(discretization);
      u.add(0.3 * length, random_direction());
      for (const ContactNode<dim> &node : discretization.contact())
        move_out_of_obstacle(node, u);
      return u;
    }

    /** Hanging nodes of the contact boundary, one of whose masters is in
     * contact and sticks, or does not. */
    unsigned int
    n_hanging_at_contact(const ContactState &state, const bool sticks) const
    {
      return Tests::n_hanging_at_contact<dim>(
        discretization,
        scene.contact_conditions()[0].boundary_id,
        [&](const unsigned int p) {
          return state.in_contact(p) && state.sticks(p) == sticks;
        });
    }

    VectorType
    residual(const VectorType &u) const
    {
      VectorType r(u);
      discretization.stiffness().residual(r, discretization.loads(), u);
      return r;
    }

    VectorType
    product(const VectorType &v) const
    {
      VectorType Av(v);
      discretization.stiffness().vmult(Av, v);
      return Av;
    }

    Random                              random;
    const Parameters                    parameters;
    const Scene<dim>                    scene;
    std::unique_ptr<Triangulation<dim>> mesh;
    Discretization<dim>                 discretization;
    bool                                converged = false;
    double                              length    = 0;
    std::vector<double>                 normal_forces;
  };



  template <int dim>
  Tensor<1, dim - 1>
  slip_of(const ContactNode<dim> &node, const VectorType &u)
  {
    const auto         u_T = tangential_components<dim>(node, u);
    Tensor<1, dim - 1> result;
    for (unsigned int t = 0; t < dim - 1; ++t)
      result[t] = u_T[t];
    return result;
  }



  // v^T omega'' v, which the energy of the linearised problem has besides that
  // of the stiffness matrix.
  template <int dim>
  double
  curvature_of_friction(const Truncation<dim> &truncation, const VectorType &v)
  {
    double sum = 0;
    for (const unsigned int node : truncation.changed_nodes())
      sum += dot<dim>(
        v.begin() + dim * node,
        times<dim>(truncation.curvature(node).data(), v.begin() + dim * node)
          .data());
    return sum;
  }



  // The parts of a step, one after the other.
  template <int dim>
  void
  part_by_part(TrescaProblem<dim>    &fixture,
               const CoarseCorrection correction,
               const Cycle            cycle)
  {
    const Discretization<dim>  &d       = fixture.discretization;
    const DiscreteProblem<dim>  problem = fixture.problem();
    const TrescaFunctional<dim> functional(problem);
    const MonotoneSmoother<dim> smoother(problem);
    Linearization<dim>       linearization(problem, TruncationVariant::phases);
    Levels<dim>              levels(d.dof_handler(), problem);
    TruncatedCorrection<dim> truncated(levels, cycle, 6);
    MonotoneCorrection<dim>  monotone(levels, cycle, 6);

    double increase_in_sweeps = 0, increase_in_correction = 0,
           increase_in_model = 0, increase_in_step = 0, penetration = -1e300,
           outside_of_bounds = 0, outside_of_space = 0, disturbed = 0;
    bool         descent = true, phases_kept = true;
    unsigned int open_but_held = 0, sliding = 0, sticking = 0, open = 0;
    unsigned int hanging_at_sliding = 0, hanging_at_sticking = 0;

    for (unsigned int start = 0; start < 3; ++start)
      {
        VectorType   u      = fixture.random_start();
        ContactState state  = fixture.initial_state();
        double       energy = functional.energy(u, state);
        Iterate      x(u, state);

        const auto compare = [&](double &largest_increase) {
          const double now = functional.energy(u, state);
          largest_increase =
            std::max(largest_increase, (now - energy) / std::abs(energy));
          energy      = now;
          penetration = std::max(
            penetration, functional.largest_penetration(u) / fixture.length);
        };

        double last_smoothed = energy;
        for (unsigned int step = 0; step < 8; ++step)
          {
            for (unsigned int sweep = 0; sweep < 3; ++sweep)
              {
                smoother.relax(x, 1);
                compare(increase_in_sweeps);
              }
            increase_in_step = std::max(
              increase_in_step, (energy - last_smoothed) / std::abs(energy));
            last_smoothed = energy;
            hanging_at_sliding += fixture.n_hanging_at_contact(state, false);
            hanging_at_sticking += fixture.n_hanging_at_contact(state, true);
            for (unsigned int p = 0; p < state.size(); ++p)
              (state.in_contact(p)
                 ? (state.sticks(p) ? sticking : sliding)
                 : (state.sticks(p) ? open_but_held : open))++;

            const VectorType residual = fixture.residual(u);
            x.residual                = residual;
            linearization.update(x);
            VectorType r(residual), v(u);
            linearization.linearize_residual(r, x);

            if (correction == CoarseCorrection::monotone)
              {
                VectorType lower(u), upper(u);
                linearization.bounds(lower, upper, x);
                monotone.update(linearization, x);
                monotone.apply(v, r);

                // Bounds hold for components of nodes that are not truncated;
                // a truncated one moves within its free subspace.
                for (const ContactNode<dim> &node : d.contact())
                  if (linearization.truncation().projector(node.node) ==
                      identity_block<dim>())
                    for (unsigned int i = dim * node.node;
                         i < dim * (node.node + 1);
                         ++i)
                      outside_of_bounds = std::max(
                        {outside_of_bounds,
                         (v.local_element(i) - upper.local_element(i)) /
                           fixture.length,
                         (lower.local_element(i) - v.local_element(i)) /
                           fixture.length});

                // No sliding node may turn round.
                for (unsigned int p = 0; p < state.size(); ++p)
                  if (state.normal_force(p) > 0 && !state.sticks(p))
                    {
                      const auto before = slip_of<dim>(d.contact()[p], u);
                      const auto after =
                        before + slip_of<dim>(d.contact()[p], v);
                      phases_kept = phases_kept &&
                        after * before >=
                          -1e-13 * fixture.length * before.norm();
                    }
                descent = descent && r * v >= 0;
                increase_in_model =
                  std::max(increase_in_model,
                           (.5 *
                              (v * fixture.product(v) +
                               curvature_of_friction<dim>(
                                 linearization.truncation(), v)) -
                            r * v) /
                             std::abs(energy));
              }
            else
              {
                truncated.update(linearization, x);
                truncated.apply(v, r);
                descent = descent && (r * v > 0 || r.l2_norm() == 0);
              }
            VectorType Tv(v);
            linearization.truncation().apply(Tv.begin());
            Tv -= v;
            outside_of_space =
              std::max(outside_of_space,
                       Tv.linfty_norm() / std::max(v.linfty_norm(), 1e-300));

            if (correction == CoarseCorrection::truncated)
              {
                v *= functional.minimize_along(
                  v, x, residual * v, v * fixture.product(v), 2.);
                if (functional.project(v, u, 1.) > 0)
                  v *= functional.minimize_along(
                    v,
                    x,
                    residual * v,
                    v * fixture.product(v),
                    functional.admissible_length(v, u, 2.));
              }
            u += v;
            compare(increase_in_correction);
            for (unsigned int p = 0; p < state.size(); ++p)
              {
                const ContactNode<dim> &node = d.contact()[p];
                if (state.in_contact(p))
                  disturbed = std::max(
                    disturbed, std::abs(normal_component(node, u) - node.gap));
                if (state.sticks(p))
                  disturbed = std::max(disturbed, slip_of<dim>(node, u).norm());
              }

            for (unsigned int sweep = 0; sweep < 3; ++sweep)
              {
                smoother.relax(x, 1);
                compare(increase_in_sweeps);
              }
          }
      }

    check(open > 0 && sliding > 0 && sticking > 0 && open_but_held > 0,
          "all phases occur");
    check((hanging_at_sliding > 0 && hanging_at_sticking > 0) == (dim == 3),
          dim == 2 ? "no node hangs on the contact boundary"
                   : "nodes hang at sliding and at sticking nodes");
    check_below(increase_in_sweeps, rounding, "energy in sweeps");
    check_below(
      increase_in_correction, rounding, "energy in coarse corrections");
    check_below(increase_in_step, rounding, "energy from step to step");
    check_below(penetration, 1e-14, "admissible");
    check_below(outside_of_space, 1e-12, "corrections in the free subspace");
    check_below(disturbed / fixture.length,
                1e-14,
                "nodes in contact stay there, sticking ones stick");
    check(descent, "corrections go downhill");
    if (correction == CoarseCorrection::monotone)
      {
        check_below(increase_in_model, rounding, "energy of their model");
        check_below(outside_of_bounds, 1e-14, "within the bounds");
        check(phases_kept, "no sliding node turns round");
      }
  }



  // The iteration itself, by what it reports.
  template <int dim>
  void
  whole_iteration(TrescaProblem<dim> &fixture)
  {
    const Discretization<dim>  &d       = fixture.discretization;
    const DiscreteProblem<dim>  problem = fixture.problem();
    const TrescaFunctional<dim> functional(problem);

    double     increase = 0, penetration = -1e300, difference = 0;
    double     certificate = 0;
    bool       converged   = true;
    VectorType solution;
    for (unsigned int start = 0; start < 2; ++start)
      {
        const VectorType u_0 = fixture.random_start();
        for (const Cycle cycle : {Cycle::V, Cycle::W})
          for (unsigned int variant = 0; variant < 5; ++variant)
            {
              // The truncated correction with 0, 1, 2 recombined steps, the
              // monotone one, and truncation of all contact nodes.
              SolverSettings settings;
              settings.cycle            = cycle;
              settings.inner_tolerance  = 1e-11;
              settings.recombined_steps = variant < 3 ? variant : 1;
              if (variant == 3)
                settings.coarse_correction = CoarseCorrection::monotone;
              if (variant == 4)
                settings.truncation = TruncationVariant::contact;

              VectorType         u(u_0);
              ContactState       state = fixture.initial_state();
              ContactSolver<dim> solver(
                d.dof_handler(), problem, without_safeguards(settings));
              const double       first  = functional.energy(u, state);
              const SolverReport result = solver.solve(u, state);
              converged                 = converged && result.converged;
              double last               = first;
              for (const CycleInfo &info : result.cycles)
                {
                  increase =
                    std::max(increase, (info.energy - last) / std::abs(last));
                  last = info.energy;
                }
              increase =
                std::max(increase,
                         (functional.energy(u, state) - last) / std::abs(last));
              penetration =
                std::max(penetration,
                         functional.largest_penetration(u) / fixture.length);
              certificate = std::max(
                certificate,
                make_certificate(problem, u, fixture.residual(u), state)
                  .largest());
              for (unsigned int p = 0; p < state.size(); ++p)
                converged = converged &&
                  state.normal_force(p) == fixture.normal_forces[p];
              if (solution.size() == 0)
                solution = u;
              else
                for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
                  if (!d.constraints().is_hanging(i / dim))
                    difference = std::max(
                      difference,
                      std::abs(u.local_element(i) - solution.local_element(i)) /
                        fixture.length);
            }
      }
    check(converged, "all variants converge, given forces stay as they are");
    check_below(increase, rounding, "energy from cycle to cycle");
    check_below(penetration, 1e-14, "admissible");
    check_below(certificate, 1e-8, "certified");
    check_below(difference, 1e-8, "one solution");
  }



  // Against brute force along random lines.
  template <int dim>
  void
  line_search(TrescaProblem<dim> &fixture)
  {
    const Discretization<dim>  &d       = fixture.discretization;
    const DiscreteProblem<dim>  problem = fixture.problem();
    const TrescaFunctional<dim> functional(problem);
    ContactState                state = fixture.initial_state();

    const unsigned int n_points = 400;
    double             excess = 0, distance = 0;
    unsigned int       n_zero = 0, n_inside = 0, n_largest = 0;
    for (unsigned int line = 0; line < 30; ++line)
      {
        // Much more friction than usual, so that the kinks matter; on every
        // third line some nodes are at rest.
        for (unsigned int p = 0; p < state.size(); ++p)
          state.set_normal_force(
            p, fixture.normal_forces[p] * (line % 2 == 0 ? 1. : 1e3));
        VectorType u = fixture.random_start();
        if (line % 3 == 0)
          for (unsigned int p = 0; p < state.size(); p += 2)
            {
              const ContactNode<dim> &node = d.contact()[p];
              const auto              u_T  = slip_of<dim>(node, u);
              for (unsigned int t = 1; t < dim; ++t)
                for (unsigned int c = 0; c < dim; ++c)
                  u.local_element(dim * node.node + c) -=
                    u_T[t - 1] * node.frame[t][c];
            }
        VectorType       v = fixture.random_direction();
        const VectorType r = fixture.residual(u);
        if (line % 7 != 0)
          {
            // Downhill, with a minimum of the quadratic part at 0.1,...,2.5.
            if (r * v < 0)
              v *= -1;
            v *= (r * v) / (v * fixture.product(v)) / fixture.random(0.1, 2.5);
          }
        const double largest = 2.;
        const double length  = functional.minimize_along(
          v, Iterate(u, state), r * v, v * fixture.product(v), largest);
        n_zero += (length == 0);
        n_inside += (length > 0 && length < largest);
        n_largest += (length == largest);

        const auto energy = [&](const double alpha) {
          VectorType w(u);
          w.add(alpha, v);
          return functional.energy(w, state);
        };
        double best = 1e300, best_alpha = 0;
        for (unsigned int i = 0; i <= n_points; ++i)
          {
            const double alpha = largest * i / n_points, e = energy(alpha);
            if (e < best)
              {
                best       = e;
                best_alpha = alpha;
              }
          }
        const double found = energy(length);
        excess             = std::max(excess, (found - best) / std::abs(best));
        distance           = std::max(distance, std::abs(length - best_alpha));
        // Nor is there anything better right beside it.
        for (const double beside : {1 - 1e-4, 1 + 1e-4})
          if (length * beside <= largest)
            excess = std::max(
              excess, (found - energy(length * beside)) / std::abs(found));
      }
    check(n_zero > 0 && n_inside > 0 && n_largest > 0,
          "minima at both ends and inside");
    check_below(excess, rounding, "no smaller energy along the line");
    check_below(
      distance, 2. / n_points, "the minimiser is where a fine scan finds it");
  }



  template <int dim>
  void
  projection(TrescaProblem<dim> &fixture)
  {
    const Discretization<dim>  &d       = fixture.discretization;
    const DiscreteProblem<dim>  problem = fixture.problem();
    const TrescaFunctional<dim> functional(problem);

    double penetration = -1e300, penetration_of_length = -1e300, changed = 0;
    bool   counted = true, longest = true, at_least_one = true;
    unsigned int n_shortened = 0;
    for (unsigned int i = 0; i < 20; ++i)
      {
        const VectorType u = fixture.random_start();
        VectorType       v = fixture.random_direction();
        v *= fixture.length * fixture.random(0, 1);
        const VectorType original(v);

        const unsigned int n_projected = functional.project(v, u, 1.);
        VectorType         w(u);
        w += v;
        penetration = std::max(
          penetration, functional.largest_penetration(w) / fixture.length);
        unsigned int expected = 0;
        for (const ContactNode<dim> &node : d.contact())
          {
            const bool too_far = normal_component(node, u) +
                normal_component(node, original) - node.gap >
              1e-12 * fixture.length;
            expected += too_far;
            VectorType difference(v);
            changed = std::max(
              {changed,
               (slip_of<dim>(node, v) - slip_of<dim>(node, original)).norm() /
                 fixture.length,
               too_far ? 0.
                       : std::abs(normal_component(node, v) -
                                  normal_component(node, original)) /
                   fixture.length});
          }
        counted = counted && n_projected == expected;

        // What has been projected may be followed at least once.
        at_least_one =
          at_least_one && functional.admissible_length(v, u, 2.) >= 1 - 1e-12;

        // From a start without contact: as long as possible, no longer.
        VectorType inside(u);
        for (const ContactNode<dim> &node : d.contact())
          for (unsigned int c = 0; c < dim; ++c)
            inside.local_element(dim * node.node + c) -=
              0.01 * fixture.length * node.normal()[c];
        const double length =
          functional.admissible_length(original, inside, 2.);
        w = inside;
        w.add(length, original);
        penetration_of_length =
          std::max(penetration_of_length,
                   functional.largest_penetration(w) / fixture.length);
        w.add(1e-6 * length, original);
        n_shortened += (length < 2.);
        longest =
          longest && (length == 2. || functional.largest_penetration(w) > 0);
      }
    check_below(penetration, 1e-14, "projected corrections are admissible");
    check(counted, "counted where they were not");
    check_below(changed, 1e-14, "nothing else is changed");
    check(at_least_one, "a projected correction may be followed to its end");
    check_below(penetration_of_length, 1e-14, "admissible lengths are");
    check(longest && n_shortened > 0, "and could not be larger");
  }



  // A linear problem: the phases of a solution, frozen, and a random load. A
  // coarse cycle without sweeps, that is a solution on the coarsest level, plus
  // a little block Jacobi is a symmetric positive definite preconditioner;
  // recombination must turn it into the conjugate gradient method. With sweeps
  // it is not symmetric. In either case recombination never makes things worse.
  template <int dim>
  void
  recombination(TrescaProblem<dim> &fixture, const unsigned int n_sweeps)
  {
    const Discretization<dim> &d       = fixture.discretization;
    const DiscreteProblem<dim> problem = fixture.problem();
    VectorType                 u       = fixture.random_start();
    ContactState               state   = fixture.initial_state();
    ContactSolver<dim>(
      d.dof_handler(), problem, without_safeguards(SolverSettings()))
      .solve(u, state);
    Linearization<dim> linearization(problem, TruncationVariant::phases);
    const Iterate      iterate(u, state);
    linearization.update(iterate);
    const Truncation<dim>   &truncation = linearization.truncation();
    Levels<dim>              levels(d.dof_handler(), problem);
    TruncatedCorrection<dim> coarse(levels, Cycle::V, n_sweeps);
    coarse.update(linearization, iterate);

    VectorType b = fixture.random_direction();
    truncation.apply(b.begin());
    // Without the part of friction, as the iteration has it; then with it.
    const auto residual = [&](const VectorType &x) {
      VectorType r = fixture.product(x);
      r.sadd(-1., 1., b);
      return r;
    };
    const auto truncated_residual = [&](const VectorType &x) {
      VectorType r = residual(x);
      for (const unsigned int node : truncation.changed_nodes())
        {
          const auto part = times<dim>(truncation.curvature(node).data(),
                                       x.begin() + dim * node);
          for (unsigned int c = 0; c < dim; ++c)
            r.local_element(dim * node + c) -= part[c];
        }
      truncation.apply(r.begin());
      return r;
    };
    const auto square = [&](const VectorType &v, const VectorType &Av) {
      return v * Av + curvature_of_friction<dim>(truncation, v);
    };
    const auto precondition = [&](const VectorType &r) {
      VectorType v(r), w(r);
      coarse.apply(v, r);
      for (unsigned int node = 0; node < d.constraints().n_owned_nodes();
           ++node)
        if (!d.constraints().is_hanging(node))
          {
            const double *block  = d.stiffness().diagonal_block(node);
            const double  factor = 1. / trace<dim>(block);
            for (unsigned int c = 0; c < dim; ++c)
              w.local_element(dim * node + c) *= factor;
          }
      truncation.apply(w.begin());
      v += w;
      return v;
    };
    const auto energy = [&](const VectorType &x) {
      return .5 * square(x, fixture.product(x)) - b * x;
    };

    const unsigned int  n_iterations = 25;
    std::vector<double> reference;
    {
      VectorType x(b);
      x            = 0.;
      VectorType r = truncated_residual(x), z = precondition(r), p(z);
      double     rz = r * z;
      for (unsigned int k = 0; k < n_iterations; ++k)
        {
          x.add(rz / square(p, fixture.product(p)), p);
          reference.push_back(energy(x));
          r                 = truncated_residual(x);
          z                 = precondition(r);
          const double next = r * z;
          p.sadd(next / rz, 1., z);
          rz = next;
        }
    }
    const double minimum = reference.back();

    std::vector<unsigned int> needed;
    double difference = 0, worse = 0, length_error = 0, product_error = 0;
    bool   participants = true;
    for (const unsigned int n_steps : {0, 1, 2})
      {
        Recombination<dim> recombination(problem, n_steps);
        VectorType         x(b);
        x = 0.;
        Iterate smoothed(x, state);
        needed.push_back(1000);
        for (unsigned int k = 0; k < 100; ++k)
          {
            smoothed.residual = residual(x);
            if (k > 0)
              smoothed.end_step();
            const VectorType r  = truncated_residual(x);
            VectorType       v  = precondition(r);
            VectorType       Av = fixture.product(v);

            const double       alone = (r * v) * (r * v) / square(v, Av);
            double             vAv   = v * Av;
            const unsigned int n =
              recombination.improve(v, vAv, smoothed, r, truncation);
            Av                    = fixture.product(v);
            const double together = (r * v) * (r * v) / square(v, Av);
            if (k < n_iterations)
              {
                participants = participants && n == std::min(k, n_steps);
                worse        = std::max(worse, 1 - together / alone);
                // Not a number is an error, too.
                const double error = std::abs(vAv / (v * Av) - 1.);
                product_error = error <= product_error ? product_error : error;
                if (n > 0)
                  length_error = std::max(
                    length_error, std::abs((r * v) / square(v, Av) - 1));
              }
            smoothed.begin_step();
            x.add((r * v) / square(v, Av), v);
            if (n_steps > 0 && k < 12)
              difference = std::max(
                difference, std::abs((energy(x) - reference[k]) / minimum));
            if (energy(x) - minimum <= 1e-8 * std::abs(minimum))
              {
                needed.back() = std::min(needed.back(), k + 1);
                if (k > 15)
                  break;
              }
          }
      }
    double curvature = 0;
    for (const unsigned int node : truncation.changed_nodes())
      curvature =
        std::max(curvature, trace<dim>(truncation.curvature(node).data()));
    check((curvature > 0) == (dim == 3),
          dim == 2 ? "friction is linear" : "friction has a second derivative");
    check(participants, "all steps take part");
    check_below(worse, 1e-9, "recombination never makes a correction worse");
    check_below(product_error, 1e-9, "its energy product is known");
    check_below(length_error, 1e-8, "the combination has the right length");
    if (n_sweeps == 0)
      check_below(difference, 1e-9, "it is the conjugate gradient method");
    check(needed[1] < needed[0], "fewer steps with recombination");
    check(needed[2] <= needed[1] + 1,
          "more than one step neither helps nor harms");

    // A step that has moved a node which now is held does not take part; in
    // later load steps it does as far as it is free, and no combination of the
    // correction and that part is better.
    Recombination<dim> one_step(problem, 1);
    VectorType         x(b);
    x = 0.;
    Iterate smoothed(x, state);
    smoothed.residual = residual(x);
    smoothed.begin_step();
    x                 = precondition(truncated_residual(x));
    smoothed.residual = residual(x);
    smoothed.end_step();
    VectorType   r     = truncated_residual(x);
    VectorType   v     = precondition(r);
    unsigned int moved = (d.contact())[0].node;
    for (const ContactNode<dim> &node : d.contact())
      for (unsigned int c = 0; c < dim; ++c)
        if (std::abs(x.local_element(dim * node.node + c)) > 0)
          moved = node.node;
    Truncation<dim> other(truncation);
    other.set(moved, zero_block<dim>(), zero_block<dim>());
    VectorType s(smoothed.step);
    for (VectorType *const each : {&r, &v, &s})
      other.apply(each->begin());
    VectorType w(v);
    double     wAw      = v * fixture.product(v);
    const bool left_out = one_step.improve(w, wAw, smoothed, r, other) == 0;
    w -= v;
    check(left_out && w.linfty_norm() == 0,
          "a step out of the free subspace is left out");

    DiscreteProblem<dim> later  = fixture.problem();
    later.previous_displacement = &u;
    w                           = v;
    const bool takes_part =
      Recombination<dim>(later, 1).improve(w, wAw, smoothed, r, other) == 1;
    const auto model = [&](const VectorType &y) {
      return .5 *
        (y * fixture.product(y) + curvature_of_friction<dim>(other, y)) -
        r * y;
    };
    bool best = model(w) < model(v);
    for (const VectorType *const direction : {&v, &s})
      for (const double length : {-1e-3, 1e-3})
        {
          VectorType y(w);
          y.add(length, *direction);
          best = best && model(y) > model(w);
        }
    best = best && std::abs(wAw / (w * fixture.product(w)) - 1.) <= 1e-12;
    VectorType projected(w);
    other.apply(projected.begin());
    projected -= w;
    check(takes_part && best &&
            projected.linfty_norm() <= 1e-14 * w.linfty_norm(),
          "and in later load steps takes part as far as it is free");
  }



  template <int dim>
  void
  test(TrescaProblem<dim> &fixture, const std::string &name)
  {
    std::cout << dim << "D, mesh of '" << name << "'" << std::endl;
    check(fixture.converged && fixture.mesh->has_hanging_nodes(),
          "has hanging nodes, and a Coulomb solution");

    for (const Cycle cycle : {Cycle::V, Cycle::W})
      for (const CoarseCorrection correction :
           {CoarseCorrection::truncated, CoarseCorrection::monotone})
        {
          std::cout << "parts: "
                    << (correction == CoarseCorrection::truncated
                          ? "truncated, "
                          : "monotone, ")
                    << (cycle == Cycle::V ? "V" : "W") << std::endl;
          part_by_part<dim>(fixture, correction, cycle);
        }
    std::cout << "whole iteration" << std::endl;
    whole_iteration<dim>(fixture);
    std::cout << "line search" << std::endl;
    line_search<dim>(fixture);
    std::cout << "projection" << std::endl;
    projection<dim>(fixture);
    for (const unsigned int n_sweeps : {0, 6})
      {
        std::cout << "recombination, " << n_sweeps << " sweeps" << std::endl;
        recombination<dim>(fixture, n_sweeps);
      }
  }
} // namespace test_monotonicity

TEST(monotonicity)
{
  for (const std::string name : {"hertz", "block"})
    {
      TrescaProblem<2> fixture(
        read_parameters(std::string(SCENES_DIR) + "/" + name + ".prm"),
        name == "hertz" ? 1 : 3,
        3);
      test<2>(fixture, name);
    }
  {
    TrescaProblem<3> fixture(
      curved_parameters<3>(FrictionLaw::coulomb, .4), 1, 2);
    test<3>(fixture, "block on a rod");
  }

  // What recombination is worth in practice.
  std::cout << "cycles of nested iteration" << std::endl;
  NestedIteration<2> iteration(without_safeguards(read_parameters(
    SCENES_DIR "/hertz.prm", {"Refinement/Maximum dofs=2000"})));
  iteration.begin();
  std::array<unsigned int, 2> cycles = {{0, 0}};
  do
    {
      iteration.solve();
      for (const unsigned int n_steps : {0, 1})
        {
          SolverSettings settings   = iteration.parameters().solver;
          settings.recombined_steps = n_steps;
          VectorType   u;
          ContactState state(0, false);
          cycles[n_steps] +=
            iteration.solve_with(settings, u, state).cycles.size();
        }
  } while (iteration.advance());
  check(cycles[1] < cycles[0], "fewer with recombination than without");
}

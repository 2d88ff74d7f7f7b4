// Friction that counts slip from where an earlier load step has ended, against
// two truths.
//
// A block whose stress is the same everywhere is pressed down, dragged until it
// slides, dragged back, so that it sticks first and then slides the other way,
// and at last pressed less, so that it slides by itself. Its displacements are
// linear, and which of them they are a return map says for the whole block at
// once: with the slip s of the step before the shear stress is q = mu (U-s)/H,
// as long as that is no more than F p, and then F p in that direction. Finite
// elements reproduce it to rounding on any mesh, here a distorted one with
// hanging nodes, in three dimensions on the contact boundary, too.
//
// And a block with free sides, whose nodes do different things, against a dense
// solution of another formulation: for the increment of the displacement since
// the step before, with loads and gaps that the displacement before has
// changed, the law of friction is the usual one.

#include <common/algorithms/contact_solver.h>
#include <common/contact/contact_forces.h>
#include <common/estimate/contact_estimate.h>
#include <common/output/level_records.h>

#include <iomanip>
#include <iostream>

#include <tests/support/check.h>

#include <tests/reference/solutions/dense_contact.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_slip_origin
{
  std::string
  number(const double value)
  {
    std::ostringstream text;
    text << std::setprecision(17) << value;
    return text.str();
  }



  // The top of the block goes to this place, so that it is compressed by d.
  template <int dim>
  struct PatchStep
  {
    Tensor<1, dim> top; // its normal component is not used
    double         d;
    bool           sticks;
  };



  template <int dim>
  std::vector<PatchStep<dim>> patch_steps();

  // The threshold of the shear is 1.4 d.
  template <>
  std::vector<PatchStep<2>>
  patch_steps()
  {
    return {{Tensor<1, 2>({.01, 0}), .02, true},
            {Tensor<1, 2>({.04, 0}), .02, false},
            {Tensor<1, 2>({.02, 0}), .02, true},
            {Tensor<1, 2>({-.03, 0}), .02, false},
            {Tensor<1, 2>({-.03, 0}), .01, false}};
  }

  template <>
  std::vector<PatchStep<3>>
  patch_steps()
  {
    return {{Tensor<1, 3>({.01, .005, 0}), .02, true},
            {Tensor<1, 3>({.04, .01, 0}), .02, false},
            {Tensor<1, 3>({.03, .04, 0}), .02, false},
            {Tensor<1, 3>({.02, .02, 0}), .02, true},
            {Tensor<1, 3>({-.03, .01, 0}), .02, false}};
  }



  // With some cells refined, whatever process they belong to.
  template <int dim>
  void
  refine_some(Triangulation<dim> &mesh)
  {
    mesh.refine_global(1);
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          double sum = 0;
          for (unsigned int d = 0; d < dim; ++d)
            sum += (d + 1.7) * cell->center()[d];
          if (std::lround(1e3 * sum) % 4 == 1)
            cell->set_refine_flag();
        }
    mesh.execute_coarsening_and_refinement();
  }



  // If it is held, the contact nodes are prescribed to move as they do in the
  // last tangential direction.
  template <int dim>
  void
  patch_history(const std::string &scene_file,
                const double       angle,
                const bool         held)
  {
    std::ostringstream about;
    about << dim << "D, turned by " << angle << " degrees"
          << (held ? ", held in one direction" : "") << ", step ";
    const double   F = .4, H = 1, radians = angle * numbers::PI / 180.;
    Tensor<2, dim> rotation = unit_symmetric_tensor<dim>();
    rotation[0][0] = rotation[1][1] = std::cos(radians);
    rotation[1][0]                  = std::sin(radians);
    rotation[0][1]                  = -rotation[1][0];

    auto           mesh = make_triangulation<dim>();
    VectorType     before;
    Tensor<1, dim> slip;
    unsigned int   n = 0;
    for (const PatchStep<dim> &step : patch_steps<dim>())
      {
        const Material material(1., .3);
        const double   mu          = material.mu(),
                     p             = (material.lambda() + 2. * mu) * step.d / H;
        const Tensor<1, dim> trial = mu / H * (step.top - slip);
        const Tensor<1, dim> q =
          trial.norm() <= F * p ? trial : F * p / trial.norm() * trial;
        const Tensor<1, dim> last_slip = slip;
        slip                           = step.top - H / mu * q;

        const std::string side = "-lambda*" + number(step.d);
        std::string       constants, displacement, traction;
        if (dim == 2)
          {
            constants    = "L = 2; H = 1; U = 0; gap = 0; d = ";
            displacement = "3: " + number(step.top[0]) + ", ";
            traction = "0: -(" + side + "), " + number(-q[0]) + "; 1: " + side +
              ", " + number(q[0]);
          }
        else
          {
            constants =
              "L = 1.5; W = 1; H = 1; U = 0; alpha = 0; gap = 0; d = ";
            displacement =
              "5: " + number(step.top[0]) + ", " + number(step.top[1]) + ", ";
            traction = "0: -(" + side + "), 0, " + number(-q[0]) +
              "; 1: " + side + ", 0, " + number(q[0]) + "; 2: 0, -(" + side +
              "), " + number(-q[1]) + "; 3: 0, " + side + ", " + number(q[1]);
          }
        displacement += number(-step.d);
        if (held)
          displacement += "; 4: free, " + number(slip[1]) + ", free";

        const Parameters parameters = without_safeguards(
          read_parameters(scene_file,
                          {"Scene/Constants=" + constants + number(step.d),
                           "Scene/Rotation angle=" + number(angle),
                           "Boundary conditions/Displacement=" + displacement,
                           "Boundary conditions/Traction=" + traction,
                           "Solver/Inner tolerance=1e-13"}));
        const Scene<dim> scene(parameters);
        if (n == 0)
          {
            scene.make_coarse_mesh(*mesh);
            refine_some(*mesh);
          }
        Discretized<dim> d(scene, *mesh);
        if (n > 0)
          d.set_slip_origin(before);
        const ContactBoundary<dim> &contact = d.contact();
        VectorType                  u       = admissible_start(d);
        ContactState                state(contact.size(), true);
        ContactSolver<dim>          solver(d, parameters.solver);
        const SolverReport          report = solver.solve(u, state);
        VectorType                  tractions =
          contact_tractions(contact, report.residual, state);
        d.interpolate_hanging_nodes(u);
        d.interpolate_hanging_nodes(tractions);

        // Displacements of all nodes that this process knows.
        double     error  = 0;
        const auto points = node_points(d);
        for (unsigned int i = 0; i < d.constraints().n_owned_nodes(); ++i)
          {
            const double height =
              (transpose(rotation) * points[i])[dim - 1] / H;
            Tensor<1, dim> exact = (1 - height) * slip + height * step.top;
            exact[dim - 1]       = -step.d * height;
            exact                = rotation * exact;
            for (unsigned int c = 0; c < dim; ++c)
              error = std::max(
                error, std::abs(u.local_element(dim * i + c) - exact[c]));
          }

        // Forces and what is recorded at contact nodes.
        const auto records      = make_level_records(0, d, u, state, report);
        double     stress_error = 0, slip_error = 0;
        bool       same_states = true;
        for (const ContactRecord<dim> &record : records.own_contact)
          {
            Tensor<1, dim> expected = -1. * q;
            expected[dim - 1]       = p;
            Tensor<1, dim> difference =
              record.force / record.measure - rotation * expected;
            // What holds a node bears the force in this direction.
            if (held)
              {
                Tensor<1, dim> direction;
                direction[1] = 1;
                direction    = rotation * direction;
                difference -= (difference * direction) * direction;
              }
            stress_error = std::max(stress_error, difference.norm() / p);
            slip_error =
              std::max(slip_error,
                       (record.slip() - rotation * (slip - last_slip)).norm());
            same_states =
              same_states && record.state == (step.sticks ? 2u : 1u);
          }

        // Tractions are without what bears nodes that are held, which the
        // estimator therefore misses.
        const ErrorEstimate estimate = estimate_contact_error(d, u, tractions);
        const bool          no_error =
          held || estimate.total < 1e-6 * estimate.energy_norm;
        std::ostringstream what;
        what << about.str() << n << ": ";
        check_everywhere(
          report.converged && same_states,
          what.str() +
            (step.sticks ? "everything sticks" : "everything slides"));
        check_everywhere(error < 1e-10 * step.d && stress_error < 1e-10 &&
                           slip_error < 1e-10 * step.d,
                         what.str() +
                           "displacements, forces and slip to 1e-10");
        check_everywhere(report.certificate.largest() < 1e-9 && no_error,
                         what.str() + "certified" +
                           (held ? "" : ", and no error estimated"));
        if (!(error < 1e-10 * step.d && stress_error < 1e-10 &&
              slip_error < 1e-10 * step.d && no_error))
          std::cout << "  " << error << ' ' << stress_error << ' ' << slip_error
                    << ' ' << estimate.total / estimate.energy_norm << ' '
                    << report.certificate.describe() << std::endl;
        before = u;
        ++n;
      }
  }



  // The discrete problem of a step, as the dense solver wants it, but for its
  // loads. Each process has all of it.
  Reference::ContactProblem
  dense_problem(const Discretization<2> &d, const double F)
  {
    Reference::ContactProblem problem;
    for (const Point<2> &point : node_points(d))
      problem.mesh.nodes.emplace_back(point[0], point[1]);
    const NodalConstraints<2> &constraints = d.constraints();
    for (const auto &cell : d.dof_handler().active_cell_iterators())
      {
        std::array<unsigned int, 4> nodes;
        for (const unsigned int v : cell->vertex_indices())
          nodes[v] = constraints.node_of_dof(cell->vertex_dof_index(v, 0));
        problem.mesh.cells.push_back(nodes);
      }
    for (unsigned int i = 0; i < constraints.n_owned_nodes(); ++i)
      if (constraints.is_hanging(i))
        {
          Reference::HangingNode node{i, {}};
          for (const auto &[master, weight] :
               *d.hanging_nodes().get_constraint_entries(
                 constraints.partitioner()->local_to_global(2 * i)))
            node.masters.emplace_back(constraints.node_of_dof(master), weight);
          problem.hanging.push_back(node);
        }
      else
        for (unsigned int c = 0; c < 2; ++c)
          if (constraints.is_prescribed(i, c))
            problem.dirichlet.push_back(
              {i, c, constraints.prescribed_values().local_element(2 * i + c)});
    for (const ContactNode<2> &p : d.contact())
      problem.contact.push_back(
        {p.node, {p.normal()[0], p.normal()[1]}, p.gap, F, 0.});
    return problem;
  }



  void
  block_history()
  {
    const double                       F    = .4;
    const std::vector<Eigen::Vector2d> tops = {{0, -.02},
                                               {.03, -.02},
                                               {.01, -.02},
                                               {-.03, -.02},
                                               {-.03, -.01},
                                               {0., -.005}};
    auto            mesh = make_triangulation<2>(MPI_COMM_SELF);
    Eigen::VectorXd before;
    unsigned int    n = 0, n_sliding = 0, n_sticking = 0;
    double          displacement_error = 0, force_error = 0, certificate = 0;
    unsigned int    different_states = 0, not_converged = 0;
    for (const Eigen::Vector2d &top : tops)
      {
        const Parameters parameters = without_safeguards(read_parameters(
          SCENES_DIR "/block.prm",
          {"Boundary conditions/Displacement=3: " + number(top[0]) + ", " +
             number(top[1]),
           "Contact/Friction coefficient=" + number(F),
           "Solver/Inner tolerance=1e-12",
           "Solver/Outer tolerance=1e-11"}));
        const Scene<2>   scene(parameters);
        if (n == 0)
          {
            scene.make_coarse_mesh(*mesh);
            mesh->refine_global(2);
            refine_some(*mesh);
          }
        Discretized<2> d(scene, *mesh);

        // The increment: what the step before has left are loads and gaps.
        Reference::ContactProblem problem = dense_problem(d, F);
        if (n == 0)
          before = Eigen::VectorXd::Zero(2 * problem.mesh.nodes.size());
        problem.forces =
          -(Reference::stiffness(problem.mesh, problem.poisson_ratio) * before);
        for (auto &value : problem.dirichlet)
          value.value -= before[2 * value.node + value.component];
        for (auto &p : problem.contact)
          p.gap -= before.segment<2>(2 * p.node).dot(p.normal);
        const Reference::ContactSolution increment = Reference::solve(problem);
        const Eigen::VectorXd exact = before + increment.displacement;
        n_sliding += increment.count(Reference::State::sliding);
        n_sticking += increment.count(Reference::State::sticking);

        if (n > 0)
          {
            VectorType origin = d.vector();
            for (unsigned int i = 0; i < before.size(); ++i)
              origin.local_element(i) = before[i];
            d.set_slip_origin(origin);
          }
        for (const Algorithm algorithm :
             {Algorithm::gauss_seidel_like, Algorithm::fixed_point})
          for (const CoarseCorrection correction :
               {CoarseCorrection::truncated,
                CoarseCorrection::monotone,
                CoarseCorrection::algebraic})
            {
              SolverSettings settings    = parameters.solver;
              settings.algorithm         = algorithm;
              settings.coarse_correction = correction;
              VectorType         u       = admissible_start(d);
              ContactState       state(d.contact().size(), true);
              ContactSolver<2>   solver(d, settings);
              const SolverReport report = solver.solve(u, state);
              d.interpolate_hanging_nodes(u);
              not_converged += !report.converged;
              certificate = std::max(certificate, report.certificate.largest());
              const double force_scale =
                increment.normal_force.cwiseAbs().maxCoeff();
              for (unsigned int i = 0; i < exact.size(); ++i)
                displacement_error =
                  std::max(displacement_error,
                           std::abs(u.local_element(i) - exact[i]) /
                             exact.cwiseAbs().maxCoeff());
              for (unsigned int p = 0; p < d.contact().size(); ++p)
                {
                  for (unsigned int c = 0; c < 2; ++c)
                    {
                      const unsigned int i = 2 * d.contact()[p].node + c;
                      force_error =
                        std::max(force_error,
                                 std::abs(-report.residual.local_element(i) -
                                          increment.residual[i]) /
                                   force_scale);
                    }
                  const Reference::State found = !state.in_contact(p)
                    ? Reference::State::open
                    : state.sticks(p) ? Reference::State::sticking
                                      : Reference::State::sliding;
                  different_states += found != increment.state[p];
                }
            }
        before = exact;
        ++n;
      }
    check_everywhere(n_sliding > 10 && n_sticking > 10,
                     "a block with free sides, six steps: some nodes stick, "
                     "others slide");
    check_everywhere(not_converged == 0 && certificate < 1e-8,
                     "all variants converge and are certified to 1e-8");
    check_everywhere(displacement_error < 1e-8 && force_error < 1e-8,
                     "displacements and forces are those of the dense solution "
                     "for the increment, to 1e-8");
    check_everywhere(different_states == 0, "and so are the states");
    if (std::max({displacement_error, force_error, certificate}) >= 1e-8 ||
        not_converged + different_states > 0)
      std::cout << "  " << n_sliding << ' ' << n_sticking << ' '
                << not_converged << ' ' << certificate << ' '
                << displacement_error << ' ' << force_error << ' '
                << different_states << std::endl;
  }
} // namespace test_slip_origin

TEST(slip_origin)
{
  patch_history<2>(SCENES_DIR "/stick-slip.prm", 0., false);
  patch_history<2>(SCENES_DIR "/stick-slip.prm", 25., false);
  patch_history<3>(SCENES_3D_DIR "/stick-slip.prm", 25., false);
  patch_history<3>(SCENES_3D_DIR "/stick-slip.prm", 0., true);
  block_history();
}

// The patch test of the scene stick-slip in three dimensions: displacements and
// stresses must be those of the closed form, up to rounding, whatever the
// direction of shear, the mesh, the position of the body, and the units.

#include <common/algorithms/contact_solver.h>

#include <deal.II/grid/grid_tools.h>

#include <iomanip>
#include <iostream>

#include <tests/support/check.h>

#include <tests/reference/solutions/scenes_3d.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_known_solutions_3d
{
  constexpr double F = .4, nu = .3;

  struct Patch
  {
    std::string what;
    double      shear;              ///< in multiples of the threshold
    double      alpha;              ///< direction of shear, degrees
    double      gap            = 0; ///< of a height of one
    double      angle          = 0; ///< by which all is turned about the z axis
    double      youngs_modulus = 1;
    double      unit           = 1; ///< of length
    LocalSolver local_solver   = LocalSolver::secular_equation;
  };



  std::string
  number(const double value)
  {
    std::ostringstream text;
    text << std::setprecision(17) << value;
    return text.str();
  }



  // The scene's own mesh with its bottom, which the scene leaves regular,
  // distorted as well, and refined in places: hanging nodes on faces and edges,
  // in the body and on the contact boundary, and two levels of them.
  void
  make_mesh(const Scene<3> &scene, const Patch &patch, Triangulation<3> &mesh)
  {
    scene.make_coarse_mesh(mesh);
    const double angle = patch.angle * numbers::PI / 180., c = std::cos(angle),
                 s = std::sin(angle), L = 1.5 * patch.unit, W = patch.unit;
    // From the body's coordinates to those of space and back.
    const auto to_space = [=](const Point<3> &p) {
      return Point<3>(c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]);
    };
    const auto to_body = [=](const Point<3> &p) {
      return Point<3>(c * p[0] + s * p[1], -s * p[0] + c * p[1], p[2]);
    };
    // Moves each vertex within the face, or the edge, that it lies on.
    GridTools::transform(
      [&](const Point<3> &in_space) {
        Point<3>     p = to_body(in_space);
        const double x = p[0] * (L - p[0]) / (L * L),
                     y = p[1] * (W - p[1]) / (W * W);
        p[0] += .7 * L * x * (p[1] / W - .3);
        p[1] -= .7 * W * y * (p[0] / L - .4);
        return to_space(p);
      },
      mesh);

    mesh.refine_global(1);
    for (unsigned int step = 0; step < 2; ++step)
      {
        unsigned int n = 0;
        for (const auto &cell : mesh.active_cell_iterators())
          if (n++ % 9 == 4)
            cell->set_refine_flag();
        mesh.execute_coarsening_and_refinement();
      }
  }



  // Nodes on the contact boundary that hang on others.
  unsigned int
  n_hanging_on_bottom(const Discretization<3> &d, const double tolerance)
  {
    unsigned int n      = 0;
    const auto   points = node_points(d);
    for (unsigned int i = 0; i < points.size(); ++i)
      n +=
        (std::abs(points[i][2]) < tolerance && d.constraints().is_hanging(i));
    return n;
  }



  void
  stick_slip(const Patch &patch)
  {
    const double unit = patch.unit, d = .02 * unit, gap = patch.gap * unit,
                 alpha = patch.alpha * numbers::PI / 180.,
                 shear =
                   patch.shear * Reference::StickSlip::threshold(d, F, nu);
    const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(patch.angle * numbers::PI / 180.,
                        Eigen::Vector3d::UnitZ())
        .toRotationMatrix();
    const Reference::StickSlip3D exact(
      shear * Eigen::Vector2d(std::cos(alpha), std::sin(alpha)),
      d,
      F,
      gap,
      {1.5 * unit, unit, unit},
      patch.youngs_modulus,
      nu,
      rotation);

    Parameters parameters = read_parameters(
      SCENES_3D_DIR "/stick-slip.prm",
      {"Scene/Constants=L = " + number(1.5 * unit) + "; W = " + number(unit) +
         "; H = " + number(unit) + "; U = " + number(shear) + "; alpha = " +
         number(alpha) + "; d = " + number(d) + "; gap = " + number(gap),
       "Scene/Rotation angle=" + number(patch.angle),
       "Material/Young's modulus=" + number(patch.youngs_modulus),
       "Solver/Inner tolerance=1e-13"});
    parameters.solver.local_solver = patch.local_solver;
    const Scene<3> scene(parameters);
    auto           mesh = make_triangulation<3>();
    make_mesh(scene, patch, *mesh);

    const Discretized<3>      discretization(scene, *mesh);
    const ContactBoundary<3> &contact = discretization.contact();
    VectorType                u       = admissible_start(discretization);
    ContactState              state(contact.size(), true);
    ContactSolver<3>          solver(discretization,
                            without_safeguards(parameters.solver));
    const SolverReport        report = solver.solve(u, state);
    discretization.hanging_nodes().distribute(u);

    double     error = 0, scale = 0;
    const auto points = node_points(discretization);
    for (unsigned int i = 0; i < points.size(); ++i)
      {
        const Eigen::Vector3d value =
          exact.displacement({points[i][0], points[i][1], points[i][2]});
        for (unsigned int c = 0; c < 3; ++c)
          error =
            std::max(error, std::abs(u.local_element(3 * i + c) - value[c]));
        scale = std::max(scale, value.norm());
      }
    error /= scale;

    // The force on the body, over the measure: the pressure pushes it away from
    // the obstacle, friction drags it back.
    const double pressure =
      patch.youngs_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * d / unit;
    const Eigen::Vector2d q = exact.shear_stress();
    const Eigen::Vector3d expected =
      rotation * Eigen::Vector3d(-q[0], -q[1], pressure);
    double       stress_error = 0, area = 0;
    unsigned int n_slipping = 0;
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        for (unsigned int c = 0; c < 3; ++c)
          stress_error = std::max(
            stress_error,
            std::abs(-report.residual.local_element(3 * contact[p].node + c) /
                       contact[p].measure -
                     expected[c]));
        n_slipping += !state.sticks(p);
        area += contact[p].measure;
      }
    stress_error /= pressure;
    const double       area_error = std::abs(area / (1.5 * unit * unit) - 1);
    const unsigned int n_hanging =
      n_hanging_on_bottom(discretization, 1e-9 * unit);

    // Uzawa's iteration stops before rounding does.
    const double tolerance =
      (patch.local_solver == LocalSolver::uzawa ? 1e-10 : 1e-12);
    const bool ok = report.converged && error < tolerance &&
      stress_error < tolerance && area_error < 1e-12 && n_hanging > 10 &&
      state.n_contact() == contact.size() &&
      n_slipping == (exact.sticks() ? 0 : contact.size());
    check(ok,
          patch.what +
            (exact.sticks() ? ": everything sticks" : ": everything slips"));
    if (!ok)
      std::cout << "  converged " << report.converged << ", error " << error
                << ", stress " << stress_error << ", area " << area_error
                << ", in contact " << state.n_contact() << " of "
                << contact.size() << ", slipping " << n_slipping
                << ", hanging there " << n_hanging << std::endl;
  }
} // namespace test_known_solutions_3d

TEST(known_solutions_3d)
{
  // Along the edges, askew, and so nearly along an edge that one component is
  // all but rounding.
  std::cout << "Direction of shear" << std::endl;
  for (const double shear : {.5, 1.5})
    for (const double alpha :
         {0., 30., 45., 90., 137., 180., -90., -101., 1e-8})
      {
        std::ostringstream text;
        text << shear << " times the threshold, " << alpha << " degrees";
        stick_slip({text.str(), shear, alpha});
      }

  std::cout << "All else" << std::endl;
  for (const double shear : {.5, .99, 1.01, 1.5})
    {
      std::ostringstream text;
      text << shear << " times the threshold, ";
      const double a = 30;
      Patch        patch{text.str() + "as it is", shear, a};
      stick_slip(patch);
      const auto with = [&](const std::string &what) {
        Patch p = patch;
        p.what  = text.str() + what;
        return p;
      };
      Patch gap = with("initial gap");
      gap.gap   = .01;
      stick_slip(gap);
      Patch rotated = with("rotated");
      rotated.angle = 37;
      stick_slip(rotated);
      Patch stiff          = with("E = 1e10");
      stiff.youngs_modulus = 1e10;
      stick_slip(stiff);
      Patch soft          = with("E = 1e-10");
      soft.youngs_modulus = 1e-10;
      stick_slip(soft);
      Patch mm = with("in mm");
      mm.unit  = 1000;
      stick_slip(mm);
      Patch uzawa        = with("Uzawa");
      uzawa.local_solver = LocalSolver::uzawa;
      stick_slip(uzawa);
      Patch all          = with("all at once");
      all.gap            = .01;
      all.angle          = -110;
      all.youngs_modulus = 1e10;
      all.unit           = 1000;
      stick_slip(all);
      all.what += ", Uzawa";
      all.local_solver = LocalSolver::uzawa;
      stick_slip(all);
    }
}

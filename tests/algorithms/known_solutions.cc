// Scenes whose solutions are known: the benchmark of Raous and others, the
// patch test that finite elements solve to rounding on any mesh, and a
// manufactured solution that lifts off, slips and sticks.

#include <common/algorithms/nested_iteration.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_values.h>

#include <iomanip>
#include <iostream>

#include <tests/support/check.h>

#include <tests/reference/solutions/scenes.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_known_solutions
{
  std::string
  number(const double value)
  {
    std::ostringstream text;
    text << std::setprecision(17) << value;
    return text.str();
  }



  // Tangential displacements along the bottom, and the ends of the zones.
  void
  raous()
  {
    std::cout << "raous" << std::endl;
    NestedIteration<2> iteration(
      without_safeguards(read_parameters(SCENES_DIR "/raous.prm")));
    iteration.begin();
    do
      {
        iteration.solve();
        if (!iteration.report().converged)
          std::cout << "no convergence on level " << iteration.level()
                    << std::endl;
    } while (iteration.advance());
    const Discretization<2> &d = iteration.discretization();
    std::cout << iteration.mesh().n_active_cells() << " cells" << std::endl;

    const auto u_x = [&](const double x) {
      for (const ContactNode<2> &node : d.contact())
        if (std::abs(node.point[0] - x) < 1e-9)
          return iteration.displacement().local_element(2 * node.node);
      return 0.;
    };
    const std::vector<std::array<double, 3>> values = {// x in mm; independent
                                                       // solution on this mesh,
                                                       // published, in
                                                       // micrometres
                                                       {{0., 28.594, 28.6}},
                                                       {{1.25, 27.217, 27.2}},
                                                       {{5., 22.850, 22.8}},
                                                       {{7.5, 19.796, 19.8}},
                                                       {{11.25, 15.406, 15.0}}};
    double from_independent = 0, from_published = 0;
    for (const auto &value : values)
      {
        const double found = 1e6 * u_x(1e-3 * value[0]);
        std::cout << "  u_x(" << value[0] << " mm) = " << std::fixed
                  << std::setprecision(2) << found << std::defaultfloat
                  << std::setprecision(6) << std::endl;
        from_independent =
          std::max(from_independent, std::abs(found / value[1] - 1.));
        from_published =
          std::max(from_published, std::abs(found / value[2] - 1.));
      }
    check(from_independent < 0.005, "independent values to 0.5 %");
    check(from_published < 0.03, "published values to 3 %");

    double first_sticking = 1., last_slipping = 0., last_open = 0.;
    for (unsigned int p = 0; p < d.contact().size(); ++p)
      {
        const double x = (d.contact())[p].point[0];
        if (iteration.state().sticks(p))
          first_sticking = std::min(first_sticking, x);
        else if (iteration.state().in_contact(p))
          last_slipping = std::max(last_slipping, x);
        else
          last_open = std::max(last_open, x);
      }
    std::cout << "  last open node " << 1e3 * last_open << " mm, last slipping "
              << 1e3 * last_slipping << " mm, first sticking "
              << 1e3 * first_sticking << " mm" << std::endl;
  }



  struct Patch
  {
    std::string what;
    double      shear; ///< in multiples of the threshold
    double      gap, angle, youngs_modulus, unit;
    std::string volumetric_strain = "pointwise";
  };

  // On a distorted mesh with hanging nodes displacements and pressures must be
  // those of the closed form, up to rounding.
  void
  stick_slip(const Patch &patch)
  {
    const double unit = patch.unit, d = 0.02 * unit, gap = patch.gap * unit,
                 F     = 0.4,
                 shear = patch.shear * Reference::StickSlip::threshold(d, F);
    const Reference::StickSlip exact(shear,
                                     d,
                                     F,
                                     gap,
                                     2 * unit,
                                     unit,
                                     patch.youngs_modulus,
                                     0.3,
                                     patch.angle * numbers::PI / 180.);

    const Parameters parameters = without_safeguards(read_parameters(
      SCENES_DIR "/stick-slip.prm",
      {"Scene/Constants=L = " + number(2 * unit) + "; H = " + number(unit) +
         "; U = " + number(shear) + "; d = " + number(d) +
         "; gap = " + number(gap),
       "Scene/Rotation angle=" + number(patch.angle),
       "Material/Young's modulus=" + number(patch.youngs_modulus),
       "Material/Volumetric strain=" + patch.volumetric_strain,
       "Solver/Inner tolerance=1e-13"}));
    const Scene<2>   scene(parameters);
    auto             mesh = make_triangulation<2>();
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(1);
    for (unsigned int step = 0; step < 2; ++step)
      {
        unsigned int n = 0;
        for (const auto &cell : mesh->active_cell_iterators())
          if (n++ % 7 == 3)
            cell->set_refine_flag();
        mesh->execute_coarsening_and_refinement();
      }

    const Discretized<2>      discretization(scene, *mesh);
    const ContactBoundary<2> &contact = discretization.contact();
    VectorType                u       = admissible_start(discretization);
    ContactState              state(contact.size(), true);
    ContactSolver<2>          solver(discretization,
                            without_safeguards(parameters.solver));
    const SolverReport        report = solver.solve(u, state);
    discretization.hanging_nodes().distribute(u);

    double     error = 0, scale = 0;
    const auto points = node_points(discretization);
    for (unsigned int i = 0; i < points.size(); ++i)
      {
        const Eigen::Vector2d value =
          exact.displacement({points[i][0], points[i][1]});
        for (unsigned int c = 0; c < 2; ++c)
          error =
            std::max(error, std::abs(u.local_element(2 * i + c) - value[c]));
        scale = std::max(scale, value.norm());
      }
    error /= scale;

    // The force on the body, over the measure: the pressure pushes it away from
    // the obstacle, friction drags it back.
    const Eigen::Vector2d expected =
      Eigen::Rotation2Dd(patch.angle * numbers::PI / 180.) *
      Eigen::Vector2d(-exact.shear_stress(), exact.pressure());
    double       stress_error = 0;
    unsigned int n_slipping   = 0;
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        for (unsigned int c = 0; c < 2; ++c)
          stress_error = std::max(
            stress_error,
            std::abs(-report.residual.local_element(2 * contact[p].node + c) /
                       contact[p].measure -
                     expected[c]));
        n_slipping += !state.sticks(p);
      }
    stress_error /= exact.pressure();

    const bool ok = report.converged && error < 1e-10 && stress_error < 1e-10 &&
      state.n_contact() == contact.size() &&
      n_slipping == (exact.sticks() ? 0 : contact.size());
    check(ok,
          patch.what +
            (exact.sticks() ? ": everything sticks" : ": everything slips"));
    if (!ok)
      std::cout << "  converged " << report.converged << ", error " << error
                << ", stress " << stress_error << ", in contact "
                << state.n_contact() << " of " << contact.size()
                << ", slipping " << n_slipping << std::endl;
  }



  // Energy error, nodal pressure and zone boundaries under uniform refinement.
  void
  manufactured()
  {
    std::cout << "manufactured" << std::endl;
    NestedIteration<2> iteration(without_safeguards(
      read_parameters(SCENES_DIR "/manufactured.prm",
                      {"Refinement/Levels=3", "Solver/Inner tolerance=1e-9"})));
    iteration.begin();
    double last_energy_error = 0, last_pressure_error = 0;
    do
      {
        iteration.solve();
        const Discretization<2> &d = iteration.discretization();
        const Function<2> &exact   = *iteration.scene().exact_displacement();

        const QGauss<2>                    quadrature(4);
        FEValues<2>                        fe_values(d.mapping(),
                              d.dof_handler().get_fe(),
                              quadrature,
                              update_gradients | update_quadrature_points |
                                update_JxW_values);
        std::vector<SymmetricTensor<2, 2>> strains(quadrature.size());
        double                             energy_error = 0;
        for (const auto &cell : d.dof_handler().active_cell_iterators())
          {
            fe_values.reinit(cell);
            fe_values[FEValuesExtractors::Vector(0)]
              .get_function_symmetric_gradients(iteration.displacement(),
                                                strains);
            for (const unsigned int q : fe_values.quadrature_point_indices())
              {
                Tensor<2, 2> gradient;
                for (unsigned int c = 0; c < 2; ++c)
                  gradient[c] =
                    exact.gradient(fe_values.quadrature_point(q), c);
                const SymmetricTensor<2, 2> e =
                  symmetrize(gradient) - strains[q];
                energy_error +=
                  (iteration.scene().materials().base().lambda() * trace(e) *
                     trace(e) +
                   2. * iteration.scene().materials().base().mu() * (e * e)) *
                  fe_values.JxW(q);
              }
          }
        energy_error = std::sqrt(energy_error);

        // Nodal forces over measures against p = p0 (x-1)^2_+, in the norm
        // that the measures define; where each zone begins.
        double pressure_error = 0, first_contact = 3, first_sticking = 3;
        for (unsigned int p = 0; p < d.contact().size(); ++p)
          {
            const ContactNode<2> &node = (d.contact())[p];
            const double          x    = node.point[0];
            pressure_error += node.measure *
              std::pow(normal_component(node, iteration.report().residual) /
                           node.measure -
                         0.05 * std::pow(std::max(x - 1, 0.), 2),
                       2);
            if (iteration.state().in_contact(p))
              first_contact = std::min(first_contact, x);
            if (iteration.state().sticks(p))
              first_sticking = std::min(first_sticking, x);
          }
        pressure_error = std::sqrt(pressure_error);

        const double h     = 0.25 / (1 << iteration.level());
        const bool   zones = std::abs(first_contact - 1) <= h * 1.001 &&
          std::abs(first_sticking - 2) <= h * 1.001;
        const std::string where =
          "h = 1/" + std::to_string(4 << iteration.level());
        check(iteration.report().converged && zones,
              where + ": zone boundaries within one cell");
        if (iteration.level() > 0)
          {
            const double energy_order =
              std::log2(last_energy_error / energy_error);
            const double pressure_order =
              std::log2(last_pressure_error / pressure_error);
            check(std::abs(energy_order - 1) <= 0.1, "  energy error order 1");
            check(std::abs(pressure_order - 2) <= 0.2,
                  "  nodal pressure order 2");
            if (std::abs(energy_order - 1) > 0.1 ||
                std::abs(pressure_order - 2) > 0.2)
              std::cout << "  orders " << energy_order << ", " << pressure_order
                        << std::endl;
          }
        last_energy_error   = energy_error;
        last_pressure_error = pressure_error;
    } while (iteration.advance());
  }
} // namespace test_known_solutions

TEST(known_solutions)
{
  raous();

  std::cout << "stick-slip" << std::endl;
  for (const double shear : {0.5, 0.99, 1.01, 1.5})
    {
      std::ostringstream text;
      text << shear << " times the threshold, ";
      stick_slip({text.str() + "as it is", shear, 0, 0, 1, 1});
      stick_slip({text.str() + "with initial gap", shear, 0.01, 0, 1, 1});
      stick_slip({text.str() + "rotated", shear, 0, 37, 1, 1});
      stick_slip({text.str() + "E = 1e10", shear, 0, 0, 1e10, 1});
      stick_slip({text.str() + "E = 1e-10", shear, 0, 0, 1e-10, 1});
      stick_slip({text.str() + "in mm", shear, 0, 0, 1, 1000});
      stick_slip(
        {text.str() + "mean volumetric strains", shear, 0, 0, 1, 1, "mean"});
      stick_slip(
        {text.str() + "all at once", shear, 0.01, -110, 1e10, 1000, "mean"});
    }
  manufactured();
}

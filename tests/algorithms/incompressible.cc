// Mean volumetric strains against solutions that are known in closed form: the
// order of convergence is kept where it was good, and at a Poisson ratio of
// 0.4999 it is the same, with the same error, while with pointwise ones the
// body locks. Errors and mean strains are integrated here, without the library.

#include <common/algorithms/nested_iteration.h>
#include <common/estimate/exact_error.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_values.h>

#include <iostream>

#include <tests/support/check.h>

#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_incompressible
{
  struct Errors
  {
    double shear;    ///< square root of the energy of shear of the error
    double energy;   ///< energy norm, with the volumetric strain of the scene
    double pressure; ///< of the contact pressure, weighted with the measures
    double estimate;
  };

  // By differences of fourth order, which for bodies of size one have eleven
  // digits; those of deal.II's functions have eight.
  Tensor<2, 2>
  gradient_of(const Function<2> &u, const Point<2> &p)
  {
    constexpr double h = 1e-4;
    Tensor<2, 2>     gradient;
    for (unsigned int c = 0; c < 2; ++c)
      for (unsigned int d = 0; d < 2; ++d)
        {
          const auto value = [&](const double step) {
            Point<2> q = p;
            q[d] += step;
            return u.value(q, c);
          };
          gradient[c][d] =
            (8. * (value(h) - value(-h)) - (value(2 * h) - value(-2 * h))) /
            (12. * h);
        }
    return gradient;
  }



  Errors
  measure(const NestedIteration<2> &iteration, const double power_of_pressure)
  {
    const Discretization<2> &d        = iteration.discretization();
    const Function<2>       &exact    = *iteration.scene().exact_displacement();
    const Material          &material = iteration.scene().materials().base();
    const bool mean = material.volumetric_strain() == VolumetricStrain::mean;

    const QGauss<2>                    quadrature(4);
    FEValues<2>                        fe_values(d.mapping(),
                          d.dof_handler().get_fe(),
                          quadrature,
                          update_gradients | update_quadrature_points |
                            update_JxW_values);
    std::vector<SymmetricTensor<2, 2>> strains(quadrature.size());
    Errors                             errors = {};
    for (const auto &cell : d.dof_handler().active_cell_iterators())
      {
        fe_values.reinit(cell);
        fe_values[FEValuesExtractors::Vector(0)]
          .get_function_symmetric_gradients(iteration.displacement(), strains);
        double theta = 0.;
        for (const unsigned int q : fe_values.quadrature_point_indices())
          theta += trace(strains[q]) * fe_values.JxW(q) / cell->measure();
        for (const unsigned int q : fe_values.quadrature_point_indices())
          {
            const Tensor<2, 2> gradient =
              gradient_of(exact, fe_values.quadrature_point(q));
            const SymmetricTensor<2, 2> e = symmetrize(gradient) - strains[q];
            const double volumetric = mean ? trace(gradient) - theta : trace(e);
            errors.shear += 2. * material.mu() * (e * e) * fe_values.JxW(q);
            errors.energy +=
              material.lambda() * volumetric * volumetric * fe_values.JxW(q);
          }
      }
    errors.energy = std::sqrt(errors.energy + errors.shear);
    errors.shear  = std::sqrt(errors.shear);

    for (const ContactNode<2> &node : d.contact())
      errors.pressure +=
        node.measure *
        std::pow(
          normal_component(node, iteration.report().residual) / node.measure -
            0.05 * std::pow(std::max(node.point[0] - 1, 0.), power_of_pressure),
          2);
    errors.pressure = std::sqrt(errors.pressure);
    errors.estimate = iteration.estimate().total;

    check_below(std::abs(compute_exact_error(d.mapping(),
                                             d.dof_handler(),
                                             iteration.scene().materials(),
                                             exact,
                                             iteration.displacement())
                             .energy /
                           errors.energy -
                         1.),
                1e-8,
                "  the library measures the same error");
    return errors;
  }



  std::vector<Errors>
  solve(const std::string       &scene,
        const double             power_of_pressure,
        std::vector<std::string> overrides)
  {
    std::cout << scene;
    for (const std::string &override_text : overrides)
      std::cout << ", " << override_text;
    std::cout << std::endl;

    // What takes least time on these small meshes.
    overrides.insert(overrides.end(),
                     {"Refinement/Levels=2",
                      "Solver/Inner tolerance=1e-9",
                      "Solver/Smoothing steps=10",
                      "Solver/Coarse smoothing steps=10",
                      "Solver/Recombined steps=10"});
    NestedIteration<2> iteration(without_safeguards(
      read_parameters(SCENES_DIR "/" + scene + ".prm", overrides)));
    iteration.begin();
    std::vector<Errors> errors;
    do
      {
        iteration.solve();
        check(iteration.report().converged, "  converges");
        errors.push_back(measure(iteration, power_of_pressure));
    } while (iteration.advance());
    return errors;
  }



  void
  check_orders(const std::vector<Errors> &errors)
  {
    for (unsigned int level = 1; level < errors.size(); ++level)
      {
        const Errors &coarse = errors[level - 1], &fine = errors[level];
        check_below(std::abs(std::log2(coarse.energy / fine.energy) - 1.),
                    0.05,
                    "  energy error order 1");
        check_below(std::abs(std::log2(coarse.shear / fine.shear) - 1.),
                    0.05,
                    "  error of the shear order 1");
        // On the coarsest mesh the zone in contact is eight cells long, and it
        // takes one refinement more to see the order of the pressure there.
        if (level > 1)
          check_below(std::abs(std::log2(coarse.pressure / fine.pressure) - 2.),
                      0.3,
                      "  nodal pressure order 2");
        check(fine.estimate > fine.energy && fine.estimate < 10. * fine.energy,
              "  estimated error above the true one, less than ten times");
      }
  }
} // namespace test_incompressible

TEST(incompressible)
{
  const std::string mean      = "Material/Volumetric strain=mean",
                    pointwise = "Material/Volumetric strain=pointwise",
                    nu        = "Material/Poisson ratio=";

  check_orders(solve("manufactured", 2, {mean}));

  const auto at_03 = solve("incompressible", 3, {mean, nu + "0.3"});
  check_orders(at_03);
  const auto at_04999 = solve("incompressible", 3, {mean, nu + "0.4999"});
  check_orders(at_04999);
  const auto locked = solve("incompressible", 3, {pointwise, nu + "0.4999"});

  std::cout << "on the finest mesh" << std::endl;
  check_below(at_04999.back().shear / at_03.back().shear,
              1.2,
              "the error of the shear is that of 0.3");
  check_below(10. * at_04999.back().energy,
              locked.back().energy,
              "pointwise the energy error is ten times as large");
  check_below(2. * at_04999.back().shear,
              locked.back().shear,
              "the error of the shear twice as large");
  check_below(10. * at_04999.back().pressure,
              locked.back().pressure,
              "the error of the contact pressure ten times as large");
}

// Other materials in regions of the body. A layered block that slides on the
// obstacle has a displacement that is linear in each layer, so that finite
// elements find it up to rounding if faces of the mesh lie between the layers,
// however much their stiffness differs, and so that nothing is left to
// estimate; one material too few or in the wrong cell would show in every
// number. Regions are given by a condition, by physical ids, and by names.

#include <common/algorithms/contact_solver.h>
#include <common/contact/contact_forces.h>
#include <common/estimate/contact_estimate.h>

#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_materials
{
  std::string
  number(const double value)
  {
    std::ostringstream text;
    text.precision(17);
    text << value;
    return text.str();
  }



  // Two layers, and one in between that is given by what the others leave.
  struct Layers
  {
    std::string what;
    double      lower, upper; ///< Young's moduli, the middle one is 1
    double      nu;           ///< of the upper one
    std::string kind = "pointwise";
    double      F    = .3;

    // By how much stiffnesses differ.
    double
    ratio() const
    {
      return std::max({lower, 1., upper}) / std::min({lower, 1., upper});
    }
  };

  constexpr double lower_end = .25, upper_begin = .5, pressure = .01,
                   slip = .05;

  // Uniaxial strain and shear: stresses are the same everywhere, strains are
  // theirs divided by the stiffness of the layer. It is built up from the
  // bottom, with the expressions of a scene.
  template <int dim>
  std::vector<std::string>
  entries(const Layers &layers)
  {
    const Material lower(layers.lower, .2), middle(1., .3),
      upper(layers.upper, layers.nu);
    const auto profile = [&](const double                stress,
                             const std::array<double, 3> moduli) {
      const std::string h = (dim == 2 ? "y" : "z");
      return "(" + number(stress / moduli[0]) + "*min(" + h + "," +
        number(lower_end) + ") + " + number(stress / moduli[1]) +
        "*max(0,min(" + h + "," + number(upper_begin) + ")-" +
        number(lower_end) + ") + " + number(stress / moduli[2]) + "*max(0," +
        h + "-" + number(upper_begin) + "))";
    };
    const auto P = [](const Material &m) { return m.lambda() + 2. * m.mu(); };
    const std::string u_x = number(slip) + " + " +
      profile(layers.F * pressure, {{lower.mu(), middle.mu(), upper.mu()}});
    const std::string u_n =
      profile(-pressure, {{P(lower), P(middle), P(upper)}});
    const std::string u = u_x + (dim == 2 ? ", " : ", 0, ") + u_n;

    // What holds the body back sideways, and shears it.
    const std::string height   = dim == 2 ? "y" : "z";
    const auto        of_layer = [&](const auto &value) {
      return "if(" + height + "<" + number(lower_end) + "," +
        number(value(lower)) + ",if(" + height + "<" + number(upper_begin) +
        "," + number(value(middle)) + "," + number(value(upper)) + "))";
    };
    const std::string push =
      of_layer([&](const Material &m) { return pressure * m.lambda() / P(m); });
    const std::string shear = number(layers.F * pressure);
    std::string       traction;
    if (dim == 2)
      traction = "0: " + push + ", -" + shear + "; 1: -" + push + ", " + shear;
    else
      traction = "0: " + push + ", 0, -" + shear + "; 1: -" + push + ", 0, " +
        shear + "; 2: 0, " + push + ", 0; 3: 0, -" + push + ", 0";
    return {"Scene/Exact displacement=" + u,
            "Boundary conditions/Displacement=" + std::to_string(2 * dim - 1) +
              ": " + u,
            "Boundary conditions/Traction=" + traction,
            "Material/Young's modulus=1",
            "Material/Poisson ratio=.3",
            "Material/Volumetric strain=" + layers.kind,
            "Contact/Boundary id=" + std::to_string(2 * dim - 2),
            "Contact/Friction coefficient=" + number(layers.F),
            "Obstacle/Kind=plane",
            "Solver/Inner tolerance=1e-13"};
  }



  // On a mesh with hanging nodes, in all layers and between them.
  template <int dim>
  void
  compare(const Parameters  &parameters,
          const Layers      &layers,
          const std::string &what)
  {
    const Scene<dim> scene(parameters);
    auto             mesh = make_triangulation<dim>();
    scene.make_coarse_mesh(*mesh);
    for (unsigned int step = 0; step < (dim == 2 ? 2 : 1); ++step)
      {
        unsigned int n = 0;
        for (const auto &cell : mesh->active_cell_iterators())
          if (n++ % 7 == 3)
            cell->set_refine_flag();
        mesh->execute_coarsening_and_refinement();
      }
    const Discretized<dim> d(scene, *mesh);
    VectorType             u = admissible_start(d);
    ContactState           state(d.contact().size(), true);
    ContactSolver<dim>     solver(d, parameters.solver);
    const SolverReport     report = solver.solve(u, state);
    d.interpolate_hanging_nodes(u);

    Vector<double> exact(dim);
    double         error = 0, size = 0;
    const auto     points = node_points(d);
    for (unsigned int i = 0; i < points.size(); ++i)
      {
        scene.exact_displacement()->vector_value(points[i], exact);
        for (unsigned int c = 0; c < dim; ++c)
          {
            error = std::max(error,
                             std::abs(u.local_element(dim * i + c) - exact[c]));
            size  = std::max(size, std::abs(exact[c]));
          }
      }
    double wrong_pressure = 0;
    for (const ContactNode<dim> &node : d.contact())
      wrong_pressure = std::max(
        wrong_pressure,
        std::abs(normal_component(node, report.residual) / node.measure -
                 pressure));
    VectorType tractions =
      contact_tractions(d.contact(), report.residual, state);
    d.interpolate_hanging_nodes(tractions);
    const ErrorEstimate estimate = estimate_contact_error(d, u, tractions);

    std::cout << what << std::endl;
    check(report.converged, "converges");
    // Rounding of displacements is relative to the softest material, that of
    // stresses to the stiffest. The row of a node has dim 3^dim terms, and the
    // rounding of their sum is about the root of their number.
    const double rounding = std::sqrt(dim * std::pow(3., dim)) *
      std::numeric_limits<double>::epsilon();
    check_below(
      error / size, std::max(1e-10, rounding * layers.ratio()), "displacement");
    check_below(wrong_pressure / pressure, 1e-7, "pressure");
    check_below(estimate.relative(),
                std::max(1e-6, 1e-11 * layers.ratio()),
                "nothing is left to estimate");
  }



  template <int dim>
  Parameters
  block(const std::vector<std::string> &more)
  {
    const std::string name = "materials-test.prm";
    std::ofstream(name) << "# All is said by the overrides.\n";
    return read_parameters(name, more);
  }



  template <int dim>
  void
  layered_blocks()
  {
    for (const Layers &layers :
         {Layers{"softer and stiffer", .1, 10., .2},
          Layers{
            "a stiff sole", 1e6, 1e-1, .3, "pointwise", dim == 2 ? .3 : 0.},
          Layers{"a stiff cover", .1, 1e6, .3},
          Layers{"a soft sole", 1e-6, 1., .1},
          Layers{"an incompressible cover", 1., 5., .49, "mean"}})
      {
        auto              all    = entries<dim>(layers);
        const std::string height = dim == 2 ? "y" : "z";
        all.push_back(dim == 2 ? "Scene/Subdivisions=3, 4"
                               : "Scene/Subdivisions=2, 1, 4");
        all.push_back("Material/Regions=where " + height + " < " +
                      number(lower_end) + ": " + number(layers.lower) +
                      ", .2; where (" + height + " > " + number(upper_begin) +
                      "): " + number(layers.upper) + ", " + number(layers.nu));
        compare<dim>(
          block<dim>(all), layers, std::to_string(dim) + "D, " + layers.what);
      }
  }



  // The same block as a mesh file, whose groups have ids and, two of them,
  // names.
  void
  mesh_file()
  {
    std::ofstream file("materials-test.msh");
    file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
         << "$PhysicalNames\n2\n2 7 \"sole\"\n2 9 \"the cover\"\n"
         << "$EndPhysicalNames\n$Nodes\n20\n";
    for (unsigned int i = 0; i < 20; ++i)
      file << i + 1 << ' ' << (i % 4) / 3. << ' ' << (i / 4) / 4. << " 0\n";
    file << "$EndNodes\n$Elements\n26\n";
    unsigned int n = 0;
    for (unsigned int row = 0; row < 4; ++row)
      for (unsigned int i = 0; i < 3; ++i)
        {
          const unsigned int first = 4 * row + i + 1;
          file << ++n << " 3 2 "
               << (row == 0     ? 7
                     : row == 1 ? 8
                                : 9)
               << " 1 " << first << ' ' << first + 1 << ' ' << first + 5 << ' '
               << first + 4 << '\n';
        }
    const auto line =
      [&](const unsigned int id, const unsigned int a, const unsigned int b) {
        file << ++n << " 1 2 " << id << " 1 " << a << ' ' << b << '\n';
      };
    for (unsigned int i = 0; i < 3; ++i)
      {
        line(2, i + 1, i + 2);
        line(3, i + 17, i + 18);
      }
    for (unsigned int row = 0; row < 4; ++row)
      {
        line(10, 4 * row + 1, 4 * row + 5);
        line(1, 4 * row + 4, 4 * row + 8);
      }
    file << "$EndElements\n";
    file.close();

    const Layers layers{"", 20., 3., .1};
    auto         all = entries<2>(layers);
    for (std::string &entry : all)
      if (entry.find("Traction=0: ") != std::string::npos)
        entry.replace(entry.find("=0: "), 4, "=10: ");
    all.push_back("Scene/Geometry=mesh file");
    all.push_back("Scene/Mesh file=materials-test.msh");
    for (const std::string sole : {"7", "sole"})
      {
        auto entries = all;
        entries.push_back("Material/Regions=" + sole +
                          ": 20, .2; the cover: 3*E, .1");
        compare<2>(
          block<2>(entries), layers, "mesh file, region '" + sole + "'");
      }
  }



  // Of several regions the last counts; a region follows its scene when that is
  // turned; and without regions nothing is asked.
  void
  which_one()
  {
    std::cout << "which one" << std::endl;
    const Scene<2> scene(
      block<2>({"Scene/Subdivisions=4, 4",
                "Scene/Rotation angle=90",
                "Boundary conditions/Displacement=0: 0, 0",
                "Material/Regions=0: 2, .3; where x > .5: 3, .3; "
                "where y > .5: 4, .3, mean"}));
    auto mesh = make_triangulation<2>();
    scene.make_coarse_mesh(*mesh);
    const Materials<2> &materials = scene.materials();
    unsigned int        n_wrong   = 0;
    for (const auto &cell : mesh->active_cell_iterators())
      {
        // Turned by a right angle, (x, y) lies where (-y, x) has been.
        const double x = cell->center()[1], y = -cell->center()[0];
        n_wrong += materials.of(cell).youngs_modulus() !=
          (y > .5     ? 4.
             : x > .5 ? 3.
                      : 2.);
        n_wrong += (materials.of(cell).volumetric_strain() ==
                    VolumetricStrain::mean) != (y > .5);
      }
    check(n_wrong == 0, "the last of several regions, in a turned scene");
    check(materials.uses_means() && !materials.is_homogeneous() &&
            materials.base().youngs_modulus() == 1.,
          "the material of no region");
    check(Materials<2>(Material(1., .3)).is_homogeneous(),
          "a body of one material");
  }
} // namespace test_materials



TEST(materials)
{
  layered_blocks<2>();
  layered_blocks<3>();
  mesh_file();
  which_one();
}

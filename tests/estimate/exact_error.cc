// The error against an exact solution, in closed form, in any unit of length:
// the displacement is zero, and the exact one k x^2 in x direction, on a square
// and a cube of size s. Its strains are 2 k x, so that the square of the energy
// norm is (lambda + 2 mu) 4 k^2 s^(d+2) / 3.

#include <common/discretization/discretization.h>
#include <common/estimate/exact_error.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>

#include <tests/support/check.h>
#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;
using namespace Tests;

namespace test_exact_error
{
  template <int dim>
  void
  test(const double s)
  {
    const double       k = .01 / s;
    std::ostringstream exact;
    exact.precision(17);
    exact << k << "*x^2" << (dim == 2 ? ", 0*x" : ", 0*x, 0*x");
    std::ofstream scene_file("scene.prm");
    scene_file.precision(17);
    scene_file << "subsection Scene\n"
               << "  set Size = " << s << ", " << s
               << (dim == 3 ? ", " + Utilities::to_string(s) : std::string())
               << "\n"
               << "  set Exact displacement = " << exact.str() << "\n"
               << "end\n"
               << "subsection Boundary conditions\n"
               << "  set Displacement = 0: 0, 0" << (dim == 3 ? ", 0" : "")
               << "\nend\n";
    scene_file.close();
    const Parameters parameters = read_parameters("scene.prm");
    const Scene<dim> scene(parameters);
    const auto       mesh = make_triangulation<dim>(MPI_COMM_WORLD);
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(2);
    Discretization<dim> d(scene, *mesh);
    d.set_up();
    VectorType u = d.vector();
    d.interpolate_hanging_nodes(u);

    const Material  &material = scene.materials().base();
    const ExactError error    = compute_exact_error(d.mapping(),
                                                 d.dof_handler(),
                                                 scene.materials(),
                                                 *scene.exact_displacement(),
                                                 u);
    const double     expected =
      std::sqrt((material.lambda() + 2. * material.mu()) * 4. / 3.) * k *
      std::pow(s, .5 * dim + 1.);
    check_below(std::abs(error.energy / expected - 1.), 1e-8, "energy norm");
    check_below(std::abs(error.node / (k * s * s) - 1.), 1e-12, "nodes");
    check_below(std::abs(error.node_size / (k * s * s) - 1.),
                1e-12,
                "the largest displacement");
  }
} // namespace test_exact_error

TEST(exact_error)
{
  using namespace test_exact_error;
  for (const double s : {1e-3, 1., 1e9})
    {
      std::cout << "size " << s << std::endl;
      test<2>(s);
      test<3>(s);
    }
}

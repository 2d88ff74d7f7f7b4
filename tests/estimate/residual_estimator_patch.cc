// A displacement that is linear in each coordinate, in sliding contact with
// Coulomb friction: with matching tractions nothing is left to estimate, on any
// mesh. Each traction that is left out appears in its share and in no other,
// with the value known in closed form.

#include <common/estimate/residual_estimator.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>

#include <deal.II/grid/grid_generator.h>

#include <deal.II/numerics/vector_tools_interpolate.h>

#include <iostream>

#include <tests/support/material_of.h>
#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;

namespace test_residual_estimator_patch
{
  constexpr double lambda      = 0.75;
  constexpr double mu          = 0.5;
  constexpr double friction    = 0.4;
  constexpr double compression = 0.1;

  constexpr double pressure = (lambda + 2 * mu) * compression;
  constexpr double shear    = friction * pressure;

  // Sheared by friction over its whole base y=0, on which it slides by 0.3.
  template <int dim>
  class Displacement : public Function<dim>
  {
  public:
    Displacement()
      : Function<dim>(dim)
    {}

    double
    value(const Point<dim> &p, const unsigned int c) const override
    {
      return c == 0 ? 0.3 + shear / mu * p[1]
        : c == 1    ? -compression * p[1]
                    : 0.;
    }
  };



  template <int dim>
  std::vector<double>
  components(const Tensor<1, dim> &tensor)
  {
    std::vector<double> result;
    for (unsigned int d = 0; d < dim; ++d)
      result.push_back(tensor[d]);
    return result;
  }



  template <int dim>
  Tensor<1, dim>
  traction(const Tensor<1, dim> &normal)
  {
    SymmetricTensor<2, dim> stress =
      -lambda * compression * unit_symmetric_tensor<dim>();
    stress[1][1] = -pressure;
    stress[0][1] = shear;
    return stress * normal;
  }



  template <int dim>
  void
  test()
  {
    // One refinement of cubes, one vertex of which is moved so that the cells
    // are not parallelograms, and then hanging nodes on the base.
    Triangulation<dim> coarse;
    GridGenerator::subdivided_hyper_cube(coarse, 2, 0., 1., true);
    for (const auto &cell : coarse.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        if (!cell->at_boundary() || cell->vertex(v).distance([]() {
              Point<dim> centre;
              for (unsigned int c = 0; c < dim; ++c)
                centre[c] = 0.5;
              return centre;
            }()) < 1e-10)
          {
            cell->vertex(v)[0] += 0.1;
            cell->vertex(v)[1] -= 0.07;
          }
    parallel::distributed::Triangulation<dim> triangulation(MPI_COMM_WORLD);
    triangulation.copy_triangulation(coarse);
    triangulation.begin_active()->set_refine_flag();
    triangulation.execute_coarsening_and_refinement();
    triangulation.begin_active()->set_refine_flag();
    triangulation.execute_coarsening_and_refinement();

    const FESystem<dim> fe(FE_Q<dim>(1), dim);
    DoFHandler<dim>     dof_handler(triangulation);
    dof_handler.distribute_dofs(fe);

    const MappingQ1<dim> mapping;
    VectorType           u, t, n, g;
    for (auto *const vector : {&u, &t, &n, &g})
      vector->reinit(dof_handler.locally_owned_dofs(), MPI_COMM_WORLD);

    // All nodal vectors may well be given everywhere.
    Tensor<1, dim> normal;
    normal[1]                    = -1.;
    const Tensor<1, dim> on_base = traction(normal);

    const Functions::ConstantFunction<dim> base_traction(components(on_base));
    const Functions::ConstantFunction<dim> base_normal(components(normal));
    VectorTools::interpolate(mapping, dof_handler, Displacement<dim>(), u);
    VectorTools::interpolate(mapping, dof_handler, base_traction, t);
    VectorTools::interpolate(mapping, dof_handler, base_normal, n);

    EstimatorProblem<dim> problem(material_of(lambda, mu));
    problem.contact[2]             = {};
    problem.contact[2].coefficient = friction;
    problem.dirichlet[3]           = ComponentMask(dim, true);

    std::vector<Functions::ConstantFunction<dim>> sides;
    sides.reserve(2 * dim);
    for (unsigned int f = 0; f < 2 * dim; ++f)
      {
        Tensor<1, dim> n;
        n[f / 2]               = f % 2 == 0 ? -1. : 1.;
        const Tensor<1, dim> t = traction(n);
        sides.emplace_back(components(t));
        if (f != 2 && f != 3)
          problem.tractions[f] = &sides[f];
      }

    EstimatorContact contact;
    contact.traction   = &t;
    contact.normal     = &n;
    contact.gap_vector = &g;

    const auto print = [&](const std::string &what) {
      const ErrorEstimate e =
        estimate_error(mapping, dof_handler, problem, u, contact);
      const auto clean = [](const double x) { return x < 1e-14 ? 0. : x; };
      std::cout << what << ":\n  interior " << clean(e.interior) << ", jumps "
                << clean(e.jumps) << ", tractions " << clean(e.tractions)
                << ", contact " << clean(e.contact) << ", complementarity "
                << clean(e.complementarity) << std::endl;
    };

    std::cout << dim << "D, " << triangulation.n_active_cells() << " cells"
              << std::endl;
    const ErrorEstimate e =
      estimate_error(mapping, dof_handler, problem, u, contact);
    std::cout << "squared relative error below 1e-14: "
              << (e.relative() * e.relative() < 1e-14 ? "yes" : "no")
              << std::endl
              << "energy norm squared " << e.energy_norm * e.energy_norm
              << ", exact " << pressure * compression + shear * shear / mu
              << std::endl;

    print("all matching");

    double expected = 0.;
    for (const auto &cell : triangulation.active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == 0)
          expected += cell->face(f)->diameter() * cell->face(f)->measure() *
            traction(Point<dim>::unit_vector(0)).norm_square() / (2. * mu);
    problem.tractions.erase(0);
    print("one side left free");
    std::cout << "  expected tractions " << expected << std::endl;

    // The tangential part of the tractions there is now accounted for, since
    // sliding along is prescribed.
    std::vector<bool> all_but_normal(dim, true);
    all_but_normal[0]    = false;
    problem.dirichlet[0] = ComponentMask(all_but_normal);
    print("its tangential displacement given");
    problem.dirichlet[0] = ComponentMask(dim, true);
    print("its displacement given");

    problem.contact[2].coefficient = 2 * friction;
    print("twice the friction");
    std::cout << "  expected complementarity " << shear * 0.3 << std::endl;
    problem.contact[2].coefficient = friction;

    g = n;
    print("a gap of one");
    std::cout << "  expected complementarity " << pressure << std::endl;
    g = 0.;

    // What pushes on the base from outside takes half from the obstacle.
    t *= .5;
    const Functions::ConstantFunction<dim> half(components(.5 * on_base));
    problem.tractions[2] = &half;
    print("half of the contact stress given");
    problem.tractions.erase(2);

    contact.traction = nullptr;
    print("no contact stress");
  }
} // namespace test_residual_estimator_patch

TEST(residual_estimator_patch)
{
  test<2>();
  test<3>();
}

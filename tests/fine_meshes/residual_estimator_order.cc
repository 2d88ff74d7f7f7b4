// A smooth displacement with known body force, interpolated on meshes with
// hanging nodes: the estimate falls with order 1 and keeps its ratio to the
// true error; it does not care for the unit of stress; it grows as the material
// becomes incompressible, but no faster than the norm of the stiffness; the
// bound from below is one, for such materials and for cells that are much
// longer than wide, whichever way the solution varies; and a symmetric problem
// has a symmetric estimate.

#include <common/estimate/residual_estimator.h>

#include <deal.II/base/function.h>
#include <deal.II/base/quadrature_lib.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>

#include <deal.II/grid/grid_generator.h>

#include <deal.II/lac/affine_constraints.h>

#include <deal.II/numerics/vector_tools_interpolate.h>

#include <iomanip>
#include <iostream>

#include <tests/support/material_of.h>
#include <tests/support/test.h>

using namespace dealii;
using namespace Friction;

namespace test_residual_estimator_order
{
  // Component c is the plane wave $\sin(k_c\cdot x)$.
  template <int dim>
  class Waves : public Function<dim>
  {
  public:
    // How often the waves go up and down in each direction.
    using Scale = Tensor<1, dim>;

    static Scale
    one()
    {
      Scale scale;
      for (unsigned int d = 0; d < dim; ++d)
        scale[d] = 1.;
      return scale;
    }

    explicit Waves(const Scale &scale)
      : Function<dim>(dim)
    {
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int d = 0; d < dim; ++d)
          wave[c][d] = scale[d] * (1. + 0.5 * ((c + 2 * d) % 3));
    }

    double
    value(const Point<dim> &p, const unsigned int c) const override
    {
      return std::sin(wave[c] * p);
    }

    SymmetricTensor<2, dim>
    strain(const Point<dim> &p) const
    {
      Tensor<2, dim> gradient;
      for (unsigned int c = 0; c < dim; ++c)
        gradient[c] = std::cos(wave[c] * p) * wave[c];
      return symmetrize(gradient);
    }

    Tensor<2, dim>
    hessian_of_component(const Point<dim> &p, const unsigned int c) const
    {
      return -std::sin(wave[c] * p) * outer_product(wave[c], wave[c]);
    }

  private:
    Tensor<1, dim> wave[dim];
  };



  template <int dim>
  class BodyForce : public Function<dim>
  {
  public:
    BodyForce(const Waves<dim> &u, const double lambda, const double mu)
      : Function<dim>(dim)
      , u(u)
      , lambda(lambda)
      , mu(mu)
    {}

    double
    value(const Point<dim> &p, const unsigned int c) const override
    {
      double f = -mu * trace(u.hessian_of_component(p, c));
      for (unsigned int d = 0; d < dim; ++d)
        f -= (lambda + mu) * u.hessian_of_component(p, d)[d][c];
      return f;
    }

  private:
    const Waves<dim> u;
    const double     lambda, mu;
  };



  // The traction on a face whose outer normal is given.
  template <int dim>
  class Traction : public Function<dim>
  {
  public:
    Traction(const Waves<dim>     &u,
             const double          lambda,
             const double          mu,
             const Tensor<1, dim> &normal)
      : Function<dim>(dim)
      , u(u)
      , lambda(lambda)
      , mu(mu)
      , normal(normal)
    {}

    double
    value(const Point<dim> &p, const unsigned int c) const override
    {
      const SymmetricTensor<2, dim> strain = u.strain(p);
      return (2. * mu * strain * normal + lambda * trace(strain) * normal)[c];
    }

  private:
    const Waves<dim>     u;
    const double         lambda, mu;
    const Tensor<1, dim> normal;
  };



  template <int dim>
  ErrorEstimate
  estimate(const parallel::distributed::Triangulation<dim> &triangulation,
           const double                                     youngs_modulus,
           const double                                     nu,
           double                                          &true_error,
           const typename Waves<dim>::Scale &scale = Waves<dim>::one())
  {
    const double lambda = youngs_modulus * nu / ((1 + nu) * (1 - 2 * nu));
    const double mu     = youngs_modulus / (2 * (1 + nu));

    const FESystem<dim> fe(FE_Q<dim>(1), dim);
    DoFHandler<dim>     dof_handler(triangulation);
    dof_handler.distribute_dofs(fe);
    AffineConstraints<double> constraints;
    DoFTools::make_hanging_node_constraints(dof_handler, constraints);
    constraints.close();

    Tensor<1, dim> down, right;
    down[1]  = -1.;
    right[0] = 1.;
    const Waves<dim>     exact(scale);
    const BodyForce<dim> body_force(exact, lambda, mu);
    const Traction<dim>  base(exact, lambda, mu, down),
      side(exact, lambda, mu, right);

    const MappingQ1<dim> mapping;
    VectorType           u, t;
    u.reinit(dof_handler.locally_owned_dofs(), MPI_COMM_WORLD);
    t.reinit(u);
    VectorTools::interpolate(mapping, dof_handler, exact, u);
    VectorTools::interpolate(mapping, dof_handler, base, t);
    constraints.distribute(u);
    constraints.distribute(t);

    EstimatorProblem<dim> problem(material_of(lambda, mu));
    problem.body_force   = &body_force;
    problem.tractions[1] = &side;
    problem.contact[2]   = {};
    for (const unsigned int id : {0, 3, 4, 5})
      problem.dirichlet[id] = ComponentMask(dim, true);
    EstimatorContact contact;
    contact.traction = &t;

    FEValues<dim>                        fe_values(mapping,
                            fe,
                            QGauss<dim>(4),
                            update_gradients | update_quadrature_points |
                              update_JxW_values);
    std::vector<SymmetricTensor<2, dim>> strains(fe_values.n_quadrature_points);
    double                               square = 0.;
    for (const auto &cell : dof_handler.active_cell_iterators())
      {
        fe_values.reinit(cell);
        fe_values[FEValuesExtractors::Vector(0)]
          .get_function_symmetric_gradients(u, strains);
        for (const unsigned int q : fe_values.quadrature_point_indices())
          {
            const SymmetricTensor<2, dim> error =
              strains[q] - exact.strain(fe_values.quadrature_point(q));
            square += (2. * mu * (error * error) +
                       lambda * trace(error) * trace(error)) *
              fe_values.JxW(q);
          }
      }
    true_error = std::sqrt(square);

    return estimate_error(mapping, dof_handler, problem, u, contact);
  }



  template <int dim>
  void
  test_order(const unsigned int n_levels)
  {
    std::cout << dim << "D" << std::endl
              << "   cells  estimate  order  efficiency" << std::endl;

    parallel::distributed::Triangulation<dim> triangulation(MPI_COMM_WORLD);
    GridGenerator::hyper_cube(triangulation, 0., 1., true);
    triangulation.refine_global(1);
    triangulation.begin_active()->set_refine_flag();
    triangulation.execute_coarsening_and_refinement();

    double previous = 0.;
    for (unsigned int level = 0; level < n_levels; ++level)
      {
        triangulation.refine_global(1);
        double              true_error = 0.;
        const ErrorEstimate e = estimate(triangulation, 1., 0.3, true_error);
        std::cout << std::setw(8) << triangulation.n_active_cells()
                  << std::fixed << std::setprecision(4) << std::setw(10)
                  << e.total << std::setprecision(2) << std::setw(7)
                  << (level > 0 ? std::log2(previous / e.total) : 0.)
                  << std::setw(12) << e.total / true_error << std::endl;
        previous = e.total;
      }

    for (const double E : {1e-10, 1e10})
      {
        double              true_error = 0.;
        const ErrorEstimate e = estimate(triangulation, E, 0.3, true_error);
        std::cout << "Young's modulus times " << std::scientific
                  << std::setprecision(0) << E
                  << ": estimate times its square root: "
                  << (std::abs(e.total / std::sqrt(E) - previous) <
                          1e-10 * previous
                        ? "yes"
                        : "no")
                  << std::endl;
      }

    std::cout << "estimate and bound from below over the error" << std::endl;
    for (const double nu : {-0.5, 0., 0.3, 0.49, 0.4999})
      {
        double              true_error = 0.;
        const ErrorEstimate e = estimate(triangulation, 1., nu, true_error);
        std::cout << "Poisson ratio " << std::defaultfloat
                  << std::setprecision(4) << std::setw(6) << nu << std::fixed
                  << std::setprecision(1) << std::setw(6)
                  << e.total / true_error << std::setprecision(2)
                  << std::setw(6) << e.lower_bound / true_error << std::endl;
      }
  }



  // Cells that are short in one direction, and waves that are much shorter in
  // that one, as long as in the others, or do without it altogether: what
  // matters is in the first case how wide cells are, in the others how long.
  template <int dim>
  void
  test_stretched()
  {
    std::cout << dim << "D, stretched cells: estimate and bound from below over"
              << " the error" << std::endl;
    for (const double aspect : {10., 100.})
      for (const unsigned int direction : {0u, dim - 1u})
        {
          parallel::distributed::Triangulation<dim> triangulation(
            MPI_COMM_WORLD);
          Point<dim> corner;
          for (unsigned int d = 0; d < dim; ++d)
            corner[d] = d == direction ? 1. / aspect : 1.;
          GridGenerator::hyper_rectangle(
            triangulation, Point<dim>(), corner, true);
          triangulation.refine_global(dim == 2 ? 4 : 3);
          for (const double scale : {aspect, 1., 0.})
            {
              typename Waves<dim>::Scale scales = Waves<dim>::one();
              scales[direction]                 = scale;
              double              true_error    = 0.;
              const ErrorEstimate e =
                estimate(triangulation, 1., 0.3, true_error, scales);
              std::cout << "aspect ratio " << std::defaultfloat << std::setw(3)
                        << aspect << ", short in direction " << direction
                        << ", waves there " << std::setw(3) << scale
                        << std::fixed << std::setprecision(1) << std::setw(7)
                        << e.total / true_error << std::setprecision(2)
                        << std::setw(6) << e.lower_bound / true_error
                        << std::endl;
            }
        }
  }



  // The first component is the square of the distance: nearly the solution for
  // which the constant of the bound is the least possible. All of the boundary
  // is held.
  template <int dim>
  void
  test_constant()
  {
    constexpr unsigned int                    n_refinements = dim == 2 ? 5 : 4;
    parallel::distributed::Triangulation<dim> triangulation(MPI_COMM_WORLD);
    GridGenerator::hyper_cube(triangulation, 0., 1., true);
    triangulation.refine_global(n_refinements);
    const FESystem<dim> fe(FE_Q<dim>(1), dim);
    DoFHandler<dim>     dof_handler(triangulation);
    dof_handler.distribute_dofs(fe);
    const MappingQ1<dim> mapping;
    VectorType           u;
    u.reinit(dof_handler.locally_owned_dofs(), MPI_COMM_WORLD);
    const VectorFunctionFromScalarFunctionObject<dim> square(
      [](const Point<dim> &p) { return p.square(); }, 0, dim);
    VectorTools::interpolate(mapping, dof_handler, square, u);

    for (const double nu : {0., 0.3, 0.4999})
      {
        const double mu = 1., lambda = 2. * mu * nu / (1. - 2. * nu);
        // It is $-\mu\Delta u-(\lambda+\mu)\nabla\operatorname{div}u$.
        std::vector<double> force(dim);
        force[0] = -2. * dim * mu - 2. * (lambda + mu);
        const Functions::ConstantFunction<dim> body_force(force);
        EstimatorProblem<dim>                  problem(material_of(lambda, mu));
        problem.body_force = &body_force;
        for (unsigned int id = 0; id < 2 * dim; ++id)
          problem.dirichlet[id] = ComponentMask(dim, true);
        const ErrorEstimate e =
          estimate_error(mapping, dof_handler, problem, u, EstimatorContact());

        // On a cell of width h the interpolant lacks $\sum_dx_d(x_d-h)$ in the
        // first component, with derivatives $2x_d-h$ whose squares are $h^2/3$
        // in the mean.
        const double h     = std::pow(.5, n_refinements);
        const double error = h * std::sqrt((lambda + (dim + 1) * mu) / 3.);
        std::cout << dim << "D, x^2+..., Poisson ratio " << std::defaultfloat
                  << std::setprecision(4) << nu
                  << ": bound from below over the error " << std::fixed
                  << std::setprecision(2) << e.lower_bound / error
                  << (e.lower_bound < error ? "" : ", TOO LARGE") << std::endl;
      }
  }



  // Symmetric about $x=1/2$: the first component is odd, the others are even.
  template <int dim>
  class Symmetric : public Function<dim>
  {
  public:
    Symmetric()
      : Function<dim>(dim)
    {}

    double
    value(const Point<dim> &p, const unsigned int c) const override
    {
      const double x = p[0] - 0.5;
      return c == 0 ? x * p[1] * p[1] : std::cos(x) * p[1] * p[dim - 1];
    }
  };



  template <int dim>
  void
  test_symmetry()
  {
    parallel::distributed::Triangulation<dim> triangulation(MPI_COMM_WORLD);
    GridGenerator::hyper_cube(triangulation, 0., 1., true);
    triangulation.refine_global(2);
    for (const auto &cell : triangulation.active_cell_iterators())
      if (std::abs(cell->center()[0] - 0.5) < 0.25 && cell->center()[1] < 0.5)
        cell->set_refine_flag();
    triangulation.execute_coarsening_and_refinement();

    const FESystem<dim> fe(FE_Q<dim>(1), dim);
    DoFHandler<dim>     dof_handler(triangulation);
    dof_handler.distribute_dofs(fe);
    AffineConstraints<double> constraints;
    DoFTools::make_hanging_node_constraints(dof_handler, constraints);
    constraints.close();

    const MappingQ1<dim> mapping;
    VectorType           u, t;
    u.reinit(dof_handler.locally_owned_dofs(), MPI_COMM_WORLD);
    t.reinit(u);
    VectorTools::interpolate(mapping, dof_handler, Symmetric<dim>(), u);
    constraints.distribute(u);

    EstimatorProblem<dim> problem(material_of(1., 1.));
    problem.contact[2]   = {};
    problem.dirichlet[3] = ComponentMask(dim, true);
    EstimatorContact contact;
    contact.traction = &t;
    const ErrorEstimate e =
      estimate_error(mapping, dof_handler, problem, u, contact);

    double difference = 0.;
    for (const auto &cell : triangulation.active_cell_iterators())
      for (const auto &other : triangulation.active_cell_iterators())
        {
          Point<dim> mirrored = other->center();
          mirrored[0]         = 1. - mirrored[0];
          if (mirrored.distance(cell->center()) < 1e-10)
            difference = std::max<double>(
              difference,
              std::abs(e.cell_errors(cell->active_cell_index()) -
                       e.cell_errors(other->active_cell_index())));
        }
    const double total_of_cells = e.cell_errors.l2_norm();
    std::cout << dim << "D, symmetric: "
              << (difference < 1e-6 * e.cell_errors.linfty_norm() ? "yes"
                                                                  : "no")
              << ", total is that of the cells: "
              << (std::abs(total_of_cells - e.total) < 1e-5 * e.total ? "yes"
                                                                      : "no")
              << std::endl;
  }
} // namespace test_residual_estimator_order

TEST(residual_estimator_order)
{
  test_order<2>(5);
  test_order<3>(3);
  test_constant<2>();
  test_constant<3>();
  test_stretched<2>();
  test_stretched<3>();
  test_symmetry<2>();
  test_symmetry<3>();
}

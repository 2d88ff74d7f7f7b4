#include <common/compatibility.h>
#include <common/discretization/volumetric_strain.h>
#include <common/estimate/exact_error.h>
#include <common/parallel/collective_error.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/symmetric_tensor.h>

#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

namespace Friction
{
  using namespace dealii;

  bool
  ExactError::is_exact() const
  {
    return node <= 1e-10 * node_size;
  }



  std::string
  ExactError::describe(const double last_energy) const
  {
    std::ostringstream text;
    text << std::scientific << std::setprecision(2)
         << "         error against the exact solution: energy norm " << energy;
    if (last_energy > 0 && !is_exact())
      text << std::fixed << " (order " << std::log2(last_energy / energy) << ")"
           << std::scientific;
    if (is_exact())
      text << ", nodes exact to 1e-10";
    else
      text << ", nodes " << (node_size > 0. ? node / node_size : node)
           << (node_size > 0. ? " of the largest" : "");
    return text.str();
  }



  namespace
  {
    // By central differences. A step that does not go with the lengths of the
    // scene, as that of deal.II's FunctionParser, would be good in some units
    // only. One that goes with the shortest edge of the cell stays inside of
    // it, and is exact enough unless cells are very thin.
    template <int dim>
    Tensor<2, dim>
    gradient_of(const Function<dim> &u, const Point<dim> &p, const double step)
    {
      Tensor<2, dim> gradient;
      Vector<double> before(dim), after(dim);
      for (unsigned int d = 0; d < dim; ++d)
        {
          Point<dim> a = p, b = p;
          a[d] -= step;
          b[d] += step;
          u.vector_value(a, before);
          u.vector_value(b, after);
          for (unsigned int c = 0; c < dim; ++c)
            gradient[c][d] = (after[c] - before[c]) / (b[d] - a[d]);
        }
      return gradient;
    }
  } // namespace



  template <int dim>
  ExactError
  compute_exact_error(const Mapping<dim>    &mapping,
                      const DoFHandler<dim> &dof_handler,
                      const Materials<dim>  &materials,
                      const Function<dim>   &exact,
                      const VectorType      &u_h)
  {
    const VolumetricStrainField<dim> volumetric_strain(
      mapping, dof_handler, materials, u_h);

    const QGauss<dim>                    quadrature(4);
    FEValues<dim>                        fe_values(mapping,
                            dof_handler.get_fe(),
                            quadrature,
                            update_gradients | update_quadrature_points |
                              update_JxW_values);
    const FEValuesExtractors::Vector     displacement(0);
    std::vector<SymmetricTensor<2, dim>> strains(quadrature.size());
    Vector<double>                       value(dim);

    // A value that is no finite number is an error of all processes.
    const MPI_Comm communicator = Compatibility::mpi_communicator(dof_handler);
    double         square = 0, node = 0, node_size = 0;
    on_all_processes(communicator, [&]() {
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            fe_values.reinit(cell);
            const Material &material = materials.of(cell);
            fe_values[displacement].get_function_symmetric_gradients(u_h,
                                                                     strains);
            for (const unsigned int q : fe_values.quadrature_point_indices())
              {
                const Tensor<2, dim> gradient =
                  gradient_of(exact,
                              fe_values.quadrature_point(q),
                              1e-4 * cell->minimum_vertex_distance());
                const SymmetricTensor<2, dim> e =
                  symmetrize(gradient) - strains[q];
                const double theta = trace(gradient) -
                  volumetric_strain.value(cell, material, trace(strains[q]));
                square += (material.lambda() * theta * theta +
                           2. * material.mu() * (e * e)) *
                  fe_values.JxW(q);
              }
            for (const unsigned int v : cell->vertex_indices())
              {
                exact.vector_value(cell->vertex(v), value);
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    node = std::max(
                      node,
                      std::abs(value[d] - u_h(cell->vertex_dof_index(v, d))));
                    node_size = std::max(node_size, std::abs(value[d]));
                  }
              }
          }
    });
    return {std::sqrt(Utilities::MPI::sum(square, communicator)),
            Utilities::MPI::max(node, communicator),
            Utilities::MPI::max(node_size, communicator)};
  }



  template ExactError compute_exact_error(const Mapping<2> &,
                                          const DoFHandler<2> &,
                                          const Materials<2> &,
                                          const Function<2> &,
                                          const VectorType &);
  template ExactError compute_exact_error(const Mapping<3> &,
                                          const DoFHandler<3> &,
                                          const Materials<3> &,
                                          const Function<3> &,
                                          const VectorType &);
} // namespace Friction

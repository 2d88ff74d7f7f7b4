#include <common/discretization/volumetric_strain.h>

#include <deal.II/base/quadrature_lib.h>

namespace Friction
{
  using namespace dealii;

  template <int dim>
  void
  shape_volumetric_strains(const FEValues<dim>      &fe_values,
                           const Material           &material,
                           Table<2, Tensor<1, dim>> &theta)
  {
    theta.reinit(fe_values.dofs_per_cell, fe_values.n_quadrature_points);
    for (unsigned int a = 0; a < fe_values.dofs_per_cell; ++a)
      {
        double         volume = 0.;
        Tensor<1, dim> integral;
        for (const unsigned int q : fe_values.quadrature_point_indices())
          {
            theta(a, q) = fe_values.shape_grad(a, q);
            volume += fe_values.JxW(q);
            integral += theta(a, q) * fe_values.JxW(q);
          }
        if (material.volumetric_strain() == VolumetricStrain::mean)
          for (const unsigned int q : fe_values.quadrature_point_indices())
            theta(a, q) = integral / volume;
      }
  }



  template <int dim>
  VolumetricStrainField<dim>::VolumetricStrainField(
    const Mapping<dim>    &mapping,
    const DoFHandler<dim> &dof_handler,
    const Materials<dim>  &materials,
    const VectorType      &displacement)
  {
    if (!materials.uses_means())
      return;

    // Both body and displacement are linear in each coordinate of the unit
    // cell, so that two points per direction, all of the same weight, integrate
    // Jacobian and divergence exactly. FEValues would take several times as
    // long.
    constexpr unsigned int n_corners = GeometryInfo<dim>::vertices_per_cell;
    const QGauss<dim>      quadrature(2);
    std::vector<std::array<Tensor<1, dim>, n_corners>> shape_gradients;
    for (const Point<dim> &point : quadrature.get_points())
      {
        shape_gradients.emplace_back();
        for (unsigned int v = 0; v < n_corners; ++v)
          shape_gradients.back()[v] =
            GeometryInfo<dim>::d_linear_shape_function_gradient(point, v);
      }
    Assert(dof_handler.get_fe().degree == 1, ExcNotImplemented());
    means.resize(dof_handler.get_triangulation().n_active_cells());
    std::array<Tensor<1, dim>, n_corners> values;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial() &&
          materials.of(cell).volumetric_strain() == VolumetricStrain::mean)
        {
          const auto vertices = mapping.get_vertices(cell);
          for (unsigned int v = 0; v < n_corners; ++v)
            for (unsigned int c = 0; c < dim; ++c)
              values[v][c] = displacement(cell->vertex_dof_index(v, c));
          double volume = 0., integral = 0.;
          for (const auto &gradients : shape_gradients)
            {
              Tensor<2, dim> jacobian, gradient;
              for (unsigned int v = 0; v < n_corners; ++v)
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    jacobian[d] += vertices[v][d] * gradients[v];
                    gradient[d] += values[v][d] * gradients[v];
                  }
              const double determinant_here = determinant(jacobian);
              volume += determinant_here;
              integral += trace(gradient * invert(jacobian)) * determinant_here;
            }
          means[cell->active_cell_index()] = integral / volume;
        }
  }



  template void shape_volumetric_strains(const FEValues<2> &,
                                         const Material &,
                                         Table<2, Tensor<1, 2>> &);
  template void shape_volumetric_strains(const FEValues<3> &,
                                         const Material &,
                                         Table<2, Tensor<1, 3>> &);
  template class VolumetricStrainField<2>;
  template class VolumetricStrainField<3>;
} // namespace Friction

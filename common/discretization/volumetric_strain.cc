#include <common/discretization/multilinear_cell.h>
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
    // Jacobian and divergence exactly.
    const QGauss<dim> quadrature(2);
    Assert(dof_handler.get_fe().degree == 1, ExcNotImplemented());
    means.resize(dof_handler.get_triangulation().n_active_cells());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial() &&
          materials.of(cell).volumetric_strain() == VolumetricStrain::mean)
        {
          const Multilinear::CellValues<dim> values =
            Multilinear::cell_values(mapping, cell, displacement);
          double volume = 0., integral = 0.;
          for (const Point<dim> &p : quadrature.get_points())
            {
              const Multilinear::PointOfCell<dim> here(values, p);
              volume += here.determinant;
              integral += trace(here.gradient) * here.determinant;
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

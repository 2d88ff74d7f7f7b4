#ifndef friction_discretization_elasticity_h
#define friction_discretization_elasticity_h

#include <common/parameters/material.h>

#include <deal.II/fe/fe_values.h>

#include <deal.II/lac/full_matrix.h>

#include <functional>

namespace Friction
{
  /**
   * Computes the matrix of a cell: the bilinear form of each pair of shape
   * functions. FEValues is that of the cell, with gradients, quadrature points
   * and weights; the matrix has the right size and is zero.
   */
  template <int dim>
  using CellForm = std::function<void(const dealii::FEValues<dim> &,
                                      dealii::FullMatrix<double> &)>;

  /**
   * The bilinear form of linear elasticity,
   * @f[
   *   a(u,v)=\int \lambda\,\theta(u)\,\theta(v)
   *          + 2\mu\,\varepsilon(u):\varepsilon(v),
   * @f]
   * with the volumetric strain of shape_volumetric_strains().
   */
  template <int dim>
  CellForm<dim> elasticity(const Material &material);
} // namespace Friction

#endif

#ifndef friction_discretization_elasticity_h
#define friction_discretization_elasticity_h

#include <common/discretization/cell_form.h>
#include <common/scene/materials.h>

namespace Friction
{
  /**
   * The bilinear form of linear elasticity,
   * @f[
   *   a(u,v)=\int \lambda\,\theta(u)\,\theta(v)
   *          + 2\mu\,\varepsilon(u):\varepsilon(v),
   * @f]
   * with the volumetric strain of shape_volumetric_strains().
   */
  template <int dim>
  CellForm<dim> elasticity(const Materials<dim> &materials);
} // namespace Friction

#endif

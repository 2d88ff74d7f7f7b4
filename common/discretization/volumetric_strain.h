#ifndef friction_discretization_volumetric_strain_h
#define friction_discretization_volumetric_strain_h

#include <common/parallel/vector_type.h>
#include <common/scene/materials.h>

#include <deal.II/base/table.h>
#include <deal.II/base/tensor.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/fe_values.h>

#include <vector>

namespace Friction
{
  /**
   * The volumetric strain of each shape function at each quadrature point of
   * the present cell, for the assembly of
   * @f[
   *   a(u,v)=\int \lambda\,\theta(u)\,\theta(v)
   *          + 2\mu\,\varepsilon(u):\varepsilon(v).
   * @f]
   * With VolumetricStrain::pointwise it is $\theta(v)=\mathrm{div}\,v$. If the
   * material is nearly incompressible, $\lambda\gg\mu$, this asks of a bilinear
   * displacement to have no divergence at any of the four or eight points of
   * each cell, and next to nothing but rigid motions is left: the elements
   * lock. With VolumetricStrain::mean (<i>mean dilatation</i>)
   * @f[
   *   \theta(v)|_K = \frac1{|K|}\int_K\mathrm{div}\,v,
   * @f]
   * only the volume of each cell is kept. It is the displacement that the mixed
   * method with constant pressures in the cells finds (Malkus and Hughes,
   * Comput. Methods Appl. Mech. Engrg. 15, 1978). On parallelograms the mean is
   * the value in the middle, and so this is selective reduced integration
   * there; on other cells it is better, for a patch of constant stress remains
   * exact.
   *
   * Only the term with $\lambda$ is averaged, not also the share of the
   * volumetric strain in $2\mu\,\varepsilon:\varepsilon$, as in the B-bar
   * method (Hughes, Int. J. Numer. Methods Engrg. 15, 1980). What locks is the
   * term that grows without bound, the other differs by terms of the size of
   * $\mu$; and as it is here, no displacement has less than its energy of
   * shear, $2\mu\|\varepsilon(v)\|^2$, which Korn's inequality and with it the
   * error estimator rely on, and which keeps hourglass modes away.
   *
   * @param fe_values  of the scalar element, see CellForm.
   * @param theta      one row per vertex, one column per point; component c is
   *                   the volumetric strain of that vertex' shape function in
   *                   direction c.
   */
  template <int dim>
  void
  shape_volumetric_strains(const dealii::FEValues<dim>              &fe_values,
                           const Material                           &material,
                           dealii::Table<2, dealii::Tensor<1, dim>> &theta);



  /**
   * The volumetric strain of a discrete displacement: what has to be multiplied
   * by $\lambda$ wherever stresses or energies are computed. It costs nothing
   * where it is pointwise.
   */
  template <int dim>
  class VolumetricStrainField
  {
  public:
    using CellIterator = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /** @param displacement with ghost values and hanging nodes interpolated. */
    VolumetricStrainField(const dealii::Mapping<dim>    &mapping,
                          const dealii::DoFHandler<dim> &dof_handler,
                          const Materials<dim>          &materials,
                          const VectorType              &displacement);

    /** In a cell that is not artificial, of this material, at a point with this
     * divergence. */
    double
    value(const CellIterator &cell,
          const Material     &material,
          const double        divergence) const
    {
      return material.volumetric_strain() == VolumetricStrain::pointwise
        ? divergence
        : means[cell->active_cell_index()];
    }

  private:
    // One per active cell; none if no material needs them.
    std::vector<double> means;
  };
} // namespace Friction

#endif

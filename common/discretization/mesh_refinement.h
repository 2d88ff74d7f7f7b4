#ifndef friction_discretization_mesh_refinement_h
#define friction_discretization_mesh_refinement_h

#include <common/discretization/discretization.h>

#include <deal.II/grid/tria.h>

#include <vector>

namespace Friction
{
  /**
   * Refines all cells, so many times. Throws InputError if there is not enough
   * memory for that, see check_that_mesh_fits(). Collective.
   */
  template <int dim>
  void refine_uniformly(Triangulation<dim> &mesh, const unsigned int times);

  /**
   * Refines the cells of @p mesh that are flagged, sets up @p discretization
   * anew (without assembling), and interpolates vectors to the new mesh.
   * Throws InputError if there is not enough memory. Collective.
   *
   * @param mesh     that of the discretisation. Cells are not coarsened.
   * @param vectors  on the leaf mesh, with ghosts that are up to date; on
   *                 return with the layout of the new one.
   */
  template <int dim>
  void refine_mesh(Triangulation<dim>              &mesh,
                   Discretization<dim>             &discretization,
                   const std::vector<VectorType *> &vectors);
} // namespace Friction

#endif

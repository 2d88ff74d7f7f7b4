#ifndef friction_estimate_marking_h
#define friction_estimate_marking_h

#include <common/contact/contact_state.h>
#include <common/discretization/discretization.h>

#include <deal.II/grid/tria.h>

#include <deal.II/lac/vector.h>

namespace Friction
{
  /**
   * Set the refinement flag of all cells with $\eta_K\ge\theta\max_L\eta_L$.
   * Returns the number of cells marked on all processes: none if all errors are
   * 0.
   *
   * Cells whose errors differ by rounding only are treated alike, so
   * that a symmetric problem keeps a symmetric mesh.
   *
   * @param cell_errors $\eta_K\ge0$, one value per active cell.
   * @param theta       between 0 and 1; smaller values mark more cells.
   */
  template <int dim>
  unsigned int mark_by_maximum(dealii::Triangulation<dim>  &triangulation,
                               const dealii::Vector<float> &cell_errors,
                               const double                 theta);

  /**
   * Sets the refinement flag of every cell at the boundary that has a vertex in
   * contact. Returns whether there is one on any process.
   */
  template <int dim>
  bool mark_contact_zone(const Discretization<dim> &discretization,
                         const ContactState        &state);
} // namespace Friction

#endif

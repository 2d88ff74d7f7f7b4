#ifndef friction_estimate_contact_estimate_h
#define friction_estimate_contact_estimate_h

#include <common/discretization/contact_boundary.h>
#include <common/contact/contact_state.h>
#include <common/estimate/residual_estimator.h>
#include <common/scene/scene.h>

#include <deal.II/lac/affine_constraints.h>

namespace Friction
{
  /**
   * Estimates the error of the solution of a scene: estimate_error() with all
   * that it wants to know.
   *
   * Between the nodes the laws of contact hold only approximately. To measure
   * this, the estimator needs normals and gaps as fields on $\Gamma_S$: the
   * distance that is left where there is pressure, and the work of friction
   * that is missing where something slides. The field of gaps is that of the
   * vectors $g(p)\,n(p)$, which can be interpolated like displacements. The
   * work is that of Coulomb's law; for Tresca's the coefficient is zero here,
   * and this one term is left out.
   *
   * @param displacement, tractions  with ghost values and hanging nodes
   *        interpolated.
   */
  template <int dim>
  ErrorEstimate
  estimate_contact_error(const Scene<dim>                &scene,
                         const Mapping<dim>              &mapping,
                         const DoFHandler<dim>           &dof_handler,
                         const AffineConstraints<double> &hanging,
                         const NodalConstraints<dim>     &constraints,
                         const ContactBoundary<dim>      &contact_boundary,
                         const VectorType                &displacement,
                         const VectorType                &tractions);

  /**
   * Sets the refinement flag of every cell at the boundary that has a vertex in
   * contact. Returns whether there is one.
   */
  template <int dim>
  bool mark_contact_zone(const DoFHandler<dim>       &dof_handler,
                         const NodalConstraints<dim> &constraints,
                         const ContactBoundary<dim>  &contact_boundary,
                         const ContactState          &state);
} // namespace Friction

#endif

#ifndef friction_estimate_contact_estimate_h
#define friction_estimate_contact_estimate_h

#include <common/discretization/discretization.h>
#include <common/estimate/residual_estimator.h>

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
  estimate_contact_error(const Discretization<dim> &discretization,
                         const VectorType          &displacement,
                         const VectorType          &tractions);
} // namespace Friction

#endif

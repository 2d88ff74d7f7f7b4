#ifndef friction_estimate_residual_estimator_h
#define friction_estimate_residual_estimator_h

#include <common/parallel/vector_type.h>
#include <common/scene/materials.h>

#include <deal.II/base/function.h>
#include <deal.II/base/types.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/component_mask.h>
#include <deal.II/fe/mapping.h>

#include <deal.II/lac/vector.h>

#include <map>

namespace Friction
{
  /**
   * What the estimator has to know of the elastic contact problem. Functions
   * are referred to, not copied, and have dim components.
   */
  template <int dim>
  struct EstimatorProblem
  {
    /** A body without loads, held nowhere. */
    explicit EstimatorProblem(const Materials<dim> &materials)
      : materials(materials)
    {}

    /// What the body is made of (2D: plane strain).
    Materials<dim> materials;

    /// Force per volume; none if not given.
    const dealii::Function<dim> *body_force = nullptr;

    /// Prescribed tractions (force per area, acting on the body).
    std::map<dealii::types::boundary_id, const dealii::Function<dim> *>
      tractions;

    /// Which components of the displacement are prescribed where. The others
    /// are free of traction, or have the one above. The same holds for
    /// boundaries that are mentioned nowhere.
    std::map<dealii::types::boundary_id, dealii::ComponentMask> dirichlet;

    /// A coefficient of friction, for the dissipation in the sliding zone.
    struct ContactFriction
    {
      double coefficient = 0.;

      /// Where it is not the same everywhere, instead of that; none if not
      /// given.
      const dealii::Function<dim> *varying_coefficient = nullptr;
    };

    /// The boundary ids of $\Gamma_S$.
    std::map<dealii::types::boundary_id, ContactFriction> contact;
  };



  /**
   * What is known of the contact boundary at the solution. All vectors belong
   * to the DoFHandler of the displacement, with ghost values and hanging nodes
   * interpolated; outside of $\Gamma_S$ they are not looked at.
   */
  struct EstimatorContact
  {
    /// Nodal contact tractions: force on the body over nodal measure; see
    /// contact_tractions().
    const VectorType *traction = nullptr;

    /// The unit normals $n(p)$, and the vectors $g(p)\,n(p)$ from the node to
    /// the obstacle. Without them the complementarity terms are left out.
    const VectorType *normal     = nullptr;
    const VectorType *gap_vector = nullptr;

    /// In later load steps, the displacement that friction counts slip from.
    const VectorType *slip_origin = nullptr;
  };



  struct ErrorEstimate
  {
    /// $\eta_K$, one per active cell; 0 on cells of other processes, and where
    /// it is nothing but rounding, so that no cell is refined because of it.
    dealii::Vector<float> cell_errors;

    /// $\left(\sum_K\eta_K^2\right)^{1/2}$ over all processes.
    double total = 0.;

    /**
     * What the error is at least, as far as the mesh can tell, up to the
     * oscillation of the data: what remains of the sum if each residual is
     * divided by the most that it can be for an error of one. That is smaller
     * where $\lambda$ is large, by $2\mu/(\lambda+2\mu)$ in the square, and
     * where cells are flat, by the ratio of the width of the cell to the length
     * of the side on which the residual is, and the square of that for what is
     * inside of the cell (G. Kunert, Numer. Math. 86, 2000). The whole is
     * divided by 7, or in three dimensions by 9.3, which is enough for squares
     * and cubes (see the tests). What remains of the contact laws between nodes
     * is left out: nothing says what it is at most.
     */
    double lower_bound = 0.;

    /// $\sqrt{a(u_h,u_h)}$, to measure @p total against.
    double energy_norm = 0.;

    /// The shares in the square of @p total: where the error comes from.
    double interior        = 0.;
    double jumps           = 0.;
    double tractions       = 0.;
    double contact         = 0.;
    double complementarity = 0.;

    /// Estimated error relative to the solution.
    double relative() const;
  };



  /**
   * Residual-based estimate of the error in the energy norm.
   * @f{align*}{
   *   \eta_K^2 = \frac1{2\mu}\Big(
   *      & h_K^2\,\|f+\operatorname{div}\sigma_h\|_K^2
   *        + \tfrac12\sum_{e\subset\partial K\cap\Omega}
   *          h_e\,\|[\sigma_hn]\|_e^2
   *        + \sum_{e\subset\Gamma_N}h_e\,\|t-\sigma_hn\|_e^2
   *        + \sum_{e\subset\Gamma_S}h_e\,\|t_h+t-\sigma_hn\|_e^2 \Big) \\
   *      & + \sum_{e\subset\Gamma_S}\int_e p_h\,(g-u_{h,n})_+
   *        + \big(F p_h|u_{h,T}|+t_{h,T}\cdot u_{h,T}\big)_+ ,
   * @f}
   * with $h$ the diameters of cells and faces. The first line is Verfürth's
   * estimator for elasticity (A Posteriori Error Estimation Techniques for
   * Finite Element Methods, 2013, chapter 4). On the contact boundary the
   * multiplier $t_h$, the nodal contact tractions interpolated linearly, is
   * added to the prescribed traction, zero as a rule, and what remains of the
   * contact laws between the nodes, $u_{h,T}$ counted from where friction does,
   * is added (Hild and Nicaise, Numer. Math. 101, 2005, for contact; Krause,
   * Veeser and Walloth, Numer. Math. 130, 2015, for the distinction between the
   * discrete contact force and the boundary stress). $p_h=-t_h\cdot n$.
   *
   * Where materials meet the $\mu$ of an edge is the larger one of both sides
   * (Bernardi and Verfürth, Numer. Math. 85, 2000).
   *
   * The factor $1/(2\mu)$ turns squared stresses into energies, so the relative
   * estimate does not depend on the units of the scene. With it rather than
   * $1/(\lambda+2\mu)$ the bound from above holds uniformly in $\lambda$, since
   * $2\mu\|\varepsilon(v)\|^2\le a(v,v)$; the price is overestimation as
   * $\nu\to\frac12$, by up to $\sqrt{(\lambda+2\mu)/(2\mu)}$. For linear
   * elasticity the estimate is a bound up to a constant that depends on
   * the shape of the cells only, and for contact without friction the like is
   * known; for Coulomb's law there is no such theorem, and the estimate is a
   * guide to refinement. On uniform meshes of squares and cubes the
   * ratio to the true error is about 7 and 9 for $\nu=0.3$ (see the tests).
   *
   * With VolumetricStrain::mean $\sigma_h$ has the mean $\theta_h$ of the
   * divergence over the cell in it. The sum then has one more term,
   * $2\mu\|\operatorname{div}u_h-\theta_h\|_K^2$, booked as interior: by how
   * much the displacement violates what the pressure says of it, as in
   * estimators for the mixed method.
   *
   * A hanging face is integrated over its smaller parts and shared by
   * the cells on both sides, like every other interior face.
   *
   * @param mapping      of degree 1: cells have straight edges.
   * @param displacement with ghost values and hanging nodes interpolated.
   */
  template <int dim>
  ErrorEstimate
  estimate_error(const dealii::Mapping<dim>    &mapping,
                 const dealii::DoFHandler<dim> &dof_handler,
                 const EstimatorProblem<dim>   &problem,
                 const VectorType              &displacement,
                 const EstimatorContact        &contact = EstimatorContact());
} // namespace Friction

#endif

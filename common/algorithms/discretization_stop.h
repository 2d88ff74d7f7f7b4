#ifndef friction_algorithms_discretization_stop_h
#define friction_algorithms_discretization_stop_h

#include <common/parameters/solver_settings.h>
#include <common/scene/materials.h>

#include <deal.II/base/types.h>

namespace Friction
{
  /**
   * Says when a solution is as good as its mesh: when the error of the
   * iteration is a tenth of that of the discretisation, so that going on would
   * change the sum of both by half a percent.
   *
   * The error of the discretisation is that of the residual estimator, divided
   * by the most that this may be larger. A residual is at most the error times
   * the norm of the stiffness, so that squared stresses divided by
   * $\lambda+2\mu$ are a bound from below up to a constant that depends on the
   * shape of the cells; the estimator divides them by $2\mu$. For squares the
   * constant is 6, for cubes 8 (see the tests of the estimator), and the most
   * it overestimates that times $\sqrt{(\lambda+2\mu)/(2\mu)}$: 7.9 for squares
   * and a Poisson ratio of 0.3, and 300 for 0.4999. With several materials it
   * is the largest of theirs. Where the estimate is better than that, the
   * iteration goes on a little longer.
   *
   * It is not known before the mesh has been solved. So that of the mesh before
   * is taken, scaled by the rate at which errors fall with the number of
   * unknowns, $N^{-1/d}$, and halved, since the first meshes may do better than
   * that.
   *
   * Two increments say how large the error of the iteration is. Where a mesh
   * has taken as many cycles, their contraction is what is expected of the next
   * one, and there one cycle may be enough; of the one after that the double is
   * expected, and so on.
   */
  template <int dim>
  class DiscretizationStop
  {
  public:
    /** Does nothing unless the settings say so. */
    DiscretizationStop(const SolverSettings &settings,
                       const Materials<dim> &materials);

    /** The settings to solve the next mesh with.
     * @param n_dofs  number of unknowns on it. */
    SolverSettings
    settings_for(const dealii::types::global_dof_index n_dofs) const;

    /** Is told of a mesh that has been solved: all of them, in their order.
     * @param estimated_error  an energy norm; zero if it is not known.
     * @param n_dofs           number of unknowns.
     * @param contraction      of the increments per cycle; zero if there was
     *                         but one. */
    void add_level(const double                          estimated_error,
                   const dealii::types::global_dof_index n_dofs,
                   const double                          contraction);

  private:
    const SolverSettings            settings;
    const double                    overestimation;
    double                          error = 0; // energy norm; unknown if zero
    dealii::types::global_dof_index n_dofs_then = 0;
    double                          pace        = 0; // unknown if zero
  };
} // namespace Friction

#endif

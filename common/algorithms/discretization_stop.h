#ifndef friction_algorithms_discretization_stop_h
#define friction_algorithms_discretization_stop_h

#include <common/parameters/solver_settings.h>
#include <deal.II/base/types.h>

namespace Friction
{
  /** The tolerance that the certificates of all levels of a run have: that of
   * the settings, or a hundredth where the mesh says when to stop and that is
   * more. */
  double loosest_certificate_tolerance(const SolverSettings &settings);



  /**
   * Says when a solution is as good as its mesh: when the error of the
   * iteration is a tenth of that of the discretisation, so that going on would
   * change the whole error, the root of the sum of both squares, by half a
   * percent.
   *
   * The error of the discretisation is taken to be the least that the residual
   * estimator allows for, ErrorEstimate::lower_bound, and not its estimate,
   * which may be many times the error: for squares 6.9 times with a Poisson
   * ratio of 0.3, 300 times with 0.4999, and 350 times where cells are a
   * hundred times as long as wide. Where the estimate is better than that, the
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
    explicit DiscretizationStop(const SolverSettings &settings);

    /** The settings to solve the next mesh with.
     * @param n_dofs  number of unknowns on it. */
    SolverSettings
    settings_for(const dealii::types::global_dof_index n_dofs) const;

    /** Is told of a mesh that has been solved: all of them, in their order.
     * @param error_of_level  an energy norm, ErrorEstimate::lower_bound; zero
     *                        if it is not known.
     * @param n_dofs          number of unknowns.
     * @param contraction     of the increments per cycle, SolverReport::pace;
     *                        zero if it is not known. */
    void add_level(const double                          error_of_level,
                   const dealii::types::global_dof_index n_dofs,
                   const double                          contraction);

  private:
    const SolverSettings            settings;
    double                          error = 0; // energy norm; unknown if zero
    dealii::types::global_dof_index n_dofs_then = 0;
    double                          pace        = 0; // unknown if zero
  };
} // namespace Friction

#endif

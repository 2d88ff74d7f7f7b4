#include <common/algorithms/discretization_stop.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  namespace
  {
    // The share of the iteration in the error.
    constexpr double share = .1;

    // How much better than expected a mesh may be.
    constexpr double caution = .5;
  } // namespace



  // Where the iteration stops early, stresses at single nodes are known less
  // well than the energy. An error of a percent of the peak pressure is not
  // what the mesh is to be blamed for, more is.
  double
  loosest_certificate_tolerance(const SolverSettings &settings)
  {
    return settings.stop_at_discretization
      ? std::max(settings.certificate_tolerance, 1e-2)
      : settings.certificate_tolerance;
  }



  template <int dim>
  DiscretizationStop<dim>::DiscretizationStop(const SolverSettings &settings)
    : settings(settings)
  {}



  template <int dim>
  SolverSettings
  DiscretizationStop<dim>::settings_for(
    const dealii::types::global_dof_index n_dofs) const
  {
    SolverSettings result = settings;
    if (settings.stop_at_discretization && error > 0)
      {
        result.energy_tolerance = caution * share * error *
          std::pow(double(n_dofs_then) / double(n_dofs), 1. / dim);
        result.expected_pace         = pace;
        result.certificate_tolerance = loosest_certificate_tolerance(settings);
      }
    return result;
  }



  // The first mesh begins with nothing, which says little about those that
  // begin with what a coarser one has found. What has not been seen on the last
  // mesh is trusted less, until a mesh takes a second cycle again.
  template <int dim>
  void
  DiscretizationStop<dim>::add_level(
    const double                          error_of_level,
    const dealii::types::global_dof_index n_dofs,
    const double                          contraction)
  {
    if (n_dofs_then > 0)
      pace = contraction > 0 ? contraction : std::min(.5, 2. * pace);
    error       = error_of_level;
    n_dofs_then = n_dofs;
  }



  template class DiscretizationStop<2>;
  template class DiscretizationStop<3>;
} // namespace Friction

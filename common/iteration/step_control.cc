#include <common/iteration/step_control.h>
#include <common/parallel/owned_values.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <array>

namespace Friction
{
  namespace
  {
    // Steps that have to be shortened to less than this are suspicious.
    constexpr double short_step = .1;
  } // namespace



  template <int dim>
  void
  StepControl<dim>::improve(VectorType &,
                            const Iterate &,
                            const VectorType &,
                            const Truncation<dim> &)
  {}



  template <int dim>
  FullStep<dim>::FullStep(const TrescaFunctional<dim> &functional)
    : functional(functional)
  {}



  template <int dim>
  double
  FullStep<dim>::advance(Iterate &x, VectorType &v)
  {
    functional.project(v, x.u, 1.);
    add_owned(x.u, 1., v);
    return 1.;
  }



  template <int dim>
  LineSearch<dim>::LineSearch(const TrescaFunctional<dim> &functional,
                              const double                 largest_step,
                              const unsigned int           recombined_steps)
    : functional(functional)
    , problem(functional.discrete_problem())
    , largest_step(largest_step)
    , recombination(problem, recombined_steps)
  {}



  template <int dim>
  void
  LineSearch<dim>::begin()
  {
    recombination.clear();
  }



  template <int dim>
  void
  LineSearch<dim>::improve(VectorType            &v,
                           const Iterate         &x,
                           const VectorType      &r,
                           const Truncation<dim> &truncation)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::line_search);
    vAv = problem.stiffness.energy_product(v);
    recombination.improve(v, vAv, x, r, truncation);
  }



  template <int dim>
  void
  LineSearch<dim>::replace(const VectorType &v)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::line_search);
    vAv = problem.stiffness.energy_product(v);
  }



  // The correction keeps its size, and lengths are all relative to it: scaling
  // it would be one more pass over a vector.
  template <int dim>
  double
  LineSearch<dim>::advance(Iterate &x, VectorType &v)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::line_search);

    // Where a node would have to reverse its slip, the linearisation knows
    // nothing of what comes. A single such node would hold up all others in the
    // line search; it rather stops, and the relaxation decides how it goes on.
    const ContactValues before    = contact_values(v);
    const unsigned int  n_stopped = functional.keep_slip(v, x.u, x.state);
    Products            products  = products_along(v, x.residual, n_stopped);
    const bool          stopped   = products.n_changed > 0;
    if (stopped)
      {
        vAv      = problem.stiffness.energy_product(v);
        products = products_along(v, x.residual, 0);
      }
    if (!(products.curvature > 0))
      return 0.;
    double length = functional.minimize_along(
      v, x, products.slope, products.curvature, largest_step);
    const bool cut_off = true_on_any_process(
      functional.project(v, x.u, length) > 0, problem.communicator());
    // The obstacle has cut the correction off: minimise along what is left of
    // it, as far as that is admissible.
    if (cut_off)
      length = minimize_within_obstacle(x, v, largest_step * length);
    if (length < short_step && (cut_off || stopped))
      length = try_whole_correction(x, v, length, before);
    add_owned(x.u, length, v);
    return length;
  }



  // The best length of v as far as it is admissible, and not more than the
  // largest.
  template <int dim>
  double
  LineSearch<dim>::minimize_within_obstacle(const Iterate    &x,
                                            const VectorType &v,
                                            const double      largest)
  {
    vAv                     = problem.stiffness.energy_product(v);
    const Products products = products_along(v, x.residual, 0);
    return functional.minimize_along(
      v,
      x,
      products.slope,
      products.curvature,
      functional.admissible_length(v, x.u, largest));
  }



  template <int dim>
  double
  LineSearch<dim>::energy_after(const Iterate    &x,
                                const VectorType &v,
                                const double      length)
  {
    VectorType Av(v), moved(x.u), r(x.residual);
    problem.stiffness.vmult(Av, v);
    add_owned(moved, length, v);
    add_owned(r, -length, Av);
    return functional.energy(moved, r, x.state);
  }



  // A correction that turns a long thin body around one end of its contact
  // boundary, and that has been changed at the other end, is no longer a
  // rotation, and the body is far too stiff for what it has become: hardly
  // anything is left of it. It is better to go all of it, but only until the
  // next node touches; the line search knows what it costs that nodes reverse
  // their slip. Of the two steps the one is taken that lowers the energy more.
  //
  // On call v and length are the first step, and before what the correction has
  // been at contact nodes, which is all that has been changed of it; on return
  // v and the length are those of the better step.
  template <int dim>
  double
  LineSearch<dim>::try_whole_correction(const Iterate       &x,
                                        VectorType          &v,
                                        const double         length,
                                        const ContactValues &before)
  {
    VectorType whole(v);
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      std::copy(before[p].begin(),
                before[p].end(),
                whole.begin() + dim * problem.contact[p].node);
    const double other_length =
      minimize_within_obstacle(x, whole, largest_step);
    functional.project(whole, x.u, other_length);
    if (!(energy_after(x, whole, other_length) < energy_after(x, v, length)))
      return length;
    v.swap(whole);
    return other_length;
  }



  template <int dim>
  typename LineSearch<dim>::ContactValues
  LineSearch<dim>::contact_values(const VectorType &v) const
  {
    ContactValues values(problem.contact.size());
    for (unsigned int p = 0; p < values.size(); ++p)
      std::copy_n(
        v.begin() + dim * problem.contact[p].node, dim, values[p].begin());
    return values;
  }



  template <int dim>
  typename LineSearch<dim>::Products
  LineSearch<dim>::products_along(const VectorType  &v,
                                  const VectorType  &residual,
                                  const unsigned int n_changed) const
  {
    const std::array<double, 3> sums = sum_over_processes(
      std::array<double, 3>{{dot_owned(residual, v), vAv, 1. * n_changed}},
      problem.communicator());
    return {sums[0], sums[1], static_cast<std::size_t>(sums[2])};
  }



  template class StepControl<2>;
  template class StepControl<3>;
  template class FullStep<2>;
  template class FullStep<3>;
  template class LineSearch<2>;
  template class LineSearch<3>;
} // namespace Friction

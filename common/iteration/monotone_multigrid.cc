#include <common/iteration/monotone_multigrid.h>
#include <common/parallel/owned_values.h>
#include <common/parallel/reductions.h>

#include <array>
#include <vector>

namespace Friction
{
  // When a correction is corrected once more: after a step shorter than this
  // part of it, if more than this share of the nodes in contact would reverse
  // their slip.
  constexpr double shortened = .75, many_of_all = .1;



  template <int dim>
  MonotoneMultigrid<dim>::MonotoneMultigrid(
    const TrescaFunctional<dim> &functional,
    const MonotoneSmoother<dim> &smoother,
    Linearization<dim>          &linearization,
    Correction<dim>             &correction,
    StepControl<dim>            &step_control,
    const unsigned int           smoothing_steps)
    : energy(&functional)
    , smoother(&smoother)
    , linearization(&linearization)
    , correction(&correction)
    , step_control(&step_control)
    , smoothing_steps(smoothing_steps)
    , r(problem().constraints.partitioner())
    , v(r)
  {}



  template <int dim>
  MonotoneMultigrid<dim>
  MonotoneMultigrid<dim>::with(Linearization<dim> &other) const
  {
    MonotoneMultigrid result = *this;
    result.linearization     = &other;
    return result;
  }



  template <int dim>
  MonotoneMultigrid<dim>
  MonotoneMultigrid<dim>::with(Correction<dim> &other) const
  {
    MonotoneMultigrid result = *this;
    result.correction        = &other;
    return result;
  }



  template <int dim>
  MonotoneMultigrid<dim>
  MonotoneMultigrid<dim>::with(StepControl<dim> &other) const
  {
    MonotoneMultigrid result = *this;
    result.step_control      = &other;
    return result;
  }



  template <int dim>
  void
  MonotoneMultigrid<dim>::begin(Iterate &x)
  {
    step_control->begin();
    last_length = 1.;
    x.forget_step();
    smoother->relax(x, smoothing_steps, /*trust first normal forces =*/true);
  }



  template <int dim>
  double
  MonotoneMultigrid<dim>::iterate(Iterate &x)
  {
    linearization->update(x);
    correction->update(*linearization, x);
    linearization->linearize_residual(r, x);
    correction->apply(v, r);
    step_control->improve(v, x, r, linearization->truncation());
    correct_again(x);

    x.begin_step();
    last_length = step_control->advance(x, v);
    // Those behind this correction and those before the next one.
    smoother->relax(x, 2 * smoothing_steps);
    x.end_step();
    return last_length;
  }



  // A sliding node that would have to reverse its slip comes to rest, see
  // LineSearch. The correction has been computed as if it went on, and if these
  // are many nodes side by side, what is left has next to no sense: the body
  // has moved, its boundary stays, and the line search finds but a short step,
  // again and again. This is how a load step begins in which loads are turned:
  // what slid one way sticks. So in later load steps, if the last step was a
  // short one, and there are many such nodes, they are held where they come to
  // rest, which is a part of the correction, and the rest of it is corrected
  // once more. (From nothing at all, with phases that mean nothing, this makes
  // things worse.)
  template <int dim>
  void
  MonotoneMultigrid<dim>::correct_again(const Iterate &x)
  {
    if (problem().previous_displacement == nullptr ||
        last_length >= shortened || !x.state.has_friction() ||
        !step_control->finds_length())
      return;
    const std::vector<unsigned int> reversing =
      energy->reversing_nodes(v, x.u, x.state);
    std::array<double, 2> numbers = {{1. * reversing.size(), 0.}};
    for (unsigned int p = 0; p < x.state.size(); ++p)
      numbers[1] += x.state.in_contact(p);
    numbers = sum_over_processes(numbers, problem().communicator());
    if (numbers[0] <= many_of_all * numbers[1])
      return;

    energy->stop(v, x.u, reversing);
    linearization->hold(reversing, x);
    correction->update(*linearization, x);
    VectorType defect(r), rest(v);
    linearization->linearized_defect(defect, r, v);
    correction->apply(rest, defect);
    add_owned(v, 1., rest);
    step_control->replace(v);
  }



  template <int dim>
  std::size_t
  MonotoneMultigrid<dim>::memory_consumption() const
  {
    return smoother->memory_consumption() + correction->memory_consumption();
  }



  template class MonotoneMultigrid<2>;
  template class MonotoneMultigrid<3>;
} // namespace Friction

#include <common/iteration/monotone_multigrid.h>

namespace Friction
{
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
    x.forget_step();
    smoother->forward(x, smoothing_steps, /*trust first normal forces =*/true);
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

    x.begin_step();
    const double length = step_control->advance(x, v);
    smoother->backward(x, smoothing_steps);
    smoother->forward(x, smoothing_steps);
    x.end_step();
    return length;
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

#ifndef friction_iteration_monotone_multigrid_h
#define friction_iteration_monotone_multigrid_h

#include <common/iteration/correction.h>
#include <common/iteration/iterate.h>
#include <common/iteration/linearization.h>
#include <common/iteration/monotone_smoother.h>
#include <common/iteration/step_control.h>
#include <common/iteration/tresca_functional.h>

namespace Friction
{
  /**
   * One step of the monotone multigrid iteration, put together from its five
   * parts:
   * 1. the energy that the others agree on, TrescaFunctional;
   * 2. the leading relaxation, MonotoneSmoother;
   * 3. phases, truncation and constrained Newton terms, Linearization;
   * 4. the coarse correction, one of the kinds of Correction;
   * 5. projection and line search, one of the kinds of StepControl.
   *
   * The parts belong to the caller, and may be parts of several iterations.
   * For another iteration, exchange one of them by with().
   *
   * With given normal forces (Tresca) the iterates stay admissible and the
   * energy never increases. The exception is MonotoneCorrection in three
   * dimensions: it comes without a line search, and a correction that lowers
   * the linearised energy lowers the true one only where friction is piecewise
   * linear, in two.
   *
   * When to stop is not decided here, see run_multigrid().
   */
  template <int dim>
  class MonotoneMultigrid
  {
  public:
    /** Parts are kept by reference.
     * @param smoothing_steps  sweeps of the leading relaxation before and
     *                         after the correction. */
    MonotoneMultigrid(const TrescaFunctional<dim> &functional,
                      const MonotoneSmoother<dim> &smoother,
                      Linearization<dim>          &linearization,
                      Correction<dim>             &correction,
                      StepControl<dim>            &step_control,
                      const unsigned int           smoothing_steps = 3);

    /** The same with another part three. */
    MonotoneMultigrid with(Linearization<dim> &other) const;

    /** The same with another part four. */
    MonotoneMultigrid with(Correction<dim> &other) const;

    /** The same with another part five. */
    MonotoneMultigrid with(StepControl<dim> &other) const;

    /** Smooths an initial guess, so that it can be iterated. Its normal forces,
     * which know better than its residual does, are used once as they are.
     * Collective. */
    void begin(Iterate &x);

    /** From a smoothed iterate to the next one. Returns the step length of the
     * correction. Collective. */
    double iterate(Iterate &x);

    const TrescaFunctional<dim> &
    functional() const
    {
      return *energy;
    }

    const DiscreteProblem<dim> &
    problem() const
    {
      return energy->discrete_problem();
    }

    const MonotoneSmoother<dim> &
    leading_smoother() const
    {
      return *smoother;
    }

    /** The truncation of the last step, and its truncated residual. */
    const Truncation<dim> &
    truncation() const
    {
      return linearization->truncation();
    }

    const VectorType &
    truncated_residual() const
    {
      return r;
    }

    std::size_t memory_consumption() const;

  private:
    const TrescaFunctional<dim> *energy;
    const MonotoneSmoother<dim> *smoother;
    Linearization<dim>          *linearization;
    Correction<dim>             *correction;
    StepControl<dim>            *step_control;
    unsigned int                 smoothing_steps;

    double last_length = 1.;

    VectorType r, v;

    void correct_again(const Iterate &x);
  };
} // namespace Friction

#endif

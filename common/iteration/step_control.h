#ifndef friction_iteration_step_control_h
#define friction_iteration_step_control_h

#include <common/iteration/iterate.h>
#include <common/iteration/recombination.h>
#include <common/iteration/tresca_functional.h>
#include <common/nodes/truncation.h>

namespace Friction
{
  /**
   * The fifth part of a step: adds a correction to the iterate, or what is
   * admissible and good of it.
   */
  template <int dim>
  class StepControl
  {
  public:
    virtual ~StepControl() = default;

    /** Forgets all earlier steps: another iteration begins. */
    virtual void
    begin()
    {}

    /**
     * Makes the correction better by what earlier steps tell. Collective.
     * @param v           the correction, which is changed.
     * @param x           with its last step.
     * @param r           the truncated residual that v was found for.
     * @param truncation  that v belongs to.
     */
    virtual void improve(VectorType            &v,
                         const Iterate         &x,
                         const VectorType      &r,
                         const Truncation<dim> &truncation);

    /** Whether corrections may be any directions: how far to go is found
     * here. */
    virtual bool
    finds_length() const
    {
      return false;
    }

    /** @p v, of which the caller has made something else than improve() has,
     * will be the correction; if it may be any direction. Collective. */
    virtual void
    replace(const VectorType & /*v*/)
    {}

    /**
     * Adds to x.u as much of the correction @p v as is good; v is changed.
     * Collective.
     * @return the part of v that has been added; may be larger than one.
     */
    virtual double advance(Iterate &x, VectorType &v) = 0;
  };



  /**
   * The step as it is, for a correction that is admissible and within the
   * phases by itself: MonotoneCorrection. Only rounding is projected away.
   */
  template <int dim>
  class FullStep : public StepControl<dim>
  {
  public:
    /** @p functional is kept by reference. */
    explicit FullStep(const TrescaFunctional<dim> &functional);

    double advance(Iterate &x, VectorType &v) override;

  private:
    const TrescaFunctional<dim> &functional;
  };



  /**
   * Projection and line search: recombines the correction with the last steps
   * (Recombination), keeps nodes from reversing their slip and from penetrating
   * the obstacle, and minimises the energy along what is left. The energy never
   * rises.
   */
  template <int dim>
  class LineSearch : public StepControl<dim>
  {
  public:
    /**
     * @param functional        kept by reference.
     * @param largest_step      the line search goes no further than that many
     *                          times the correction.
     * @param recombined_steps  number of previous steps to be recombined with;
     *                          zero for none.
     */
    LineSearch(const TrescaFunctional<dim> &functional,
               const double                 largest_step,
               const unsigned int           recombined_steps);

    void begin() override;

    void improve(VectorType            &v,
                 const Iterate         &x,
                 const VectorType      &r,
                 const Truncation<dim> &truncation) override;

    bool
    finds_length() const override
    {
      return true;
    }

    void replace(const VectorType &v) override;

    double advance(Iterate &x, VectorType &v) override;

  private:
    const TrescaFunctional<dim> &functional;
    const DiscreteProblem<dim>  &problem;
    const double                 largest_step;
    Recombination<dim>           recombination;

    // This process' share of v.Av, for the correction v.
    double vAv = 0.;

    // What the line search along v needs to know of its quadratic part, and a
    // number that is summed up in passing.
    struct Products
    {
      double      slope, curvature;
      std::size_t n_changed;
    };

    Products products_along(const VectorType  &v,
                            const VectorType  &residual,
                            const unsigned int n_changed) const;

    double minimize_within_obstacle(const Iterate    &x,
                                    const VectorType &v,
                                    const double      largest);

    double
    energy_after(const Iterate &x, const VectorType &v, const double length);

    // Values at the contact nodes of this process, one after the other.
    using ContactValues = std::vector<NodeValue<dim>>;

    ContactValues contact_values(const VectorType &v) const;

    double try_whole_correction(const Iterate       &x,
                                VectorType          &v,
                                const double         length,
                                const ContactValues &before);
  };
} // namespace Friction

#endif

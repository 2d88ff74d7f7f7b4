#ifndef friction_iteration_newton_equations_h
#define friction_iteration_newton_equations_h

#include <common/contact/semismooth_law.h>
#include <common/iteration/contact_truncation.h>

#include <vector>

namespace Friction
{
  /**
   * The linear equations of a step of Newton's method for the laws of contact
   * and friction, see SemismoothLaw, when all that is known of the step has
   * been eliminated: normal components in contact and tangential ones that
   * stick. What remains is
   * @f[ (T-F\,e\,n^T)(A+\omega'')T\,v=r. @f]
   * This is the truncated matrix of Linearization, but for the rows of sliding
   * nodes, where the bound of friction depends on the displacement.
   */
  template <int dim>
  class NewtonEquations
  {
  public:
    /** @p problem is kept by reference. Collective. */
    explicit NewtonEquations(const DiscreteProblem<dim> &problem);
    explicit NewtonEquations(DiscreteProblem<dim> &&) = delete;

    /** The equations become those of the laws, one of each contact node of this
     * process. Collective. */
    void update(const std::vector<SemismoothLaw<dim>> &laws);

    const DiscreteProblem<dim> &
    discrete_problem() const
    {
      return problem;
    }

    /** T and $\omega''$. */
    const Truncation<dim> &
    truncation() const
    {
      return current.truncation();
    }

    /** Of each contact node of this process $F\,e$; zero unless it slides and
     * its bound follows the normal force. */
    const std::vector<NodeValue<dim>> &
    slopes() const
    {
      return all_slopes;
    }

    /** result := the left hand side, with all of @p v in place of $T\,v$.
     * Collective. */
    void vmult(VectorType &result, const VectorType &v) const;

    /**
     * Collective.
     * @param laws      the same as in update().
     * @param residual  f - A u.
     * @param step      on return what is known of it.
     * @param rhs       on return r.
     */
    void eliminate_known(const std::vector<SemismoothLaw<dim>> &laws,
                         const VectorType                      &residual,
                         VectorType                            &step,
                         VectorType                            &rhs) const;

  private:
    const DiscreteProblem<dim> &problem;
    ContactTruncation<dim>      current;
    std::vector<char>           slides; // contact nodes
    std::vector<NodeValue<dim>> all_slopes;
  };



  /**
   * Solves these equations. NewtonSolver asks it to, once in each of its steps.
   */
  template <int dim>
  class NewtonStep
  {
  public:
    virtual ~NewtonStep() = default;

    /** To be called when the equations have changed, which are kept by
     * reference. Collective. */
    virtual void update(const NewtonEquations<dim> &equations) = 0;

    struct Outcome
    {
      unsigned int iterations = 0;
      double       accuracy   = 0.; ///< residual, relative to that of zero
    };

    /**
     * Collective.
     * @param v         on return the solution.
     * @param r         truncated.
     * @param accuracy  residual, relative to the norm of r, that is small
     *                  enough; an outcome may be more accurate.
     * @param maximum_iterations  of the method, if it is an iterative one.
     */
    virtual Outcome solve(VectorType        &v,
                          const VectorType  &r,
                          const double       accuracy,
                          const unsigned int maximum_iterations) = 0;

    /** Bytes on this process. */
    virtual std::size_t memory_consumption() const = 0;
  };



  /** Takes from a block of the truncated matrix, in the row of a sliding node,
   * what a change of its bound of friction takes: $F\,e\,n^TA_{ij}T_j$.
   * @param column  $A_{ij}T_j$. */
  template <int dim>
  void subtract_change_of_bound(NodeBlock<dim>         &block,
                                const NodeValue<dim>   &slope,
                                const ContactNode<dim> &slider,
                                const NodeBlock<dim>   &column);
} // namespace Friction

#endif

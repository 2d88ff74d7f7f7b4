#ifndef friction_iteration_recombination_h
#define friction_iteration_recombination_h

#include <common/discretization/discrete_problem.h>
#include <common/iteration/iterate.h>
#include <common/nodes/truncation.h>

#include <deque>

namespace Friction
{
  /**
   * Recombines a coarse correction with the last few steps of the iteration.
   *
   * While the phases stay as they are, the iteration is linear, and the cycle a
   * preconditioner. The best combination of the new correction with the
   * previous steps, in the energy norm, would make a conjugate gradient method
   * out of it if it were symmetric. It is not quite, since sweeps before and
   * after the coarser levels have the same order, and that is as good: a
   * contraction of .7 becomes one of .3. The products with the stiffness matrix
   * that this needs cost nothing: for the steps they are differences of
   * residuals that have been computed anyway.
   *
   * A previous step that does not lie in the present free subspace (because a
   * phase has changed) is left out, so that phases are never disturbed. In a
   * later load step, where most phases are right from the beginning, it is
   * truncated instead, and its product with the matrix is computed anew. The
   * result is but a direction for the line search that follows, so that the
   * energy still cannot increase.
   */
  template <int dim>
  class Recombination
  {
  public:
    /**
     * @param problem  kept by reference.
     * @param n_steps  number of previous steps to keep; zero for none.
     */
    Recombination(const DiscreteProblem<dim> &problem,
                  const unsigned int          n_steps);

    /** Forgets all steps but the last, which is that of the iterate. */
    void clear();

    /**
     * Replaces the correction @p v by the combination of v and previous steps
     * that minimises the energy of the linearised problem with truncated
     * residual @p r, the second derivative of friction in @p truncation
     * included.
     * @param vAv  this process' share of $v^TAv$, which becomes that of the
     *             new v. No other product of A and v is needed: A times the
     *             steps is known, and A is symmetric.
     * @param x    the smoothed iterate, which knows its last step.
     * @return the number of previous steps that took part. Collective.
     */
    unsigned int improve(VectorType            &v,
                         double                &vAv,
                         const Iterate         &x,
                         const VectorType      &r,
                         const Truncation<dim> &truncation);

  private:
    const DiscreteProblem<dim> &problem;
    const unsigned int          n_steps;

    // Those before the last one, latest first.
    std::deque<VectorType> older_steps, older_images;

    unsigned int combine(VectorType            &v,
                         double                &vAv,
                         const Iterate         &x,
                         const VectorType      &r,
                         const Truncation<dim> &truncation) const;
  };
} // namespace Friction

#endif

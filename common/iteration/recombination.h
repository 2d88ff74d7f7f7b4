#ifndef friction_iteration_recombination_h
#define friction_iteration_recombination_h

#include <common/discretization/discrete_problem.h>
#include <common/nodes/truncation.h>

#include <deque>

namespace Friction
{
  /**
   * Recombines a coarse correction with the last few steps of the iteration.
   *
   * While the phases stay as they are, the iteration is linear, and the cycle a
   * symmetric preconditioner. The best combination of the new correction with
   * the previous steps, in the energy norm, then makes a conjugate gradient
   * method out of it, which turns a contraction of .7 into one of .3. The
   * products with the stiffness matrix that this needs cost nothing: for the
   * steps they are differences of residuals that have been computed anyway.
   *
   * A previous step that does not lie in the present free subspace (because a
   * phase has changed) is left out, so that phases are never disturbed; and the
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

    /** Forgets all steps. */
    void clear();

    /** Takes notice of a smoothed iterate and its residual f - A u. */
    void add_iterate(const VectorType &u, const VectorType &residual);

    /**
     * Replaces the correction @p v, with product @p Av = A v, by the
     * combination of v and previous steps that minimises the energy of the
     * linearised problem with truncated residual @p r, the second derivative of
     * friction in @p truncation included; @p Av is updated alike.
     * Returns the number of previous steps that took part. Collective.
     */
    unsigned int improve(VectorType            &v,
                         VectorType            &Av,
                         const VectorType      &r,
                         const Truncation<dim> &truncation) const;

  private:
    const DiscreteProblem<dim> &problem;
    const unsigned int          n_steps;
    bool                        has_last = false;
    VectorType                  last_iterate, last_residual;
    std::deque<VectorType>      steps, products;
  };
} // namespace Friction

#endif

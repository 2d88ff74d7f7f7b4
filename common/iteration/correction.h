#ifndef friction_iteration_correction_h
#define friction_iteration_correction_h

#include <common/iteration/iterate.h>
#include <common/iteration/linearization.h>

#include <cstddef>

namespace Friction
{
  /**
   * The fourth part of a step: proposes a correction of a smoothed iterate,
   * from the problem linearised there on truncated functions,
   * $T(A+\omega'')T\,v=r$. It need not solve it; what it may do to the energy,
   * the fifth part finds out.
   *
   * There are five of them: TruncatedCorrection, one multigrid cycle;
   * MonotoneCorrection, a cycle that observes bounds; AggregateCorrection, a
   * cycle and another one over levels that are made of the matrix;
   * AlgebraicCorrection, a solution on the leaf mesh without any levels;
   * DenseCorrection, the same of a dense matrix.
   */
  template <int dim>
  class Correction
  {
  public:
    virtual ~Correction() = default;

    /** Follows the phases, and what else the correction wants to know of the
     * iterate @p x that has been linearised. Collective. */
    virtual void update(const Linearization<dim> &linearization,
                        const Iterate            &x) = 0;

    /**
     * Computes a correction. Collective.
     * @param v  on return the correction at the leaf nodes, truncated: T v = v.
     *           Values at hanging nodes are zero.
     * @param r  truncated residual at the leaf nodes.
     */
    virtual void apply(VectorType &v, const VectorType &r) = 0;

    /** Of the vectors and matrices that it works with, those of the levels
     * included, in bytes on this process. */
    virtual std::size_t
    memory_consumption() const
    {
      return 0;
    }
  };
} // namespace Friction

#endif

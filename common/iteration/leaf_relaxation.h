#ifndef friction_iteration_leaf_relaxation_h
#define friction_iteration_leaf_relaxation_h

#include <common/iteration/monotone_smoother.h>
#include <common/nodes/truncation.h>

#include <vector>

namespace Friction
{
  /**
   * Block Gauss-Seidel on the leaf mesh for the truncated linear problem
   * $T(A+\omega'')T\,v=r$: what MonotoneSmoother is without obstacle and
   * friction. Together with a TruncatedCorrection it is a linear multigrid
   * cycle, which preconditions Newton's method.
   */
  template <int dim>
  class LeafRelaxation
  {
  public:
    /** References are kept.
     * @param smoother  of the same problem, which relaxes the nodes that are no
     *                  contact nodes. */
    LeafRelaxation(const DiscreteProblem<dim>  &problem,
                   const MonotoneSmoother<dim> &smoother);

    /** To be called when the truncation has changed. It is kept by reference.
     */
    void update(const Truncation<dim> &truncation);

    /**
     * Sweeps over all nodes that can move.
     * @param v       truncated; its ghosts need not be valid.
     * @param r       truncated.
     * @param defect  if not null, the truncated residual on return.
     */
    void run(VectorType       &v,
             const VectorType &r,
             const Sweeps     &sweeps,
             VectorType       *defect = nullptr) const;

    std::size_t
    memory_consumption() const
    {
      return inverses.capacity() * sizeof(NodeBlock<dim>);
    }

  private:
    const DiscreteProblem<dim> &problem;
    const GaussSeidel<dim>     &ordinary_nodes;
    std::vector<NodeBlock<dim>> inverses; // of contact nodes
    const Truncation<dim>      *current = nullptr;
  };
} // namespace Friction

#endif

#ifndef friction_iteration_leaf_relaxation_h
#define friction_iteration_leaf_relaxation_h

#include <common/iteration/monotone_smoother.h>
#include <common/nodes/truncation.h>

#include <vector>

namespace Friction
{
  /**
   * Block Gauss-Seidel on the leaf mesh for the linear problem of a step of
   * Newton's method, $(T-F\,e\,n^T)(A+\omega'')T\,v=r$: what MonotoneSmoother
   * is without obstacle and with phases that are known. Sliding nodes, whose
   * rows have the term with $F\,e\,n^T$, are left alone, see ContactStrip.
   * Together with a TruncatedCorrection it is a linear multigrid cycle, which
   * preconditions Newton's method.
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

    /** To be called when something has changed. Both are kept by reference.
     * @param slopes  of each contact node $F\,e$, by which the normal force in
     *                its row acts along it; zero where there is no such term.
     */
    void update(const Truncation<dim>             &truncation,
                const std::vector<NodeValue<dim>> &slopes);

    /**
     * Sweeps over all nodes that can move, but those with a slope.
     * @param v       truncated; its ghosts need not be valid.
     * @param r       truncated.
     * @param defect  if not null, the truncated residual on return.
     */
    void run(VectorType        &v,
             const VectorType  &r,
             const unsigned int n_sweeps,
             VectorType        *defect = nullptr) const;

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

    const std::vector<NodeValue<dim>> *slopes = nullptr;
  };
} // namespace Friction

#endif

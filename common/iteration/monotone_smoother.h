#ifndef friction_iteration_monotone_smoother_h
#define friction_iteration_monotone_smoother_h

#include <common/contact/local_problem.h>
#include <common/discretization/discrete_problem.h>
#include <common/iteration/iterate.h>
#include <common/nodes/gauss_seidel.h>
#include <common/parameters/solver_settings.h>

#include <map>
#include <memory>
#include <vector>

namespace Friction
{
  /**
   * The leading relaxation: nonlinear block Gauss-Seidel over the leaf nodes.
   *
   * One node after the other, the energy of the contact problem with given
   * friction bounds is minimised with respect to the displacement of that node:
   * by a dim x dim solve away from contact, by the local problem (6.15) on the
   * contact boundary. Each step lowers the energy or leaves it, and each
   * iterate is admissible; that is what makes the method monotone, and globally
   * convergent for given normal forces, whatever the coarse levels contribute,
   * if the stiffness matrix is positive definite.
   *
   * Nodes are taken by ascending number. In each chunk of some hundred nodes
   * the contact nodes come last, see renumber_nodes(), so that the long loop
   * over the ordinary ones needs no test. Several sweeps follow each other
   * through the cache, see SweepSchedule.
   *
   * With several processes each relaxes its own nodes, against the ghost values
   * of the sweep before. Where a node couples to nodes of others, its diagonal
   * block may have to be enlarged, see interface_damping(), in the local
   * problems as well; the energy still cannot increase.
   */
  template <int dim>
  class MonotoneSmoother
  {
  public:
    /**
     * Collective.
     * @param problem       kept by reference. Without friction nothing of
     *                      friction is computed.
     * @param local_solver  of the local problems, in three dimensions.
     */
    explicit MonotoneSmoother(
      const DiscreteProblem<dim> &problem,
      const LocalSolver           local_solver = LocalSolver::secular_equation);
    MonotoneSmoother(DiscreteProblem<dim> &&, const LocalSolver = {}) = delete;
    MonotoneSmoother(const MonotoneSmoother &)                        = delete;

    /**
     * Sweeps over all nodes that can move, ascending.
     * @param x  the iterate, which must be admissible. Its displacement,
     *           phases and, if it updates them, normal forces are changed: each
     *           node then takes its normal force from the intermediate iterate
     *           just before it is relaxed, (6.19). On return its residual is
     *           that of the displacement, and its normal forces are those of
     *           the residual.
     * @param trust_first_normal_forces  lets the first sweep work with the
     *           given normal forces in any case.
     */
    void relax(Iterate           &x,
               const unsigned int n_sweeps,
               const bool         trust_first_normal_forces = false) const;

    /** Relaxation of all nodes that can move but are no contact nodes. */
    const GaussSeidel<dim> &
    relaxation_of_ordinary_nodes() const
    {
      return *ordinary_nodes;
    }

    std::size_t
    memory_consumption() const
    {
      return inverses.capacity() * sizeof(NodeBlock<dim>);
    }

  private:
    const DiscreteProblem<dim>       &problem;
    std::vector<NodeBlock<dim>>       inverses;
    std::vector<LocalProblem<dim>>    local_problems;
    std::unique_ptr<GaussSeidel<dim>> ordinary_nodes;

    // Diagonal blocks of contact nodes where they had to be enlarged.
    std::map<unsigned int, NodeBlock<dim>> damped_diagonals;

    // Contact nodes in the order of their nodes, and by chunk the first one.
    std::vector<unsigned int> in_order, first_of_chunk;

    void relax_contact_node(const unsigned int          p,
                            Iterate                    &x,
                            const bool                  update_normal_force,
                            const RowKernels::LeftSums &left) const;
  };
} // namespace Friction

#endif

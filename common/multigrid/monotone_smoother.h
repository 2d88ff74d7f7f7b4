#ifndef friction_multigrid_monotone_smoother_h
#define friction_multigrid_monotone_smoother_h

#include <common/contact/contact_boundary.h>
#include <common/contact/contact_state.h>
#include <common/contact/local_problem.h>
#include <common/contact/nodal_constraints.h>
#include <common/multigrid/node_block_matrix.h>

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
   * convergent whatever the coarse levels contribute.
   *
   * Ordinary nodes come first in a forward sweep, contact nodes last, so that
   * the long loop over the ordinary ones needs no test; a backward sweep is the
   * exact reverse.
   */
  template <int dim>
  class MonotoneSmoother
  {
  public:
    /**
     * Arguments given by reference are kept.
     * @param friction_coefficient  zero for frictionless contact, for which
     *        nothing of friction is then computed.
     */
    MonotoneSmoother(const NodeBlockMatrix<dim>  &matrix,
                     const NodalConstraints<dim> &constraints,
                     const ContactBoundary<dim>  &contact,
                     const double                 friction_coefficient);

    /**
     * One sweep.
     * @param u      displacement at the leaf nodes; prescribed components must
     *               have their values, which are not changed.
     * @param f      nodal forces.
     * @param state  contact and stick flags, set by the sweep, and the normal
     *               forces in the friction bounds.
     * @param update_normal_forces  take the normal force of each node from the
     *               intermediate iterate just before the node is relaxed: the
     *               local problems (6.19) of Algorithm 3. Otherwise the normal
     *               forces stay as they are, as in (6.13).
     */
    void sweep(VectorType       &u,
               const VectorType &f,
               ContactState     &state,
               const bool        update_normal_forces,
               const bool        backwards) const;

    /** The ordinary nodes, for measurements. */
    const NodeRanges &
    ordinary_nodes() const
    {
      return ordinary;
    }

    const std::vector<NodeBlock<dim>> &
    inverse_diagonals() const
    {
      return inverses;
    }

    std::size_t
    memory_consumption() const
    {
      return inverses.capacity() * sizeof(NodeBlock<dim>);
    }

  private:
    const NodeBlockMatrix<dim>    &matrix;
    const ContactBoundary<dim>    &contact;
    const double                   friction_coefficient;
    NodeRanges                     ordinary;
    std::vector<NodeBlock<dim>>    inverses;
    std::vector<LocalProblem<dim>> local_problems;

    void relax_contact_node(const unsigned int p,
                            VectorType        &u,
                            const VectorType  &f,
                            ContactState      &state,
                            const bool         update_normal_forces) const;
  };
} // namespace Friction

#endif

#ifndef friction_iteration_monotone_smoother_h
#define friction_iteration_monotone_smoother_h

#include <common/discretization/contact_boundary.h>
#include <common/contact/contact_state.h>
#include <common/contact/local_problem.h>
#include <common/nodes/nodal_constraints.h>
#include <common/nodes/sweep_schedule.h>
#include <common/parallel/ghost_exchange.h>
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
   * convergent whatever the coarse levels contribute.
   *
   * Nodes are taken by ascending number, in chunks of which the ordinary nodes
   * come first and the contact nodes last, so that the long loop over the
   * ordinary ones needs no test; a backward sweep is the exact reverse. Several
   * sweeps follow each other through the cache, see SweepSchedule.
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
     * Collective. Arguments given by reference are kept.
     * @param friction_coefficient  zero for frictionless contact, for which
     *        nothing of friction is then computed.
     * @param local_solver  of the local problems, in three dimensions.
     */
    MonotoneSmoother(
      const NodeBlockMatrix<dim>  &matrix,
      const NodalConstraints<dim> &constraints,
      const ContactBoundary<dim>  &contact,
      const double                 friction_coefficient,
      const LocalSolver local_solver = LocalSolver::secular_equation);

    /** What a number of sweeps is to do; see sweeps(). */
    struct Sweeps
    {
      unsigned int n         = 1;
      bool         backwards = false;

      /// Take the normal force of each node from the intermediate iterate just
      /// before the node is relaxed: the local problems (6.19) of Algorithm 3.
      /// Otherwise the normal forces stay as they are, as in (6.13).
      bool update_normal_forces = false;

      /// With updates: let the first sweep work with the given normal forces.
      bool trust_first_normal_forces = false;
    };

    /**
     * Sweeps over all nodes that can move.
     * @param u      displacement at the leaf nodes; prescribed components must
     *               have their values, which are not changed. Its ghosts must
     * be valid (see ghosts()), and are on return.
     * @param f      nodal forces.
     * @param state  contact and stick flags, set by the sweeps, and the normal
     *               forces in the friction bounds.
     * @param residual  if not null, on return f - A u at all nodes.
     */
    void sweeps(VectorType       &u,
                const VectorType &f,
                ContactState     &state,
                const Sweeps     &what,
                VectorType       *residual = nullptr) const;

    /** A single sweep. */
    void
    sweep(VectorType       &u,
          const VectorType &f,
          ContactState     &state,
          const bool        update_normal_forces,
          const bool        backwards) const
    {
      Sweeps what;
      what.backwards            = backwards;
      what.update_normal_forces = update_normal_forces;
      sweeps(u, f, state, what);
    }

    /** Keeps those ghosts of a vector up to date that the rows of the matrix
     * couple to. */
    GhostExchange &
    ghosts() const
    {
      return *exchange;
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
    std::vector<NodeBlock<dim>>    inverses;
    std::vector<LocalProblem<dim>> local_problems;
    SweepSchedule<dim>             schedule;

    // Diagonal blocks of contact nodes where they had to be enlarged.
    std::map<unsigned int, NodeBlock<dim>> damped_diagonals;

    // Has buffers, which makes it change while it works.
    std::unique_ptr<GhostExchange> exchange;

    // Contact nodes by chunk: those of chunk c are first_contact[c],... in the
    // permutation by_chunk.
    std::vector<unsigned int> first_contact, by_chunk;

    void relax_contact_node(const unsigned int p,
                            VectorType        &u,
                            const VectorType  &f,
                            ContactState      &state,
                            const bool         update_normal_forces) const;
  };
} // namespace Friction

#endif

#ifndef friction_iteration_contact_truncation_h
#define friction_iteration_contact_truncation_h

#include <common/discretization/discrete_problem.h>
#include <common/nodes/truncation.h>
#include <common/parallel/ghost_exchange.h>

#include <vector>

namespace Friction
{
  /**
   * The truncation of a contact problem: each process decides for its own
   * contact nodes, and the neighbouring processes get to know.
   */
  template <int dim>
  class ContactTruncation
  {
  public:
    /** No node in contact. @p problem is kept by reference. Collective. */
    explicit ContactTruncation(const DiscreteProblem<dim> &problem);
    ContactTruncation(DiscreteProblem<dim> &&) = delete;

    /** Sets subspace and second derivative of contact node @p p of this
     * process, see Truncation::set(). */
    void set(const unsigned int    p,
             const NodeBlock<dim> &projector,
             const NodeBlock<dim> &curvature);

    /** The orthogonal projector onto the free directions of contact node @p p:
     * its normal or not, and all free tangents or none. */
    NodeBlock<dim> projector(const unsigned int p,
                             const bool         normal_is_free,
                             const bool         tangents_are_free) const;

    /** Has the other processes know. Collective. */
    void exchange();

    const Truncation<dim> &
    truncation() const
    {
      return current;
    }

  private:
    const DiscreteProblem<dim> &problem;
    Truncation<dim>             current;

    // Contact nodes of others that are ghosts here, and the exchange of what
    // has been decided for them: projector and second derivative of the contact
    // nodes of this process, and then of those ghosts.
    std::vector<unsigned int> ghost_nodes;
    GhostExchange             ghosts;
    std::vector<double>       exchanged;

    void find_ghosts();
  };
} // namespace Friction

#endif

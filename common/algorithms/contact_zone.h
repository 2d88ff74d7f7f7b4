#ifndef friction_algorithms_contact_zone_h
#define friction_algorithms_contact_zone_h

#include <common/contact/contact_state.h>
#include <common/discretization/discrete_problem.h>
#include <common/nodes/node_block_matrix.h>

#include <vector>

namespace Friction
{
  /**
   * The contact nodes that may touch the obstacle: those that do in an iterate,
   * and some layers of contact nodes around them. All others are taken for
   * free. If what is found then has one of them at the obstacle or in it, the
   * zone grows.
   *
   * Nodes whose bound of friction is given rub whether they touch or not, and
   * are always in the zone.
   *
   * All processes know the whole zone.
   */
  template <int dim>
  class ContactZone
  {
  public:
    /**
     * @param problem  kept by reference.
     * @param pattern  of the couplings of all nodes of all processes, kept by
     *                 reference.
     */
    ContactZone(const DiscreteProblem<dim> &problem,
                const NodePattern          &pattern);

    /** Whether nodes outside the zone touch, have a normal force, or are in the
     * obstacle. Collective. */
    bool misses(const VectorType &u, const ContactState &state) const;

    /**
     * Takes in the nodes that touch, have a normal force, or are in the
     * obstacle, and layers around those of them that have been outside, twice
     * as many layers each time; at first at least the node that is nearest
     * to the obstacle. A zone of most contact nodes becomes one of all.
     * Collective.
     * @return whether there are more nodes now than before.
     */
    bool grow(const VectorType &u, const ContactState &state);

    /** Takes in all contact nodes. Returns whether there are more nodes now
     * than before. */
    bool grow_to_all();

    /** Of all nodes, whether they are in the zone. */
    const std::vector<char> &
    nodes() const
    {
      return in_zone;
    }

    /** A node of this process. */
    bool
    contains(const ContactNode<dim> &p) const
    {
      return in_zone[problem.constraints.numbering().global(p.node)];
    }

  private:
    const DiscreteProblem<dim> &problem;
    const NodePattern          &pattern;

    // Of all nodes.
    std::vector<char> is_contact, in_zone;
    unsigned int      n_layers;

    std::vector<double> gather_rooms(const VectorType   &u,
                                     const ContactState &state) const;

    unsigned int nearest(const std::vector<double> &rooms) const;

    std::vector<char> with_neighbors(const std::vector<char> &some) const;
  };
} // namespace Friction

#endif

#include <common/algorithms/contact_zone.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Friction
{
  namespace
  {
    // Contact nodes around those that touch, at first.
    template <int dim>
    constexpr unsigned int first_layers = (dim == 2 ? 6 : 2);

    // Of all contact nodes; what is left to save is not worth growing for.
    constexpr double most = .7;

    // More need not be taken in at a time.
    constexpr unsigned int most_layers = 1000;

    constexpr double no_contact_node = std::numeric_limits<double>::infinity();



    std::size_t
    size_of(const std::vector<char> &nodes)
    {
      return std::count(nodes.begin(), nodes.end(), 1);
    }
  } // namespace



  template <int dim>
  ContactZone<dim>::ContactZone(const DiscreteProblem<dim> &problem,
                                const NodePattern          &pattern)
    : problem(problem)
    , pattern(pattern)
    , in_zone(pattern.n_rows(), 0)
    , n_layers(first_layers<dim>)
  {
    std::vector<char> own(problem.constraints.n_owned_nodes(), 0);
    for (const ContactNode<dim> &p : problem.contact)
      own[p.node] = 1;
    is_contact = gather_from_all(own, problem.communicator());
  }



  // Of all nodes, how far they may move until they touch; zero for those that
  // have to be in the zone.
  template <int dim>
  std::vector<double>
  ContactZone<dim>::gather_rooms(const VectorType   &u,
                                 const ContactState &state) const
  {
    constexpr double    rounding = 1e-12;
    std::vector<double> rooms(problem.constraints.n_owned_nodes(),
                              no_contact_node);
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      {
        const ContactNode<dim> &node = problem.contact[p];
        const double            u_n  = normal_component(node, u);
        const double            room = node.gap - u_n;
        const bool              is_given =
          problem.has_friction() && !problem.has_coulomb_friction(node);
        rooms[node.node] = state.in_contact(p) || state.normal_force(p) > 0. ||
            is_given || room <= rounding * (std::abs(node.gap) + std::abs(u_n))
          ? 0.
          : room;
      }
    return gather_from_all(rooms, problem.communicator());
  }



  template <int dim>
  bool
  ContactZone<dim>::misses(const VectorType &u, const ContactState &state) const
  {
    const std::vector<double> rooms = gather_rooms(u, state);
    for (unsigned int i = 0; i < rooms.size(); ++i)
      if (rooms[i] == 0. && !in_zone[i])
        return true;
    return false;
  }



  template <int dim>
  bool
  ContactZone<dim>::grow(const VectorType &u, const ContactState &state)
  {
    const std::vector<double> rooms = gather_rooms(u, state);
    std::vector<char>         more(rooms.size());
    for (unsigned int i = 0; i < rooms.size(); ++i)
      more[i] = (rooms[i] == 0. && !in_zone[i]);
    if (size_of(more) + size_of(in_zone) == 0 && size_of(is_contact) > 0)
      more[nearest(rooms)] = 1;
    if (size_of(more) == 0)
      return false;
    for (unsigned int layer = 0; layer < n_layers; ++layer)
      more = with_neighbors(more);
    n_layers = std::min(2 * n_layers, most_layers);
    for (unsigned int i = 0; i < in_zone.size(); ++i)
      in_zone[i] |= more[i];
    if (size_of(in_zone) > most * size_of(is_contact))
      in_zone = is_contact;
    return true;
  }



  template <int dim>
  bool
  ContactZone<dim>::grow_to_all()
  {
    const bool is_larger = in_zone != is_contact;
    in_zone              = is_contact;
    return is_larger;
  }



  // The contact node with the least room; any of them if these are no numbers.
  template <int dim>
  unsigned int
  ContactZone<dim>::nearest(const std::vector<double> &rooms) const
  {
    unsigned int result =
      std::find(is_contact.begin(), is_contact.end(), 1) - is_contact.begin();
    for (unsigned int i = result; i < rooms.size(); ++i)
      if (is_contact[i] && rooms[i] < rooms[result])
        result = i;
    return result;
  }



  template <int dim>
  std::vector<char>
  ContactZone<dim>::with_neighbors(const std::vector<char> &some) const
  {
    std::vector<char> larger = some;
    for (unsigned int i = 0; i < some.size(); ++i)
      if (some[i])
        for (std::size_t e = pattern.starts[i]; e < pattern.starts[i + 1]; ++e)
          if (is_contact[pattern.columns[e]])
            larger[pattern.columns[e]] = 1;
    return larger;
  }



  template class ContactZone<2>;
  template class ContactZone<3>;
} // namespace Friction

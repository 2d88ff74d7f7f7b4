#ifndef friction_contact_contact_state_h
#define friction_contact_contact_state_h

#include <cstddef>
#include <vector>

namespace Friction
{
  /**
   * What the nodes of $\Gamma_S$ are doing: which of them touch, which of those
   * stick, and with which normal force friction reckons. Together with the
   * displacement this is the state of the nonlinear iteration.
   *
   * Contact and stick are decided by the local problems, or by the law of
   * Newton's method, and kept as flags here, never read off the displacement
   * once the iteration has begun: after a rotation to the local frame
   * and back, $u_n = g$ holds only up to rounding.
   *
   * Each process has the state of its own contact nodes, and all counts are of
   * these.
   */
  class ContactState
  {
  public:
    /**
     * @param n_nodes        number of nodes of the contact boundary.
     * @param with_friction  without friction nothing is stored for it.
     */
    ContactState(const unsigned int n_nodes, const bool with_friction)
      : with_friction(with_friction)
      , contact(n_nodes, 0)
      , stick(with_friction ? n_nodes : 0, 0)
      , force(with_friction ? n_nodes : 0, 0.)
    {}

    bool
    has_friction() const
    {
      return with_friction;
    }

    bool
    in_contact(const unsigned int p) const
    {
      return contact[p];
    }

    /** The slip, what the tangential displacement has changed by since the end
     * of the last load step, is held at zero by friction. */
    bool
    sticks(const unsigned int p) const
    {
      return has_friction() && stick[p];
    }

    /** The nodal normal force $\tau(p) \ge 0$ in the friction bound $F\tau$. */
    double
    normal_force(const unsigned int p) const
    {
      return has_friction() ? force[p] : 0.;
    }

    void
    set(const unsigned int p, const bool in_contact, const bool sticks)
    {
      contact[p] = in_contact;
      if (has_friction())
        stick[p] = sticks;
    }

    void
    set_normal_force(const unsigned int p, const double value)
    {
      if (has_friction())
        force[p] = value;
    }

    unsigned int
    size() const
    {
      return contact.size();
    }

    unsigned int
    n_contact() const
    {
      unsigned int n = 0;
      for (const char c : contact)
        n += c;
      return n;
    }

    /** Nodes that stick in contact. */
    unsigned int
    n_sticking() const
    {
      unsigned int n = 0;
      for (unsigned int p = 0; p < stick.size(); ++p)
        n += (contact[p] && stick[p]);
      return n;
    }

    /** Bytes that friction takes; zero without friction. */
    std::size_t
    friction_memory() const
    {
      return stick.capacity() * sizeof(char) +
        force.capacity() * sizeof(double);
    }

  private:
    bool                with_friction;
    std::vector<char>   contact;
    std::vector<char>   stick;
    std::vector<double> force;
  };
} // namespace Friction

#endif

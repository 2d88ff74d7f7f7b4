#include <common/algorithms/phase_path.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace Friction
{
  namespace
  {
    // What is rounding, of lengths and of numbers without a unit.
    constexpr double negligible = 1e-12;

    // How far unknowns of a guess are from the end of what their phases allow,
    // at least, as a part of the largest of them.
    constexpr double margin = 1e-4;

    // By what part of themselves they are changed at random, so that problems
    // with a symmetry lose it.
    constexpr double disorder = 1;



    // Where a path has lost its way.
    unsigned int
    most_changes(const std::size_t n)
    {
      return 1000 + 100 * n;
    }



    // Changes of phase after which the inverse, a product, is found anew.
    unsigned int
    most_products(const std::size_t n)
    {
      return 50 + n / 2;
    }



    double
    largest_on_diagonal(const std::vector<double> &matrix, const std::size_t n)
    {
      double result = 0;
      for (std::size_t k = 0; k < n; ++k)
        result = std::max(result, matrix[k * n + k]);
      return result > 0 ? result : 1.;
    }



    std::vector<double>
    divided(std::vector<double> values, const double unit)
    {
      for (double &value : values)
        value /= unit;
      return values;
    }
  } // namespace



  PhasePath::PhasePath(std::vector<double>      &&the_matrix,
                       const std::vector<double> &the_load,
                       const std::vector<Node>   &the_nodes)
    : n(the_load.size())
    , nodes(the_nodes)
    , unit(largest_on_diagonal(the_matrix, n))
    , matrix(divided(std::move(the_matrix), unit))
    , node_of(n, nowhere)
    , origin(n, 0.)
    , load(divided(the_load, unit))
    , value(n)
    , rate(n)
    , in_row(n)
    , row_of(n + 1)
    , column(n)
    , image(n)
  {
    for (unsigned int p = 0; p < nodes.size(); ++p)
      {
        node_of[nodes[p].normal] = p;
        origin[nodes[p].normal]  = nodes[p].gap;
        if (nodes[p].tangential != nowhere)
          {
            node_of[nodes[p].tangential] = p;
            origin[nodes[p].tangential]  = nodes[p].slip_origin;
          }
        else
          nodes[p].coefficient = nodes[p].bound = 0.;
      }
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < n; ++i)
        load[i] -= matrix[k * n + i] * origin[k];
  }



  bool
  PhasePath::has_friction(const Node &node) const
  {
    return node.coefficient > 0 || node.bound > 0;
  }



  // Whether there is friction now: with Coulomb's law, in contact.
  bool
  PhasePath::rubs(const unsigned int p) const
  {
    return has_friction(nodes[p]) &&
      (nodes[p].coefficient == 0 || now[p].in_contact);
  }



  bool
  PhasePath::is_held(const unsigned int        k,
                     const std::vector<Phase> &phases) const
  {
    const unsigned int p = node_of[k];
    return p != nowhere &&
      (k == nodes[p].normal ? phases[p].in_contact : phases[p].sticks);
  }



  bool
  PhasePath::is_held(const unsigned int k) const
  {
    return is_held(k, now);
  }



  bool
  PhasePath::has_first_column(const unsigned int k) const
  {
    const unsigned int p = node_of[k];
    return is_held(k) == is_held(k, first) &&
      !(p != nowhere && k == nodes[p].normal && is_held(k) &&
        nodes[p].coefficient > 0 && now[p].side != first[p].side);
  }



  double
  PhasePath::bound(const unsigned int p) const
  {
    return nodes[p].coefficient > 0
      ? nodes[p].coefficient * value[nodes[p].normal]
      : nodes[p].bound / unit;
  }



  double
  PhasePath::force_at(const unsigned int k) const
  {
    const unsigned int p = node_of[k];
    if (p == nowhere)
      return 0.;
    if (k == nodes[p].normal)
      return now[p].in_contact ? value[k] : 0.;
    if (!rubs(p))
      return 0.;
    return now[p].side * bound(p) + (now[p].sticks ? value[k] : 0.);
  }



  std::vector<double>
  PhasePath::displacement() const
  {
    std::vector<double> result(origin);
    for (unsigned int k = 0; k < n; ++k)
      if (!is_held(k))
        result[k] += value[k];
    return result;
  }



  std::vector<double>
  PhasePath::force() const
  {
    std::vector<double> result(n);
    for (unsigned int k = 0; k < n; ++k)
      result[k] = unit * force_at(k);
    return result;
  }



  void
  PhasePath::begin(const std::vector<char>   &touches,
                   const std::vector<double> &guess,
                   const std::vector<double> &force)
  {
    double largest = 0;
    for (unsigned int k = 0; k < n; ++k)
      {
        value[k] = guess[k] - origin[k];
        largest  = std::max({largest, std::abs(value[k]), force[k] / unit});
      }
    const double least = margin * (largest > 0 ? largest : 1.);
    now.resize(nodes.size());
    std::mt19937 random(1);
    for (unsigned int p = 0; p < nodes.size(); ++p)
      {
        const Node &node  = nodes[p];
        double     &v     = value[node.normal];
        now[p].in_contact = touches[p];
        v = touches[p] ? std::max(least, force[node.normal] / unit)
                       : std::min(-least, v);
        v *= 1 + disorder * (random() / 4294967296.);
        now[p].sticks = rubs(p);
        now[p].side   = 1;
        if (!has_friction(node))
          continue;
        double      &slip = value[node.tangential];
        const double most = -v / node.coefficient;
        slip = rubs(p) ? -bound(p) : std::max(-most, std::min(most, slip));
      }
    first = now;
    find_start_of_way();
  }



  // The load that the start is a solution of.
  void
  PhasePath::find_start_of_way()
  {
    t   = 0;
    way = load;
    for (std::size_t k = 0; k < n; ++k)
      {
        way[k] -= force_at(k);
        if (!is_held(k))
          for (std::size_t i = 0; i < n; ++i)
            way[i] -= matrix[k * n + i] * value[k];
      }
  }



  void
  PhasePath::find_column(const unsigned int k)
  {
    if (k == n)
      for (std::size_t i = 0; i < n; ++i)
        column[i] = -way[i];
    else if (!is_held(k))
      std::copy_n(matrix.begin() + k * n, n, column.begin());
    else
      {
        std::fill(column.begin(), column.end(), 0.);
        column[k]             = 1;
        const unsigned int p  = node_of[k];
        const Node        &at = nodes[p];
        if (k == at.normal && at.coefficient > 0)
          column[at.tangential] = now[p].side * at.coefficient;
      }
  }



  void
  PhasePath::find_image()
  {
    image = column;
    inverse.apply(image);
  }



  // The unknown takes the row. Returns whether that is possible.
  bool
  PhasePath::exchange(const unsigned int row, const unsigned int k)
  {
    double largest = 0;
    for (const double value : image)
      largest = std::max(largest, std::abs(value));
    if (!(std::abs(image[row]) > negligible * largest))
      return false;
    inverse.exchange(row, image);
    in_row[row] = k;
    row_of[k]   = row;
    return true;
  }



  bool
  PhasePath::begin_inverse()
  {
    std::vector<char> is_unit(n);
    for (unsigned int k = 0; k < n; ++k)
      is_unit[k] = is_held(k);
    if (!inverse.factorize(matrix, is_unit))
      return false;
    begin_anew();
    return true;
  }



  // With the phases of the start, in which all nodes that touch stick.
  void
  PhasePath::begin_anew()
  {
    inverse.undo_all();
    for (unsigned int k = 0; k < n; ++k)
      in_row[k] = row_of[k] = k;
    for (unsigned int p = 0; p < nodes.size(); ++p)
      if (first[p].sticks && nodes[p].coefficient > 0)
        inverse.add_row(nodes[p].tangential,
                        nodes[p].normal,
                        -first[p].side * nodes[p].coefficient);
  }



  // With those of the moment: columns that have changed are exchanged, one
  // after another, the one with the largest pivot. The unknown that is
  // increased has none, and t has one, unless it is t.
  bool
  PhasePath::find_inverse(const unsigned int increased)
  {
    begin_anew();
    std::vector<char> is_left(n);
    for (unsigned int k = 0; k < n; ++k)
      is_left[k] = k == increased || !has_first_column(k);
    for (unsigned int k = 0; k <= n; ++k)
      if (k != increased && (k == n || !has_first_column(k)))
        {
          find_column(k);
          find_image();
          unsigned int best = nowhere;
          for (unsigned int i = 0; i < n; ++i)
            if (is_left[i] &&
                (best == nowhere || std::abs(image[i]) > std::abs(image[best])))
              best = i;
          if (!exchange(best, k))
            return false;
          is_left[best] = false;
        }
    return true;
  }



  // Of all unknowns but the one that is increased, which is known: rounding
  // errors of the way are left behind.
  void
  PhasePath::find_values(const unsigned int increased)
  {
    std::vector<double> rhs(load);
    for (unsigned int p = 0; p < nodes.size(); ++p)
      if (rubs(p) && nodes[p].coefficient == 0)
        rhs[nodes[p].tangential] -= now[p].side * bound(p);
    // If t is an unknown, its column knows the way.
    const double left = increased == n ? 1 - t : 1;
    for (unsigned int k = 0; k < n; ++k)
      rhs[k] -= left * way[k];
    if (increased != n)
      {
        find_column(increased);
        for (unsigned int k = 0; k < n; ++k)
          rhs[k] -= value[increased] * column[k];
      }
    inverse.apply(rhs);
    for (unsigned int i = 0; i < n; ++i)
      (in_row[i] == n ? t : value[in_row[i]]) = rhs[i];
  }



  bool
  PhasePath::arrive()
  {
    t = 1;
    if (!find_inverse(n))
      return false;
    find_values(n);
    return true;
  }



  // Of all unknowns, per change of the one that is increased.
  void
  PhasePath::find_rates(const unsigned int increased, const double sign)
  {
    find_column(increased);
    find_image();
    for (unsigned int i = 0; i < n; ++i)
      (in_row[i] == n ? rate_of_t : rate[in_row[i]]) = -sign * image[i];
    (increased == n ? rate_of_t : rate[increased]) = sign;
  }



  PhasePath::Event
  PhasePath::first_event(const unsigned int increased) const
  {
    Event next{std::numeric_limits<double>::infinity(), nowhere, 0, false};
    const double largest = std::abs(
      *std::max_element(rate.begin(), rate.end(), [](double a, double b) {
        return std::abs(a) < std::abs(b);
      }));
    // A room that gets smaller. Of two that vanish together the faster one has
    // the larger pivot.
    const auto vanishes = [&](const unsigned int k,
                              const double       room,
                              const double       growth,
                              const bool         on_other_side = false) {
      if (growth >= -negligible * largest)
        return;
      const double length = std::max(0., room / -growth);
      const double same   = negligible * length;
      if (length < next.length - same ||
          (length <= next.length + same && -growth > next.speed))
        next = {length, k, -growth, on_other_side};
    };

    for (unsigned int p = 0; p < nodes.size(); ++p)
      {
        const unsigned int k     = nodes[p].normal;
        const double       F     = nodes[p].coefficient;
        const bool         holds = now[p].sticks && F > 0;
        if (!now[p].in_contact)
          vanishes(k, -value[k], -rate[k]);
        else if (!holds) // or else friction is at its bound before
          vanishes(k, value[k], rate[k]);
        if (!rubs(p))
          continue;

        const unsigned int s    = nodes[p].tangential;
        const double       side = now[p].side;
        if (now[p].sticks)
          {
            vanishes(s, -side * value[s], -side * rate[s]);
            vanishes(s,
                     side * value[s] + 2 * bound(p),
                     side * rate[s] + 2 * F * rate[k],
                     true);
          }
        else
          vanishes(s, side * value[s], side * rate[s]);
      }

    const unsigned int arrival = n;
    if (increased == n || rate_of_t > 0)
      {
        if ((1 - t) / rate_of_t <= next.length)
          next = {(1 - t) / rate_of_t, arrival, rate_of_t, false};
      }
    else if (rate_of_t < 0 && t / -rate_of_t < next.length)
      next = {t / -rate_of_t, arrival, rate_of_t, false};
    return next;
  }



  void
  PhasePath::advance(const double length)
  {
    for (unsigned int k = 0; k < n; ++k)
      value[k] += length * rate[k];
    t += length * rate_of_t;
  }



  // What a force lacks to the bound on one side becomes what it lacks on the
  // other one. Returns whether the inverse has followed.
  bool
  PhasePath::turn_to_other_side(const unsigned int k)
  {
    const unsigned int p      = node_of[k];
    const double       change = 2 * now[p].side * nodes[p].coefficient;
    value[k] += 2 * now[p].side * bound(p);
    now[p].side = -now[p].side;
    if (change == 0)
      return true;
    const unsigned int of_normal = row_of[nodes[p].normal];
    if (in_row[row_of[k]] == k)
      {
        inverse.add_row(row_of[k], of_normal, change);
        image[row_of[k]] += change * image[of_normal];
        return true;
      }
    // It is the one that is increased, and has no row.
    find_column(nodes[p].normal);
    find_image();
    return exchange(of_normal, nodes[p].normal);
  }



  // Returns which way the unknown that has become free goes now.
  double
  PhasePath::enter_next_phase(const unsigned int k)
  {
    const unsigned int p     = node_of[k];
    const Node        &node  = nodes[p];
    Phase             &phase = now[p];
    value[k]                 = 0;
    if (k == node.tangential)
      {
        phase.sticks = !phase.sticks;
        return phase.sticks ? -phase.side : phase.side;
      }
    phase.in_contact = !phase.in_contact;
    if (!phase.in_contact)
      return -1;
    if (node.coefficient > 0)
      phase.side = value[node.tangential] < 0 ? -1 : 1;
    return 1;
  }



  bool
  PhasePath::follow(const double most)
  {
    if (n == 0)
      return true;
    if (!begin_inverse())
      return false;
    unsigned int increased = n;
    double       sign      = 1;
    unsigned int n_since   = 0;
    while (inverse.n_multiplications() < most && n_changes < most_changes(n))
      {
        find_rates(increased, sign);
        const Event event = first_event(increased);
        if (event.unknown == nowhere)
          return false;
        advance(event.length);
        if (event.unknown == n)
          return rate_of_t > 0 && arrive();
        ++n_changes;
        if (event.on_other_side && !turn_to_other_side(event.unknown))
          return false;
        if (event.unknown != increased)
          {
            if (!exchange(row_of[event.unknown], increased))
              return false;
            increased = event.unknown;
          }
        sign = enter_next_phase(event.unknown);
        if (++n_since >= most_products(n))
          {
            if (!find_inverse(increased))
              return false;
            find_values(increased);
            n_since = 0;
          }
      }
    return false;
  }



  std::size_t
  PhasePath::memory_consumption() const
  {
    return matrix.capacity() * sizeof(double) + inverse.memory_consumption();
  }
} // namespace Friction

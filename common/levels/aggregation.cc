#include <common/levels/aggregation.h>

#include <algorithm>

namespace Friction
{
  Aggregation
  aggregate(const StrongCouplings &couplings)
  {
    const unsigned int n    = couplings.n_nodes();
    const unsigned int none = Aggregation::none;
    Aggregation        result;
    result.group_of.assign(n, none);
    std::vector<unsigned int> &group = result.group_of;
    const auto                 begin = [&](const unsigned int i) {
      return couplings.neighbours.begin() + couplings.starts[i];
    };
    const auto is_alone = [&](const unsigned int i) {
      return couplings.starts[i] == couplings.starts[i + 1];
    };

    // Whether the neighbours of a node hang together without it.
    std::vector<unsigned int> seen(n, none), stack;
    std::vector<unsigned int> neighbour_of(n, none);
    const auto                is_inner = [&](const unsigned int i) {
      for (auto j = begin(i); j != begin(i + 1); ++j)
        neighbour_of[*j] = i;
      seen[i]             = i;
      seen[*begin(i)]     = i;
      stack               = {*begin(i)};
      unsigned int n_seen = 1;
      while (!stack.empty())
        {
          const unsigned int k = stack.back();
          stack.pop_back();
          for (auto j = begin(k); j != begin(k + 1); ++j)
            if (neighbour_of[*j] == i && seen[*j] != i)
              {
                seen[*j] = i;
                ++n_seen;
                stack.push_back(*j);
              }
        }
      return n_seen == couplings.starts[i + 1] - couplings.starts[i];
    };

    for (const bool must_be_inner : {true, false})
      for (unsigned int i = 0; i < n; ++i)
        if (!is_alone(i) && group[i] == none &&
            std::all_of(
              begin(i),
              begin(i + 1),
              [&](const unsigned int j) { return group[j] == none; }) &&
            (!must_be_inner || is_inner(i)))
          {
            group[i] = result.n_groups;
            for (auto j = begin(i); j != begin(i + 1); ++j)
              group[*j] = result.n_groups;
            ++result.n_groups;
          }

    // Those of the first round only, or a group would grow along a path.
    const std::vector<unsigned int> first_round = group;
    for (unsigned int i = 0; i < n; ++i)
      if (group[i] == none)
        for (auto j = begin(i); j != begin(i + 1); ++j)
          if (first_round[*j] != none)
            {
              group[i] = first_round[*j];
              break;
            }

    for (unsigned int i = 0; i < n; ++i)
      if (!is_alone(i) && group[i] == none)
        {
          group[i] = result.n_groups;
          for (auto j = begin(i); j != begin(i + 1); ++j)
            if (group[*j] == none)
              group[*j] = result.n_groups;
          ++result.n_groups;
        }
    return result;
  }
} // namespace Friction

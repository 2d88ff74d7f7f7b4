#include <common/nodes/elimination_tree.h>

#include <algorithm>
#include <limits>

namespace Friction
{
  namespace
  {
    // Parts of fewer nodes are not divided any more: a dense matrix of that
    // size is no more work than the administration of two smaller ones.
    constexpr unsigned int smallest_part = 12;

    constexpr unsigned int nowhere = std::numeric_limits<unsigned int>::max();
  } // namespace



  EliminationTree::EliminationTree(const NodePattern       &pattern,
                                   const Places            &positions,
                                   const std::vector<char> &is_kept,
                                   const std::vector<char> &is_absent)
    : pattern(pattern)
    , positions(positions)
    , part(pattern.n_rows(), nowhere)
  {
    std::vector<unsigned int> eliminated, kept;
    for (unsigned int i = 0; i < pattern.n_rows(); ++i)
      if (!is_absent[i])
        (is_kept[i] ? kept : eliminated).push_back(i);
    std::vector<unsigned int> roots = dissect(eliminated);
    add_front(std::move(kept), std::move(roots));
    find_borders();
  }



  unsigned int
  EliminationTree::add_front(std::vector<unsigned int> nodes,
                             std::vector<unsigned int> children)
  {
    all_fronts.push_back({std::move(nodes), {}, std::move(children)});
    return all_fronts.size() - 1;
  }



  // Returns the fronts of these nodes that have no parent among them: one, or
  // several that are not coupled.
  std::vector<unsigned int>
  EliminationTree::dissect(const std::vector<unsigned int> &nodes)
  {
    if (nodes.empty())
      return {};
    Division best;
    if (nodes.size() > smallest_part)
      for (unsigned int d = 0; d < 3; ++d)
        {
          // A large separator, or one that leaves all others on one side, is
          // no division.
          Division   division = divide(nodes, d);
          const auto least    = [](const Division &a) {
            return std::min(a.below.size(), a.above.size());
          };
          const bool is_useful = 5 * least(division) >= nodes.size();
          if (!division.below.empty() &&
              (best.below.empty() ||
               (is_useful ? 5 * least(best) < nodes.size() ||
                    division.between.size() < best.between.size()
                          : least(division) > least(best))))
            best = std::move(division);
        }
    if (best.below.empty())
      return {add_front(nodes, {})};

    std::vector<unsigned int>       children = dissect(best.below);
    const std::vector<unsigned int> others   = dissect(best.above);
    children.insert(children.end(), others.begin(), others.end());
    if (best.between.empty())
      return children;
    return {add_front(std::move(best.between), std::move(children))};
  }



  // Nothing is below if all nodes have the same coordinate.
  EliminationTree::Division
  EliminationTree::divide(const std::vector<unsigned int> &nodes,
                          const unsigned int               along)
  {
    std::vector<double> values;
    for (const unsigned int i : nodes)
      values.push_back(positions[i][along]);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (!(*low < *high))
      return {};
    // Nodes of a plane of the mesh stay together, but for rounding.
    const double rounding = 1e-9 * (*high - *low);
    std::nth_element(
      values.begin(), values.begin() + values.size() / 2, values.end());
    const double middle = values[values.size() / 2] - rounding;

    Division           result;
    const unsigned int below = n_parts++, above = n_parts++;
    for (const unsigned int i : nodes)
      {
        const bool is_below = positions[i][along] < middle;
        part[i]             = is_below ? below : above;
        if (is_below)
          result.below.push_back(i);
      }
    for (const unsigned int i : nodes)
      if (part[i] == above)
        {
          const bool is_coupled =
            std::any_of(pattern.columns.begin() + pattern.starts[i],
                        pattern.columns.begin() + pattern.starts[i + 1],
                        [&](const unsigned int j) { return part[j] == below; });
          (is_coupled ? result.between : result.above).push_back(i);
        }
    return result;
  }



  void
  EliminationTree::find_borders()
  {
    // The place of each node in the order of elimination, and its front.
    std::vector<unsigned int> place(pattern.n_rows(), nowhere),
      front_of(pattern.n_rows(), nowhere);
    unsigned int n = 0;
    for (unsigned int f = 0; f < all_fronts.size(); ++f)
      for (const unsigned int i : all_fronts[f].nodes)
        {
          place[i]    = n++;
          front_of[i] = f;
        }

    std::vector<unsigned int> seen(pattern.n_rows(), nowhere);
    for (unsigned int f = 0; f < all_fronts.size(); ++f)
      {
        Front     &front = all_fronts[f];
        const auto add   = [&](const unsigned int j) {
          if (front_of[j] != nowhere && front_of[j] > f && seen[j] != f)
            {
              seen[j] = f;
              front.border.push_back(j);
            }
        };
        for (const unsigned int i : front.nodes)
          for (std::size_t e = pattern.starts[i]; e < pattern.starts[i + 1];
               ++e)
            add(pattern.columns[e]);
        for (const unsigned int child : front.children)
          for (const unsigned int j : all_fronts[child].border)
            add(j);
        std::sort(front.border.begin(),
                  front.border.end(),
                  [&](const unsigned int a, const unsigned int b) {
                    return place[a] < place[b];
                  });
      }
  }



  double
  EliminationTree::cost(const unsigned int n_components) const
  {
    double sum = 0;
    for (std::size_t f = 0; f + 1 < all_fronts.size(); ++f)
      {
        const double own    = n_components * all_fronts[f].nodes.size(),
                     others = n_components * all_fronts[f].border.size();
        sum += own * (own * own / 6 + own * others / 2 + others * others / 2);
      }
    return sum;
  }
} // namespace Friction

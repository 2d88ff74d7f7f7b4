#include <common/nodes/node_weights.h>

namespace Friction
{
  NodeWeights::NodeWeights(std::vector<unsigned int> &&starts,
                           std::vector<Entry>        &&entries)
    : starts(std::move(starts))
    , entries(std::move(entries))
  {}



  NodeWeights
  NodeWeights::transposed(
    const unsigned int                                        n_columns,
    const std::vector<std::pair<unsigned int, unsigned int>> &rows) const
  {
    // Counted, then filled: next[c] is where the next entry of row c goes.
    std::vector<unsigned int> next(n_columns + 1, 0);
    for (const auto &row : rows)
      for (const Entry *e = begin(row.first); e != end(row.first); ++e)
        ++next[e->node + 1];
    for (unsigned int c = 0; c < n_columns; ++c)
      next[c + 1] += next[c];
    std::vector<unsigned int> new_starts = next;
    std::vector<Entry>        new_entries(next[n_columns]);
    for (const auto &row : rows)
      for (const Entry *e = begin(row.first); e != end(row.first); ++e)
        new_entries[next[e->node]++] = {row.second, e->weight};
    return NodeWeights(std::move(new_starts), std::move(new_entries));
  }
} // namespace Friction

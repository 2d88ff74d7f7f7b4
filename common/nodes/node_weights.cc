#include <common/nodes/node_weights.h>

namespace Friction
{
  NodeWeights::NodeWeights(const std::vector<std::vector<Entry>> &rows)
  {
    starts.reserve(rows.size() + 1);
    for (const auto &row : rows)
      {
        entries.insert(entries.end(), row.begin(), row.end());
        starts.push_back(entries.size());
      }
  }



  NodeWeights
  NodeWeights::transposed(const unsigned int n_columns) const
  {
    NodeWeights result;
    result.starts.assign(n_columns + 1, 0);
    for (const Entry &entry : entries)
      ++result.starts[entry.node + 1];
    for (unsigned int c = 0; c < n_columns; ++c)
      result.starts[c + 1] += result.starts[c];
    result.entries.resize(entries.size());
    std::vector<unsigned int> next(result.starts.begin(),
                                   result.starts.end() - 1);
    for (unsigned int row = 0; row < n_rows(); ++row)
      for (const Entry *e = begin(row); e != end(row); ++e)
        result.entries[next[e->node]++] = {row, e->weight};
    return result;
  }
} // namespace Friction

#ifndef friction_nodes_node_weights_h
#define friction_nodes_node_weights_h

#include <cstddef>
#include <utility>
#include <vector>

namespace Friction
{
  /**
   * A sparse matrix of scalar weights between nodes, in compressed row storage;
   * it acts on each component of the node values alike.
   *
   * @tparam Column  what the nodes of its columns are numbered by: unsigned int
   *                 if these are nodes of a level, LeafNode if they are nodes
   *                 of the leaf mesh. Rows are nodes of a level; in
   *                 LeafAssembler rows and columns are nodes of the leaf mesh.
   */
  template <typename Column>
  class NodeWeights
  {
  public:
    /** Weights of interpolation are 1, 1/2, 1/4 and 1/8, for which half the
     * digits are plenty. */
    struct Entry
    {
      Column node;
      float  weight;
    };

    NodeWeights() = default;

    /** @param starts  where the entries of each row begin, and the last ones
     *                 end. */
    NodeWeights(std::vector<unsigned int> &&starts,
                std::vector<Entry>        &&entries)
      : starts(std::move(starts))
      , entries(std::move(entries))
    {}

    unsigned int
    n_rows() const
    {
      return starts.size() - 1;
    }

    const Entry *
    begin(const unsigned int row) const
    {
      return row < n_rows() ? entries.data() + starts[row] : nullptr;
    }

    const Entry *
    end(const unsigned int row) const
    {
      return row < n_rows() ? entries.data() + starts[row + 1] : nullptr;
    }

    std::size_t
    memory_consumption() const
    {
      return starts.capacity() * sizeof(unsigned int) +
        entries.capacity() * sizeof(Entry);
    }

  private:
    std::vector<unsigned int> starts = {0};
    std::vector<Entry>        entries;
  };



  /** Rows and columns exchanged, of some of the rows.
   * @param n_columns  will be the number of rows.
   * @param rows       which rows, and the numbers that they will have as
   *                   columns. */
  template <typename Row>
  NodeWeights<Row>
  transposed(const NodeWeights<unsigned int>                 &weights,
             const unsigned int                               n_columns,
             const std::vector<std::pair<unsigned int, Row>> &rows)
  {
    // Counted, then filled: next[c] is where the next entry of row c goes.
    std::vector<unsigned int> next(n_columns + 1, 0);
    for (const auto &row : rows)
      for (auto e = weights.begin(row.first); e != weights.end(row.first); ++e)
        ++next[e->node + 1];
    for (unsigned int c = 0; c < n_columns; ++c)
      next[c + 1] += next[c];
    std::vector<unsigned int>                     starts = next;
    std::vector<typename NodeWeights<Row>::Entry> entries(next[n_columns]);
    for (const auto &row : rows)
      for (auto e = weights.begin(row.first); e != weights.end(row.first); ++e)
        entries[next[e->node]++] = {row.second, e->weight};
    return {std::move(starts), std::move(entries)};
  }
} // namespace Friction

#endif

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
   */
  class NodeWeights
  {
  public:
    /** Weights of interpolation are 1, 1/2, 1/4 and 1/8, for which half the
     * digits are plenty. */
    struct Entry
    {
      unsigned int node;
      float        weight;
    };

    NodeWeights() = default;

    /** @param starts  where the entries of each row begin, and the last ones
     *                 end. */
    NodeWeights(std::vector<unsigned int> &&starts,
                std::vector<Entry>        &&entries);

    /** Rows and columns exchanged, of some of the rows.
     * @param n_columns  will be the number of rows.
     * @param rows       which rows, and the numbers that they will have. */
    NodeWeights transposed(
      const unsigned int                                        n_columns,
      const std::vector<std::pair<unsigned int, unsigned int>> &rows) const;

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
} // namespace Friction

#endif

#ifndef friction_nodes_node_weights_h
#define friction_nodes_node_weights_h

#include <cstddef>
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
    struct Entry
    {
      unsigned int node;
      double       weight;
    };

    NodeWeights() = default;

    explicit NodeWeights(const std::vector<std::vector<Entry>> &rows);

    /** The same weights with rows and columns exchanged. */
    NodeWeights transposed(const unsigned int n_columns) const;

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

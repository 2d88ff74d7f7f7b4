#include <common/levels/elimination_cost.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <vector>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    using Graph = std::vector<std::vector<unsigned int>>;

    // The neighbours of all nodes, on each process. Sent is, per node, how many
    // neighbours it has, and which. Processes own consecutive nodes, in the
    // order of their ranks.
    Graph
    node_graph(const TrilinosWrappers::SparseMatrix &matrix,
               const unsigned int                    n_components)
    {
      std::vector<unsigned int> mine;
      const auto                range = matrix.local_range();
      for (auto row = range.first; row < range.second; row += n_components)
        {
          const std::size_t n_here = mine.size();
          mine.push_back(0);
          // Either of these copies a row.
          const auto end = matrix.end(row);
          for (auto entry = matrix.begin(row); entry != end; ++entry)
            {
              const unsigned int node = entry->column() / n_components;
              if (entry->column() % n_components == 0 &&
                  node != row / n_components)
                mine.push_back(node);
            }
          mine[n_here] = mine.size() - n_here - 1;
        }

      Graph graph;
      graph.reserve(matrix.m() / n_components);
      for (const auto &part :
           Utilities::MPI::all_gather(matrix.get_mpi_communicator(), mine))
        for (auto entry = part.begin(); entry != part.end();)
          {
            const auto n = *entry++;
            graph.emplace_back(entry, entry + n);
            entry += n;
          }
      return graph;
    }



    // Finds layers, in one graph, any number of times. A node belongs to the
    // search that it has been reached by last.
    class Layers
    {
    public:
      explicit Layers(const Graph &graph)
        : graph(graph)
        , reached_by(graph.size(), 0)
      {}

      bool
      has_been_at(const unsigned int node) const
      {
        return reached_by[node] != 0;
      }

      // The layers from one end: as long as the layers become more if they
      // begin at a node of the last one, with the fewest neighbours, they do.
      Graph
      from_one_end(const unsigned int start)
      {
        Graph layers = from(start);
        while (true)
          {
            unsigned int end = layers.back().front();
            for (const unsigned int node : layers.back())
              if (graph[node].size() < graph[end].size())
                end = node;
            if (end == start)
              return layers;
            Graph others = from(end);
            if (others.size() <= layers.size())
              return layers;
            layers = std::move(others);
          }
      }

    private:
      const Graph              &graph;
      std::vector<unsigned int> reached_by;
      unsigned int              n_searches = 0;

      // Layers of what hangs together with a node, which is the first one.
      Graph
      from(const unsigned int start)
      {
        ++n_searches;
        reached_by[start] = n_searches;
        Graph layers(1, {start});
        while (true)
          {
            std::vector<unsigned int> next;
            for (const unsigned int node : layers.back())
              for (const unsigned int neighbour : graph[node])
                if (reached_by[neighbour] != n_searches)
                  {
                    reached_by[neighbour] = n_searches;
                    next.push_back(neighbour);
                  }
            if (next.empty())
              return layers;
            layers.push_back(std::move(next));
          }
      }
    };
  } // namespace



  double
  elimination_cost(const TrilinosWrappers::SparseMatrix &matrix,
                   const unsigned int                    n_components)
  {
    Assert(matrix.local_range().first % n_components == 0 &&
             matrix.m() % n_components == 0,
           ExcMessage("All components of a node belong to one process."));
    const Graph graph = node_graph(matrix, n_components);
    Layers      search(graph);
    double      cost = 0.;
    for (unsigned int start = 0; start < graph.size(); ++start)
      if (!search.has_been_at(start))
        {
          const Graph layers = search.from_one_end(start);
          for (std::size_t l = 0; l < layers.size(); ++l)
            {
              const double here = n_components * layers[l].size();
              const double next =
                l + 1 < layers.size() ? n_components * layers[l + 1].size() : 0;
              cost += here * (here + next) * (here + next);
            }
        }
    return cost;
  }
} // namespace Friction

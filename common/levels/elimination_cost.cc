#include <common/levels/elimination_cost.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

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
          for (auto entry = matrix.begin(row); entry != matrix.end(row);
               ++entry)
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



    // Layers of what hangs together with a node, which is the first one.
    Graph
    layers_from(const unsigned int start, const Graph &graph)
    {
      std::vector<char> is_reached(graph.size(), false);
      is_reached[start] = true;
      Graph layers(1, {start});
      while (true)
        {
          std::vector<unsigned int> next;
          for (const unsigned int node : layers.back())
            for (const unsigned int neighbour : graph[node])
              if (!is_reached[neighbour])
                {
                  is_reached[neighbour] = true;
                  next.push_back(neighbour);
                }
          if (next.empty())
            return layers;
          layers.push_back(std::move(next));
        }
    }



    // The layers from one end: as long as the layers become more if they begin
    // at a node of the last one, with the fewest neighbours, they do.
    Graph
    layers_from_one_end(const unsigned int start, const Graph &graph)
    {
      Graph layers = layers_from(start, graph);
      while (true)
        {
          unsigned int end = layers.back().front();
          for (const unsigned int node : layers.back())
            if (graph[node].size() < graph[end].size())
              end = node;
          Graph others = layers_from(end, graph);
          if (others.size() <= layers.size())
            return layers;
          layers = std::move(others);
        }
    }
  } // namespace



  double
  elimination_cost(const TrilinosWrappers::SparseMatrix &matrix,
                   const unsigned int                    n_components)
  {
    const Graph       graph = node_graph(matrix, n_components);
    std::vector<char> is_done(graph.size(), false);
    double            cost = 0.;
    for (unsigned int start = 0; start < graph.size(); ++start)
      if (!is_done[start])
        {
          const Graph layers = layers_from_one_end(start, graph);
          for (std::size_t l = 0; l < layers.size(); ++l)
            {
              for (const unsigned int node : layers[l])
                is_done[node] = true;
              const double here = n_components * layers[l].size();
              const double next =
                l + 1 < layers.size() ? n_components * layers[l + 1].size() : 0;
              cost += here * (here + next) * (here + next);
            }
        }
    return cost;
  }
} // namespace Friction

#include <common/multigrid/level_hierarchy.h>

#include <deal.II/grid/tria.h>

#include <algorithm>

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



  template <int dim>
  LevelHierarchy<dim>::LevelHierarchy(const DoFHandler<dim>       &dof_handler,
                                      const NodalConstraints<dim> &constraints)
    : levels(dof_handler.get_triangulation().n_global_levels())
    , finest_levels(constraints.n_nodes(), 0)
  {
    const Triangulation<dim> &triangulation = dof_handler.get_triangulation();
    AssertThrow(triangulation.get_mesh_smoothing() &
                  Triangulation<dim>::limit_level_difference_at_vertices,
                ExcMessage("The levels need a triangulation made with "
                           "Triangulation::limit_level_difference_at_vertices, "
                           "so that each hanging node belongs to one level."));

    // Which leaf node is at which vertex, and the range of levels of the active
    // cells around it.
    std::vector<unsigned int>  leaf_node_at(triangulation.n_vertices(),
                                           numbers::invalid_unsigned_int);
    std::vector<unsigned char> coarsest_around(triangulation.n_vertices(), 255);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          {
            const unsigned int leaf_node =
              constraints.node_of_dof(cell->vertex_dof_index(v, 0));
            const unsigned char level           = cell->level();
            leaf_node_at[cell->vertex_index(v)] = leaf_node;
            coarsest_around[cell->vertex_index(v)] =
              std::min(coarsest_around[cell->vertex_index(v)], level);
            finest_levels[leaf_node] =
              std::max(finest_levels[leaf_node], level);
          }

    for (unsigned int k = 0; k < levels.size(); ++k)
      {
        Level             &level   = levels[k];
        const unsigned int n_nodes = dof_handler.n_dofs(k) / dim;
        level.leaf_nodes.assign(n_nodes, numbers::invalid_unsigned_int);
        level.nodes_of_leaf.assign(constraints.n_nodes(),
                                   numbers::invalid_unsigned_int);
        level.edge.assign(n_nodes, 0);
        std::vector<char> touches_refined(n_nodes, 0);

        for (const auto &cell : dof_handler.mg_cell_iterators_on_level(k))
          for (const unsigned int v : cell->vertex_indices())
            {
              const unsigned int node =
                cell->mg_vertex_dof_index(k, v, 0) / dim;
              const unsigned int vertex      = cell->vertex_index(v);
              const unsigned int leaf_node   = leaf_node_at[vertex];
              level.leaf_nodes[node]         = leaf_node;
              level.nodes_of_leaf[leaf_node] = node;
              if (coarsest_around[vertex] < k)
                level.edge[node] = 1;
              if (cell->has_children())
                touches_refined[node] = 1;
            }

        for (unsigned int node = 0; node < n_nodes; ++node)
          {
            const unsigned int leaf_node = level.leaf_nodes[node];
            if (finest_levels[leaf_node] == k &&
                !constraints.is_hanging(leaf_node))
              level.own.push_back(node);
            if (!level.edge[node] && touches_refined[node] &&
                !constraints.is_fixed(leaf_node))
              append(level.relaxed, node);
          }

        // The vertices of the children lie at multiples of one half in the
        // reference cell of their parent, where the d-linear functions of its
        // vertices are products of 0, 1/2 and 1.
        if (k > 0)
          {
            std::vector<std::vector<NodeWeights::Entry>> rows(n_nodes);
            for (const auto &cell :
                 dof_handler.mg_cell_iterators_on_level(k - 1))
              if (cell->has_children())
                for (unsigned int child = 0; child < cell->n_children();
                     ++child)
                  for (const unsigned int v : cell->vertex_indices())
                    {
                      const unsigned int node =
                        cell->child(child)->mg_vertex_dof_index(k, v, 0) / dim;
                      if (!rows[node].empty())
                        continue;
                      for (const unsigned int w : cell->vertex_indices())
                        {
                          double weight = 1.;
                          for (unsigned int d = 0; d < dim; ++d)
                            {
                              const double x =
                                .5 * (((child >> d) & 1) + ((v >> d) & 1));
                              weight *= ((w >> d) & 1) ? x : 1. - x;
                            }
                          if (weight > 0)
                            rows[node].push_back(
                              {static_cast<unsigned int>(
                                 cell->mg_vertex_dof_index(k - 1, w, 0) / dim),
                               weight});
                        }
                    }
            level.parent_weights = NodeWeights(rows);
            levels[k - 1].child_weights =
              level.parent_weights.transposed(levels[k - 1].n_nodes());
          }
      }
  }



  template <int dim>
  std::size_t
  LevelHierarchy<dim>::memory_consumption() const
  {
    std::size_t bytes = finest_levels.capacity();
    for (const Level &level : levels)
      bytes += sizeof(unsigned int) *
          (level.leaf_nodes.capacity() + level.nodes_of_leaf.capacity() +
           level.own.capacity()) +
        level.edge.capacity() + level.parent_weights.memory_consumption() +
        level.child_weights.memory_consumption();
    return bytes;
  }



  template class LevelHierarchy<2>;
  template class LevelHierarchy<3>;
} // namespace Friction

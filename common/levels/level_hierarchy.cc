#include <common/compatibility.h>
#include <common/levels/level_hierarchy.h>
#include <common/parallel/ghost_exchange.h>

#include <deal.II/grid/tria.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace Friction
{
  // Numbers of level nodes are global ones here. One is added to them, so that
  // zero means none, and the maximum over processes is that of the
  // processes that know.
  template <int dim>
  struct LevelHierarchy<dim>::LeafInformation
  {
    std::vector<unsigned char> coarsest_around; ///< level of active cells
    std::vector<double>        level_nodes;     ///< two: on levels f and f-1
  };



  // The global numbers of the parents of owned nodes of one level, 2^dim at
  // most; each of n parents has the weight 1/n.
  template <int dim>
  struct LevelHierarchy<dim>::GlobalParents
  {
    static constexpr unsigned int most = 1u << dim;

    std::vector<unsigned char> numbers;
    std::vector<GlobalNode>    parents; ///< `most` places for each node

    const GlobalNode *
    begin(const unsigned int node) const
    {
      return parents.data() + most * static_cast<std::size_t>(node);
    }

    const GlobalNode *
    end(const unsigned int node) const
    {
      return begin(node) + numbers[node];
    }
  };



  namespace
  {
    void
    sort_and_make_unique(std::vector<unsigned int> &numbers)
    {
      std::sort(numbers.begin(), numbers.end());
      numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    }
  } // namespace



  // Not in the namespace without a name, or a compiler that is given several
  // files as one warns of a member function's lambda that captures such an
  // object.
  namespace LevelHierarchyTools
  {
    // The columns of one row, collected with the help of a marker, so that each
    // appears once.
    class ColumnCollector
    {
    public:
      void
      begin_row()
      {
        ++row;
        columns.clear();
      }

      void
      add(const unsigned int column)
      {
        if (column >= last_row.size())
          last_row.resize(column + 1, 0);
        if (last_row[column] != row)
          {
            last_row[column] = row;
            columns.push_back(column);
          }
      }

      std::vector<unsigned int> columns;

    private:
      unsigned int              row = 0;
      std::vector<unsigned int> last_row;
    };
  } // namespace LevelHierarchyTools



  // One level after the other, from the finest to the coarsest: the couplings
  // of a level follow from those of the next finer one and from the parents.
  template <int dim>
  LevelHierarchy<dim>::LevelHierarchy(const DoFHandler<dim>       &dof_handler,
                                      const NodalConstraints<dim> &constraints,
                                      const NodeBlockMatrix<dim>  &leaf_matrix)
    : levels(dof_handler.get_triangulation().n_global_levels())
    , finest_levels(constraints.n_nodes(), 0)
    , finest_nodes(constraints.n_nodes(), numbers::invalid_unsigned_int)
    , nodes_below(constraints.n_nodes(), numbers::invalid_unsigned_int)
  {
    AssertThrow(dof_handler.get_triangulation().get_mesh_smoothing() &
                  Triangulation<dim>::limit_level_difference_at_vertices,
                ExcMessage("The levels need a triangulation made with "
                           "Triangulation::limit_level_difference_at_vertices, "
                           "so that each hanging node belongs to one level."));

    LeafInformation leaf;
    collect_leaf_information(dof_handler, constraints, leaf);
    for (unsigned int k = 0; k < levels.size(); ++k)
      {
        const IndexSet &owned = dof_handler.locally_owned_mg_dofs(k);
        levels[k].nodes       = NodeNumbering(NodeDistribution(
          owned.n_elements() / dim,
          constraints.numbering().distribution().shared_communicator()));
        Assert(owned.n_elements() == 0 ||
                 owned.nth_index_in_set(0) ==
                   dim * levels[k].nodes.distribution().global(0),
               ExcInternalError());
      }

    for (unsigned int k = levels.size(); k-- > 0;)
      {
        number_leaf_nodes(constraints, leaf, k);
        find_couplings(constraints, leaf_matrix, k);
        if (k > 0)
          {
            GlobalParents parents;
            find_parents(dof_handler, k, parents);
            number_parents(k, parents);
            find_children(k - 1);
          }
      }
    classify_nodes(constraints, leaf);
    make_layouts();
  }



  template <int dim>
  void
  LevelHierarchy<dim>::make_layouts()
  {
    for (Level &level : levels)
      {
        const NodeDistribution &distribution = level.nodes.distribution();
        IndexSet                owned(dim * distribution.n_global());
        IndexSet                ghosts(owned.size());
        if (level.n_nodes() > 0)
          owned.add_range(dim * level.nodes.global(0),
                          dim * (level.nodes.global(0) + level.n_nodes()));
        std::vector<types::global_dof_index> ghost_dofs;
        for (unsigned int i = level.n_nodes(); i < level.n_local_nodes(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            ghost_dofs.push_back(dim * level.nodes.global(i) + d);
        std::sort(ghost_dofs.begin(), ghost_dofs.end());
        ghosts.add_indices(ghost_dofs.begin(), ghost_dofs.end());
        level.layout = std::make_shared<Utilities::MPI::Partitioner>(
          owned, ghosts, distribution.communicator());
      }
  }



  // The owner of a leaf node knows all active cells around it. The number of
  // its level node is known to the owner of an active cell of that level; since
  // cells of one level are all refined at a vertex or none is, the vertex
  // belongs to the next coarser level if it is the corner of the parent.
  template <int dim>
  void
  LevelHierarchy<dim>::collect_leaf_information(
    const DoFHandler<dim>       &dof_handler,
    const NodalConstraints<dim> &constraints,
    LeafInformation             &leaf)
  {
    leaf.coarsest_around.assign(constraints.n_nodes(), 255);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          {
            const unsigned int node =
              constraints.node_of_dof(cell->vertex_dof_index(v, 0));
            const unsigned char level = cell->level();
            leaf.coarsest_around[node] =
              std::min(leaf.coarsest_around[node], level);
            finest_levels[node] = std::max(finest_levels[node], level);
          }

    leaf.level_nodes.assign(2 * constraints.n_nodes(), 0.);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int v : cell->vertex_indices())
          {
            const unsigned int node =
              constraints.node_of_dof(cell->vertex_dof_index(v, 0));
            const int level = cell->level();
            if (level != finest_levels[node])
              continue;
            leaf.level_nodes[2 * node] =
              1 + cell->mg_vertex_dof_index(level, v, 0) / dim;
            if (level > 0 &&
                cell->parent()->vertex_index(v) == cell->vertex_index(v))
              leaf.level_nodes[2 * node + 1] =
                1 + cell->parent()->mg_vertex_dof_index(level - 1, v, 0) / dim;
          }

    GhostExchange exchange(constraints.numbering(),
                           constraints.numbering().all_ghosts());
    exchange.collect(
      leaf.level_nodes.data(), 2, GhostExchange::Combine::maximum);
    exchange.update(leaf.level_nodes.data(), 2);

    std::vector<double> levels_around(finest_levels.begin(),
                                      finest_levels.end());
    exchange.update(levels_around.data(), 1);
    for (unsigned int node = constraints.n_owned_nodes();
         node < constraints.n_nodes();
         ++node)
      finest_levels[node] = static_cast<unsigned char>(levels_around[node]);
  }



  // The vertices of the children lie at multiples of one half in the reference
  // cell of their parent, where the d-linear functions of its vertices are
  // products of 0, 1/2 and 1: at the middle of an edge, a face or a cell its n
  // vertices have the same share.
  template <int dim>
  void
  LevelHierarchy<dim>::find_parents(const DoFHandler<dim> &dof_handler,
                                    const unsigned int     k,
                                    GlobalParents         &parents) const
  {
    constexpr unsigned int  n     = GlobalParents::most;
    const NodeDistribution &owned = levels[k].nodes.distribution();
    parents.numbers.assign(owned.n_owned(), 0);
    parents.parents.resize(n * static_cast<std::size_t>(owned.n_owned()));

    // Which vertices of the parent have a share in vertex v of a child.
    std::array<std::vector<unsigned int>, n * n> sharing;
    for (unsigned int child = 0; child < n; ++child)
      for (unsigned int v = 0; v < n; ++v)
        for (unsigned int w = 0; w < n; ++w)
          {
            bool has_share = true;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const unsigned int twice_x =
                  ((child >> d) & 1) + ((v >> d) & 1);
                if (twice_x + 2 * ((w >> d) & 1) == 2)
                  has_share = false;
              }
            if (has_share)
              sharing[child * n + v].push_back(w);
          }

    std::array<GlobalNode, n> vertices;
    for (const auto &cell : dof_handler.mg_cell_iterators_on_level(k - 1))
      if (cell->has_children())
        {
          for (unsigned int w = 0; w < n; ++w)
            vertices[w] = cell->mg_vertex_dof_index(k - 1, w, 0) / dim;
          for (unsigned int child = 0; child < n; ++child)
            if (const auto finer = cell->child(child);
                finer->is_locally_owned_on_level())
              for (unsigned int v = 0; v < n; ++v)
                {
                  const GlobalNode node =
                    finer->mg_vertex_dof_index(k, v, 0) / dim;
                  if (!owned.is_owned(node))
                    continue;
                  const unsigned int i = owned.local(node);
                  if (parents.numbers[i] == 0)
                    for (const unsigned int w : sharing[child * n + v])
                      parents.parents[n * static_cast<std::size_t>(i) +
                                      parents.numbers[i]++] = vertices[w];
                }
        }
  }



  // Local numbers of the level nodes at our leaf nodes and at those that our
  // rows couple to.
  template <int dim>
  void
  LevelHierarchy<dim>::number_leaf_nodes(
    const NodalConstraints<dim> &constraints,
    const LeafInformation       &leaf,
    const unsigned int           k)
  {
    Level &level = levels[k];
    for (unsigned int i = 0; i < constraints.n_nodes(); ++i)
      if (!constraints.is_hanging(i) &&
          (finest_levels[i] == k || finest_levels[i] == k + 1))
        {
          const bool       is_finest = (finest_levels[i] == k);
          const GlobalNode number    = static_cast<GlobalNode>(
            leaf.level_nodes[2 * i + (is_finest ? 0 : 1)]);
          Assert(number > 0 || !is_finest, ExcInternalError());
          if (number == 0)
            continue;
          const unsigned int node = level.nodes.add(number - 1);
          (is_finest ? finest_nodes : nodes_below)[i] = node;
          if (is_finest && i < constraints.n_owned_nodes())
            level.own.push_back({LeafNode(i), node});
        }
  }



  // What rows of this level couple to. Each process finds what its leaf nodes
  // and its nodes of the next finer level contribute, and sends to others what
  // belongs to their rows.
  template <int dim>
  void
  LevelHierarchy<dim>::find_couplings(const NodalConstraints<dim> &constraints,
                                      const NodeBlockMatrix<dim>  &leaf_matrix,
                                      const unsigned int           k)
  {
    Level     &level     = levels[k];
    const bool has_finer = (k + 1 < levels.size());
    const auto n_owned   = level.n_nodes();

    level.leaf_nodes.assign(level.n_local_nodes(), LeafNode());
    for (unsigned int i = 0; i < constraints.n_owned_nodes(); ++i)
      if (!constraints.is_hanging(i) &&
          (finest_levels[i] == k || finest_levels[i] == k + 1) &&
          node_of_leaf(k, LeafNode(i)) != numbers::invalid_unsigned_int)
        level.leaf_nodes[node_of_leaf(k, LeafNode(i))] = LeafNode(i);

    if (k + 1 == levels.size() && levels.size() > 1)
      {
        // The finest level has no matrix. What couples are leaf nodes.
        for (unsigned int i = constraints.n_owned_nodes();
             i < constraints.n_nodes();
             ++i)
          if (finest_levels[i] == k && !constraints.is_hanging(i) &&
              finest_nodes[i] >= n_owned)
            level.coupled.push_back(finest_nodes[i]);
        for (const auto &own : level.own)
          if (own.node >= n_owned)
            level.coupled.push_back(own.node);
        sort_and_make_unique(level.coupled);
        return;
      }

    auto owned_pattern    = std::make_shared<NodePattern>();
    auto outgoing_pattern = std::make_shared<NodePattern>();
    LevelHierarchyTools::ColumnCollector collector, finer_columns;
    const unsigned int                   n_rows = level.n_local_nodes();
    owned_pattern->starts.reserve(n_owned + 1);
    for (unsigned int row = 0; row < n_rows; ++row)
      {
        collector.begin_row();
        if (const LeafNode leaf = level.leaf_nodes[row]; leaf.exists())
          for (std::size_t e = leaf_matrix.row_begin(leaf.number());
               e < leaf_matrix.row_end(leaf.number());
               ++e)
            {
              const LeafNode other(leaf_matrix.column(e));
              if (std::min(finest_level(leaf), finest_level(other)) == k)
                collector.add(node_of_leaf(k, other));
            }

        // The columns of P^T B first, of which there are far fewer than blocks.
        if (has_finer)
          {
            finer_columns.begin_row();
            for (auto child = level.leaf_child_weights.begin(row);
                 child != level.leaf_child_weights.end(row);
                 ++child)
              for (std::size_t e = leaf_matrix.row_begin(child->node.number());
                   e < leaf_matrix.row_end(child->node.number());
                   ++e)
                if (finest_levels[leaf_matrix.column(e)] == k + 1)
                  finer_columns.add(finest_nodes[leaf_matrix.column(e)]);
            for (auto child = level.child_weights.begin(row);
                 child != level.child_weights.end(row);
                 ++child)
              {
                const NodePattern &finer = *levels[k + 1].owned_pattern;
                for (std::size_t e = finer.starts[child->node];
                     e < finer.starts[child->node + 1];
                     ++e)
                  finer_columns.add(finer.columns[e]);
              }
            const NodeWeights<unsigned int> &parents =
              levels[k + 1].parent_weights;
            for (const unsigned int node : finer_columns.columns)
              for (auto p = parents.begin(node); p != parents.end(node); ++p)
                collector.add(p->node);
          }

        if (row < n_owned)
          owned_pattern->append_row(collector.columns);
        else if (!collector.columns.empty())
          {
            level.outgoing.push_back(row);
            std::sort(collector.columns.begin(), collector.columns.end());
            outgoing_pattern->columns.insert(outgoing_pattern->columns.end(),
                                             collector.columns.begin(),
                                             collector.columns.end());
            outgoing_pattern->starts.push_back(
              outgoing_pattern->columns.size());
          }
      }

    // Rows of others: the number of the row, that of its columns, and those.
    if (level.nodes.distribution().n_processes() > 1)
      {
        std::map<unsigned int, std::vector<GlobalNode>> to_send;
        for (unsigned int r = 0; r < level.outgoing.size(); ++r)
          {
            const GlobalNode row = level.nodes.global(level.outgoing[r]);
            auto &message = to_send[level.nodes.distribution().owner(row)];
            message.push_back(row);
            message.push_back(outgoing_pattern->starts[r + 1] -
                              outgoing_pattern->starts[r]);
            for (std::size_t e = outgoing_pattern->starts[r];
                 e < outgoing_pattern->starts[r + 1];
                 ++e)
              message.push_back(
                level.nodes.global(outgoing_pattern->columns[e]));
          }
        std::map<unsigned int, std::vector<unsigned int>> additional;
        for (const auto &message :
             Utilities::MPI::some_to_some(constraints.communicator(), to_send))
          {
            auto &rows = level.incoming[message.first];
            for (auto entry = message.second.begin();
                 entry != message.second.end();)
              {
                typename Level::IncomingRow incoming;
                incoming.row = level.nodes.distribution().local(*entry++);
                const unsigned int n_columns = *entry++;
                for (unsigned int c = 0; c < n_columns; ++c)
                  incoming.columns.push_back(level.nodes.add(*entry++));
                auto &row = additional[incoming.row];
                row.insert(
                  row.end(), incoming.columns.begin(), incoming.columns.end());
                rows.push_back(std::move(incoming));
              }
          }
        if (!additional.empty())
          {
            auto merged = std::make_shared<NodePattern>();
            merged->starts.reserve(n_owned + 1);
            for (unsigned int row = 0; row < n_owned; ++row)
              {
                collector.begin_row();
                for (std::size_t e = owned_pattern->starts[row];
                     e < owned_pattern->starts[row + 1];
                     ++e)
                  collector.add(owned_pattern->columns[e]);
                const auto more = additional.find(row);
                if (more != additional.end())
                  for (const unsigned int column : more->second)
                    collector.add(column);
                merged->append_row(collector.columns);
              }
            owned_pattern = merged;
          }
      }
    owned_pattern->template complete<dim>();
    for (const unsigned int column : owned_pattern->columns)
      if (column >= n_owned)
        level.coupled.push_back(column);
    sort_and_make_unique(level.coupled);
    level.owned_pattern    = owned_pattern;
    level.outgoing_pattern = outgoing_pattern;
    level.leaf_nodes.resize(level.n_local_nodes());
  }



  // Parents of owned nodes are known; those of ghosts that something couples to
  // are asked of their owners.
  template <int dim>
  void
  LevelHierarchy<dim>::number_parents(const unsigned int k,
                                      GlobalParents     &parents)
  {
    const Level   &level  = levels[k];
    NodeNumbering &coarse = levels[k - 1].nodes;

    std::unordered_map<unsigned int, std::vector<GlobalNode>> of_ghosts;
    if (level.nodes.distribution().n_processes() > 1)
      {
        const MPI_Comm comm = level.nodes.distribution().communicator();
        std::map<unsigned int, std::vector<GlobalNode>>   wanted, answers;
        std::map<unsigned int, std::vector<unsigned int>> ghosts;
        for (const unsigned int ghost : level.coupled)
          {
            const GlobalNode   node = level.nodes.global(ghost);
            const unsigned int rank = level.nodes.distribution().owner(node);
            wanted[rank].push_back(node);
            ghosts[rank].push_back(ghost);
          }
        for (const auto &request : Utilities::MPI::some_to_some(comm, wanted))
          for (const GlobalNode node : request.second)
            {
              const unsigned int i = level.nodes.distribution().local(node);
              answers[request.first].push_back(parents.numbers[i]);
              answers[request.first].insert(
                answers[request.first].end(), parents.begin(i), parents.end(i));
            }
        for (const auto &answer : Utilities::MPI::some_to_some(comm, answers))
          {
            auto entry = answer.second.begin();
            for (const unsigned int ghost : ghosts[answer.first])
              {
                const unsigned int n = *entry++;
                of_ghosts[ghost].assign(entry, entry + n);
                entry += n;
              }
          }
      }

    std::vector<unsigned int>                     starts = {0};
    std::vector<NodeWeights<unsigned int>::Entry> entries;
    starts.reserve(level.n_local_nodes() + 1);
    entries.reserve(std::accumulate(
      parents.numbers.begin(), parents.numbers.end(), std::size_t(0)));
    const auto add_row = [&](const GlobalNode *begin, const GlobalNode *end) {
      for (const GlobalNode *parent = begin; parent != end; ++parent)
        entries.push_back({coarse.add(*parent), 1.f / (end - begin)});
      starts.push_back(entries.size());
    };
    for (unsigned int node = 0; node < level.n_nodes(); ++node)
      add_row(parents.begin(node), parents.end(node));
    for (unsigned int node = level.n_nodes(); node < level.n_local_nodes();
         ++node)
      {
        const std::vector<GlobalNode> &row = of_ghosts[node];
        add_row(row.data(), row.data() + row.size());
      }
    levels[k].parent_weights =
      NodeWeights<unsigned int>(std::move(starts), std::move(entries));
  }



  // The transpose for what this process owns: nodes of level k+1, or leaf nodes
  // if that is the finest.
  template <int dim>
  void
  LevelHierarchy<dim>::find_children(const unsigned int k)
  {
    Level       &level = levels[k];
    const Level &finer = levels[k + 1];

    const auto transpose = [&](auto &children, const auto &rows) {
      children = transposed(finer.parent_weights, level.n_local_nodes(), rows);
      for (unsigned int node = level.n_nodes(); node < level.n_local_nodes();
           ++node)
        if (children.begin(node) != children.end(node))
          level.transferred.push_back(node);
    };

    // Rows of the parents' weights, and their numbers as children.
    level.finer_is_last = (k + 2 == levels.size());
    if (level.finer_is_last)
      {
        std::vector<std::pair<unsigned int, LeafNode>> rows;
        for (const auto &own : finer.own)
          rows.emplace_back(own.node, own.leaf);
        transpose(level.leaf_child_weights, rows);
      }
    else
      {
        std::vector<std::pair<unsigned int, unsigned int>> rows;
        for (unsigned int node = 0; node < finer.n_nodes(); ++node)
          rows.emplace_back(node, node);
        transpose(level.child_weights, rows);
      }
  }



  // What is known of a leaf node becomes known at its level node, and from
  // there at the nodes of the coarser levels at the same vertex: those that are
  // its only parents.
  template <int dim>
  void
  LevelHierarchy<dim>::classify_nodes(const NodalConstraints<dim> &constraints,
                                      const LeafInformation       &leaf)
  {
    std::vector<double> finer_attributes;
    for (unsigned int k = levels.size(); k-- > 0;)
      {
        Level             &level   = levels[k];
        const unsigned int n_owned = level.n_nodes();

        // Flags, coarsest and finest level around, in one number.
        std::vector<double> attributes(level.n_local_nodes(), 0.);
        for (unsigned int i = 0; i < constraints.n_owned_nodes(); ++i)
          if (finest_levels[i] == k)
            {
              unsigned int bits =
                constraints.is_hanging(i) ? Level::hanging_bit : 0;
              for (unsigned int d = 0; d < dim; ++d)
                if (constraints.is_prescribed(i, d))
                  bits |= 1u << d;
              const unsigned int node = constraints.is_hanging(i)
                ? level.nodes.add(leaf.level_nodes[2 * i] - 1)
                : finest_nodes[i];
              attributes.resize(level.n_local_nodes(), 0.);
              attributes[node] =
                1. + bits + 256. * leaf.coarsest_around[i] + 65536. * k;
            }
        if (k + 1 < levels.size())
          {
            const NodeWeights<unsigned int> &parents =
              levels[k + 1].parent_weights;
            for (unsigned int node = 0; node < levels[k + 1].n_nodes(); ++node)
              if (parents.end(node) == parents.begin(node) + 1)
                {
                  double &value = attributes[parents.begin(node)->node];
                  value         = std::max(value, finer_attributes[node]);
                }
          }
        GhostExchange exchange(level.nodes, level.nodes.all_ghosts());
        exchange.collect(attributes.data(), 1, GhostExchange::Combine::maximum);

        level.edge.resize(n_owned);
        level.flags.resize(n_owned);
        for (unsigned int node = 0; node < n_owned; ++node)
          {
            Assert(attributes[node] > 0, ExcInternalError());
            const auto code = static_cast<unsigned int>(attributes[node]) - 1;
            const unsigned int  finest     = code / 65536;
            const unsigned int  coarsest   = code / 256 % 256;
            const unsigned char components = (1u << dim) - 1;
            level.flags[node]              = code % 256;
            level.edge[node]               = (coarsest < k);
            if (!level.edge[node] && finest > k && !level.is_hanging(node) &&
                (level.flags[node] & components) != components)
              append(level.relaxed, node);
          }
        finer_attributes = std::move(attributes);

        for (const auto &own : level.own)
          if (own.node >= n_owned)
            level.transferred.push_back(own.node);
        sort_and_make_unique(level.transferred);
        level.leaf_nodes.resize(level.n_local_nodes());
      }
  }



  template <int dim>
  std::size_t
  LevelHierarchy<dim>::memory_consumption() const
  {
    std::size_t bytes = finest_levels.capacity() +
      (finest_nodes.capacity() + nodes_below.capacity()) * sizeof(unsigned int);
    for (const Level &level : levels)
      bytes += sizeof(unsigned int) *
          (level.leaf_nodes.capacity() + 2 * level.own.capacity()) +
        level.edge.capacity() + level.flags.capacity() +
        level.parent_weights.memory_consumption() +
        level.child_weights.memory_consumption() +
        level.leaf_child_weights.memory_consumption() +
        level.nodes.memory_consumption();
    return bytes;
  }



  template class LevelHierarchy<2>;
  template class LevelHierarchy<3>;
} // namespace Friction

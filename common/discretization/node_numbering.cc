#include <common/discretization/node_numbering.h>
#include <common/nodes/sweep_schedule.h>

#include <deal.II/base/index_set.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace Friction
{
  namespace
  {
    // Which nodes have a cell in common. Cells are given by their nodes, one
    // cell after the other, each with the same number of them.
    class Neighbours
    {
    public:
      Neighbours(const unsigned int               n_nodes,
                 const std::vector<unsigned int> &cell_nodes,
                 const unsigned int               nodes_per_cell)
        : cell_nodes(cell_nodes)
        , nodes_per_cell(nodes_per_cell)
        , cells_start(n_nodes + 1, 0)
        , cells(cell_nodes.size())
      {
        for (const unsigned int node : cell_nodes)
          ++cells_start[node + 1];
        for (unsigned int i = 0; i < n_nodes; ++i)
          cells_start[i + 1] += cells_start[i];
        std::vector<unsigned int> fill(cells_start.begin(),
                                       cells_start.end() - 1);
        for (std::size_t i = 0; i < cell_nodes.size(); ++i)
          cells[fill[cell_nodes[i]]++] = i / nodes_per_cell;
      }

      unsigned int
      n_nodes() const
      {
        return cells_start.size() - 1;
      }

      // Calls f for each neighbour of a node, some of them several times.
      template <typename Function>
      void
      for_each(const unsigned int node, const Function &f) const
      {
        for (unsigned int c = cells_start[node]; c < cells_start[node + 1]; ++c)
          for (unsigned int v = 0; v < nodes_per_cell; ++v)
            f(cell_nodes[cells[c] * nodes_per_cell + v]);
      }

    private:
      const std::vector<unsigned int> &cell_nodes;
      const unsigned int               nodes_per_cell;

      // The cells around each node, in compressed storage.
      std::vector<unsigned int> cells_start, cells;
    };



    // Appends the nodes that can be reached from start nodes, level by level.
    void
    breadth_first_search(const std::vector<unsigned int> &start,
                         const Neighbours                &neighbours,
                         std::vector<char>               &visited,
                         std::vector<unsigned int>       &order)
    {
      std::size_t next = order.size();
      for (const unsigned int node : start)
        {
          order.push_back(node);
          visited[node] = 1;
        }
      for (; next < order.size(); ++next)
        neighbours.for_each(order[next], [&](const unsigned int node) {
          if (!visited[node])
            {
              visited[node] = 1;
              order.push_back(node);
            }
        });
    }



    // From the start nodes, if there are any; all that cannot be reached from
    // there gets a start at its rim.
    std::vector<unsigned int>
    cuthill_mckee(const Neighbours                &neighbours,
                  const std::vector<unsigned int> &start_nodes)
    {
      const unsigned int        n_nodes = neighbours.n_nodes();
      std::vector<unsigned int> order;
      std::vector<char>         visited(n_nodes, 0);
      order.reserve(n_nodes);
      breadth_first_search(start_nodes, neighbours, visited, order);
      for (unsigned int i = 0; i < n_nodes; ++i)
        if (!visited[i])
          {
            // The node farthest from any node lies at the rim; start there.
            const std::size_t begin = order.size();
            breadth_first_search({i}, neighbours, visited, order);
            const unsigned int far = order.back();
            for (std::size_t k = begin; k < order.size(); ++k)
              visited[order[k]] = 0;
            order.resize(begin);
            breadth_first_search({far}, neighbours, visited, order);
          }
      return order;
    }



    // By vertices: the levels of the coarsest and of the finest active cell
    // around each.
    template <int dim>
    std::vector<std::array<int, 2>>
    levels_around_vertices(const Triangulation<dim> &mesh)
    {
      std::vector<std::array<int, 2>> result(
        mesh.n_vertices(), {{std::numeric_limits<int>::max(), -1}});
      for (const auto &cell : mesh.active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int v : cell->vertex_indices())
            {
              std::array<int, 2> &around = result[cell->vertex_index(v)];
              around[0]                  = std::min(around[0], cell->level());
              around[1]                  = std::max(around[1], cell->level());
            }
      return result;
    }



    // Among the degrees of freedom of a leaf mesh, the first one of each vertex
    // on the contact boundary.
    template <int dim>
    std::vector<types::global_dof_index>
    contact_dofs(
      const DoFHandler<dim>                               &dof_handler,
      const std::function<bool(const types::boundary_id)> &has_contact)
    {
      std::vector<types::global_dof_index> result;
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (!cell->is_artificial() && cell->at_boundary())
          for (const unsigned int f : cell->face_indices())
            if (cell->at_boundary(f) &&
                has_contact(cell->face(f)->boundary_id()))
              for (unsigned int v = 0; v < cell->face(f)->n_vertices(); ++v)
                result.push_back(cell->face(f)->vertex_dof_index(v, 0));
      return result;
    }



    // The new numbers of the locally owned degrees of freedom, given the first
    // degree of freedom of each vertex of each cell, and of each vertex that is
    // to be the last of its chunk.
    template <int dim>
    std::vector<types::global_dof_index>
    new_numbers(const IndexSet                             &owned,
                const std::vector<types::global_dof_index> &vertex_dofs,
                const std::vector<types::global_dof_index> &last_dofs)
    {
      // Cells with nodes of other processes repeat their first owned node in
      // place of the others. Their owned nodes are those at an interface to
      // other processes, and come first.
      const unsigned int        nodes_per_cell = 1u << dim;
      const unsigned int        n_nodes        = owned.n_elements() / dim;
      std::vector<unsigned int> kept;
      std::vector<char>         at_interface(n_nodes, 0);
      kept.reserve(vertex_dofs.size());

      // deal.II gives a process consecutive numbers, on the leaf mesh and on
      // each level.
      Assert(owned.is_contiguous(), ExcInternalError());
      constexpr unsigned int        elsewhere = numbers::invalid_unsigned_int;
      const types::global_dof_index first =
        n_nodes > 0 ? owned.nth_index_in_set(0) : 0;
      const auto own_node = [&](const types::global_dof_index dof) {
        return dof >= first && dof < first + owned.n_elements()
          ? static_cast<unsigned int>((dof - first) / dim)
          : elsewhere;
      };

      for (std::size_t c = 0; c < vertex_dofs.size(); c += nodes_per_cell)
        {
          unsigned int some_owned = elsewhere;
          unsigned int n_owned    = 0;
          for (unsigned int v = 0; v < nodes_per_cell; ++v)
            if (own_node(vertex_dofs[c + v]) != elsewhere)
              {
                some_owned = own_node(vertex_dofs[c + v]);
                ++n_owned;
              }
          if (n_owned == 0)
            continue;
          for (unsigned int v = 0; v < nodes_per_cell; ++v)
            {
              const unsigned int node = own_node(vertex_dofs[c + v]);
              kept.push_back(node != elsewhere ? node : some_owned);
              if (n_owned < nodes_per_cell)
                at_interface[kept.back()] = 1;
            }
        }

      std::vector<unsigned int> interface;
      for (unsigned int i = 0; i < n_nodes; ++i)
        if (at_interface[i])
          interface.push_back(i);
      std::vector<unsigned int> order =
        cuthill_mckee(Neighbours(n_nodes, kept, nodes_per_cell), interface);
      std::vector<char> is_last(n_nodes, 0);
      for (const types::global_dof_index dof : last_dofs)
        if (own_node(dof) != elsewhere)
          is_last[own_node(dof)] = 1;
      for (unsigned int begin = 0; begin < n_nodes; begin += nodes_per_chunk)
        std::stable_partition(
          order.begin() + begin,
          order.begin() + std::min(n_nodes, begin + nodes_per_chunk),
          [&](const unsigned int node) { return !is_last[node]; });
      std::vector<types::global_dof_index> numbers(owned.n_elements());
      for (unsigned int i = 0; i < n_nodes; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          numbers[dim * order[i] + d] = first + dim * i + d;
      return numbers;
    }



    // The new numbers of the finest level, after the leaf mesh has been
    // renumbered, if both are the same mesh: those of the leaf mesh. None if
    // the leaf mesh has other nodes, or if this process does not own the same
    // ones of both.
    template <int dim>
    std::vector<types::global_dof_index>
    numbers_of_leaf(const DoFHandler<dim> &dof_handler,
                    const unsigned int     finest_level)
    {
      const IndexSet &owned = dof_handler.locally_owned_mg_dofs(finest_level);
      if (owned.size() != dof_handler.n_dofs() ||
          !(owned == dof_handler.locally_owned_dofs()))
        return {};
      std::vector<types::global_dof_index> result(owned.n_elements(),
                                                  numbers::invalid_dof_index);
      for (const auto &cell :
           dof_handler.mg_cell_iterators_on_level(finest_level))
        if (cell->level_subdomain_id() != numbers::artificial_subdomain_id &&
            !cell->is_artificial())
          for (const unsigned int v : cell->vertex_indices())
            {
              const auto dof = cell->mg_vertex_dof_index(finest_level, v, 0);
              if (owned.is_element(dof))
                for (unsigned int d = 0; d < dim; ++d)
                  result[owned.index_within_set(dof) + d] =
                    cell->vertex_dof_index(v, d);
            }
      if (std::any_of(result.begin(), result.end(), [&](const auto number) {
            return number == numbers::invalid_dof_index ||
              !owned.is_element(number);
          }))
        result.clear();
      return result;
    }
  } // namespace



  template <int dim>
  void
  renumber_nodes(
    DoFHandler<dim>                                     &dof_handler,
    const std::function<bool(const types::boundary_id)> &has_contact)
  {
    std::vector<types::global_dof_index> vertex_dofs;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          vertex_dofs.push_back(cell->vertex_dof_index(v, 0));
    dof_handler.renumber_dofs(
      new_numbers<dim>(dof_handler.locally_owned_dofs(),
                       vertex_dofs,
                       contact_dofs(dof_handler, has_contact)));

    // A node of a level that touches no refined cell, or a coarser one, is not
    // relaxed there; see LevelHierarchy.
    const auto around = levels_around_vertices(dof_handler.get_triangulation());
    std::vector<types::global_dof_index> not_relaxed;
    const unsigned int                   n_levels =
      dof_handler.get_triangulation().n_global_levels();
    for (unsigned int level = 0; level < n_levels; ++level)
      {
        if (level == n_levels - 1)
          {
            const auto of_leaf = numbers_of_leaf(dof_handler, level);
            if (!of_leaf.empty())
              {
                dof_handler.renumber_dofs(level, of_leaf);
                break;
              }
          }
        vertex_dofs.clear();
        not_relaxed.clear();
        for (const auto &cell : dof_handler.mg_cell_iterators_on_level(level))
          if (cell->level_subdomain_id() != numbers::artificial_subdomain_id)
            for (const unsigned int v : cell->vertex_indices())
              {
                vertex_dofs.push_back(cell->mg_vertex_dof_index(level, v, 0));
                const std::array<int, 2> &levels =
                  around[cell->vertex_index(v)];
                if (levels[0] < static_cast<int>(level) ||
                    levels[1] <= static_cast<int>(level))
                  not_relaxed.push_back(vertex_dofs.back());
              }
        dof_handler.renumber_dofs(
          level,
          new_numbers<dim>(dof_handler.locally_owned_mg_dofs(level),
                           vertex_dofs,
                           not_relaxed));
      }
  }



  template void
  renumber_nodes(DoFHandler<2> &,
                 const std::function<bool(const types::boundary_id)> &);
  template void
  renumber_nodes(DoFHandler<3> &,
                 const std::function<bool(const types::boundary_id)> &);
} // namespace Friction

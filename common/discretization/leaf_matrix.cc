#include <common/compatibility.h>
#include <common/discretization/leaf_matrix.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <numeric>

namespace Friction
{
  namespace
  {
    template <typename Number>
    void
    sort_and_make_unique(std::vector<Number> &numbers)
    {
      std::sort(numbers.begin(), numbers.end());
      numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    }



    // Where the block of a column is that is known to be stored with the row,
    // by the order of NodePattern::is_before(). Half of all steps of a search
    // go one way and half the other, which no processor can guess; this one has
    // no jumps that depend on what it finds.
    template <int dim>
    inline std::size_t
    position(const NodeBlockMatrix<dim> &rows,
             const unsigned int          row,
             const unsigned int          column)
    {
      const unsigned int *const begin = rows.sparsity().columns.data();
      const unsigned int       *it    = begin + rows.row_begin(row);
      std::size_t               n = rows.stored_end(row) - rows.row_begin(row);
      while (n > 1)
        {
          const std::size_t half = n / 2;
          it = NodePattern::is_before(row, column, it[half]) ? it : it + half;
          n -= half;
        }
      Assert(*it == column, ExcInternalError());
      return it - begin;
    }
  } // namespace



  template <int dim>
  LeafAssembler<dim>::LeafAssembler(const DoFHandler<dim> &dof_handler,
                                    const AffineConstraints<double> &hanging)
    : communicator(Compatibility::mpi_communicator(dof_handler))
    , coupled(dof_handler.n_dofs())
  {
    // The degrees of freedom of a node have consecutive numbers, dim to a node.
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int v : cell->vertex_indices())
          {
            const auto dof = cell->vertex_dof_index(v, 0);
            vertex_nodes.push_back(dof / dim);
            if (hanging.is_constrained(dof) &&
                masters.find(dof / dim) == masters.end())
              for (const auto &entry : *hanging.get_constraint_entries(dof))
                masters[dof / dim].push_back(
                  {static_cast<GlobalNode>(entry.first / dim),
                   static_cast<float>(entry.second)});
          }
    if (Utilities::MPI::n_mpi_processes(communicator) > 1)
      exchange_patterns(dof_handler.locally_owned_dofs());
  }



  // None if the node does not hang.
  template <int dim>
  std::pair<const typename LeafAssembler<dim>::Master *,
            const typename LeafAssembler<dim>::Master *>
  LeafAssembler<dim>::masters_of(const GlobalNode node) const
  {
    if (constraints != nullptr)
      return {local_masters.begin(node), local_masters.end(node)};
    const auto its_masters = masters.find(node);
    if (its_masters == masters.end())
      return {nullptr, nullptr};
    return {its_masters->second.data(),
            its_masters->second.data() + its_masters->second.size()};
  }



  // Numbers of nodes are those of make_numbers_local(), or still global ones.
  template <int dim>
  void
  LeafAssembler<dim>::collect_shares(const std::size_t cell)
  {
    shares.clear();
    for (unsigned int v = 0; v < n_vertices; ++v)
      {
        const GlobalNode node   = vertex_nodes[cell * n_vertices + v];
        const auto [begin, end] = masters_of(node);
        if (begin == end)
          shares.push_back({node, v, 1.});
        for (const Master *master = begin; master != end; ++master)
          shares.push_back({master->node, v, master->weight});
      }
  }



  template <int dim>
  void
  LeafAssembler<dim>::exchange_patterns(const IndexSet &owned_dofs)
  {
    // The rows of others in our cells.
    const auto is_owned = [&](const GlobalNode node) {
      return owned_dofs.is_element(static_cast<types::global_dof_index>(node) *
                                   dim);
    };
    std::map<GlobalNode, std::vector<GlobalNode>> rows;
    for (std::size_t cell = 0; cell < vertex_nodes.size() / n_vertices; ++cell)
      {
        collect_shares(cell);
        for (const Share &row : shares)
          if (!is_owned(row.node))
            for (const Share &column : shares)
              rows[row.node].push_back(column.node);
      }

    IndexSet foreign(owned_dofs.size());
    for (auto &row : rows)
      {
        sort_and_make_unique(row.second);
        foreign.add_index(row.first * dim);
      }
    foreign.compress();
    const std::vector<unsigned int> owners =
      Utilities::MPI::compute_index_owner(owned_dofs, foreign, communicator);

    // A message is a sequence of rows: number, number of columns, columns.
    std::map<unsigned int, std::vector<GlobalNode>> messages;
    auto                                            owner = owners.begin();
    for (auto &row : rows)
      {
        std::vector<GlobalNode> &message = messages[*owner];
        message.push_back(row.first);
        message.push_back(row.second.size());
        message.insert(message.end(), row.second.begin(), row.second.end());
        outgoing[*owner++].push_back({row.first, std::move(row.second)});
      }
    for (const auto &message :
         Utilities::MPI::some_to_some(communicator, messages))
      for (auto it = message.second.begin(); it != message.second.end();)
        {
          Row row;
          row.row                    = *it++;
          const GlobalNode n_columns = *it++;
          row.columns.assign(it, it + n_columns);
          it += n_columns;
          for (const GlobalNode column : row.columns)
            if (!is_owned(column))
              coupled.add_range(column * dim, (column + 1) * dim);
          incoming[message.first].push_back(std::move(row));
        }
    coupled.compress();
  }



  template <int dim>
  void
  LeafAssembler<dim>::make_numbers_local()
  {
    const auto local = [&](const GlobalNode node) {
      return static_cast<GlobalNode>(constraints->node_of_dof(
        static_cast<types::global_dof_index>(node) * dim));
    };
    for (GlobalNode &node : vertex_nodes)
      node = local(node);
    std::vector<unsigned int> starts(constraints->n_nodes() + 1, 0);
    for (const auto &hanging : masters)
      starts[local(hanging.first) + 1] = hanging.second.size();
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<Master> entries(starts.back());
    for (const auto &hanging : masters)
      {
        unsigned int place = starts[local(hanging.first)];
        for (const Master &master : hanging.second)
          entries[place++] = {local(master.node), master.weight};
      }
    local_masters =
      NodeWeights<GlobalNode>(std::move(starts), std::move(entries));
    masters.clear();
    for (auto *all : {&outgoing, &incoming})
      for (auto &process : *all)
        for (Row &row : process.second)
          {
            row.row = local(row.row);
            for (GlobalNode &column : row.columns)
              column = local(column);
          }
  }



  template <int dim>
  void
  LeafAssembler<dim>::make_patterns()
  {
    const unsigned int n_rows  = constraints->n_owned_nodes();
    const std::size_t  n_cells = vertex_nodes.size() / n_vertices;

    // The cells in which each of our rows has a share, and after that the rows
    // of which others have found a part.
    std::vector<std::size_t> cells_begin(n_rows + 1, 0);
    for (std::size_t cell = 0; cell < n_cells; ++cell)
      {
        collect_shares(cell);
        for (const Share &share : shares)
          if (share.node < n_rows)
            ++cells_begin[share.node + 1];
      }
    for (unsigned int i = 0; i < n_rows; ++i)
      cells_begin[i + 1] += cells_begin[i];
    std::vector<unsigned int> cells(cells_begin[n_rows]);
    for (std::size_t cell = n_cells; cell-- > 0;)
      {
        collect_shares(cell);
        for (const Share &share : shares)
          if (share.node < n_rows)
            cells[--cells_begin[share.node + 1]] = cell;
      }
    // Now the cells of row i begin at cells_begin[i + 1].
    std::unordered_map<unsigned int, std::vector<GlobalNode>> from_others;
    for (const auto &process : incoming)
      for (const Row &row : process.second)
        from_others[row.row].insert(
          from_others[row.row].end(), row.columns.begin(), row.columns.end());

    auto                      pattern = std::make_shared<NodePattern>();
    std::vector<unsigned int> columns;
    std::vector<unsigned int> last_row(constraints->n_nodes(),
                                       numbers::invalid_unsigned_int);
    pattern->starts.reserve(n_rows + 1);
    for (unsigned int i = 0; i < n_rows; ++i)
      {
        columns.clear();
        const auto add = [&](const unsigned int column) {
          if (last_row[column] != i)
            {
              last_row[column] = i;
              columns.push_back(column);
            }
        };
        const std::size_t end =
          i + 1 < n_rows ? cells_begin[i + 2] : cells.size();
        for (std::size_t c = cells_begin[i + 1]; c < end; ++c)
          {
            if (c > cells_begin[i + 1] && cells[c] == cells[c - 1])
              continue;
            collect_shares(cells[c]);
            for (const Share &share : shares)
              add(share.node);
          }
        const auto more = from_others.find(i);
        if (more != from_others.end())
          for (const GlobalNode column : more->second)
            add(column);
        pattern->append_row(columns);
      }
    pattern->template complete<dim>();
    owned_pattern = pattern;

    pattern = std::make_shared<NodePattern>();
    outgoing_row_of_ghost.assign(constraints->n_nodes() - n_rows,
                                 numbers::invalid_unsigned_int);
    for (const auto &process : outgoing)
      for (const Row &row : process.second)
        {
          outgoing_row_of_ghost[row.row - n_rows] = pattern->n_rows();
          columns.assign(row.columns.begin(), row.columns.end());
          pattern->append_row(columns);
        }
    outgoing_pattern = pattern;
  }



  template <int dim>
  void
  LeafAssembler<dim>::begin(const NodalConstraints<dim> &new_constraints)
  {
    Assert(constraints == nullptr, ExcMessage("Call begin() once."));
    constraints = &new_constraints;
    make_numbers_local();
    make_patterns();
    owned_rows    = NodeBlockMatrix<dim>(owned_pattern);
    outgoing_rows = NodeBlockMatrix<dim>(outgoing_pattern);
  }



  template <int dim>
  void
  LeafAssembler<dim>::add(CellBlocks<dim>  &blocks,
                          const CellForces &cell_forces,
                          VectorType       &forces)
  {
    AssertIndexRange(n_cells_done, vertex_nodes.size() / n_vertices);
    const unsigned int n_owned = constraints->n_owned_nodes();
    blocks.mirror();
    collect_shares(n_cells_done++);
    for (const Share &i : shares)
      {
        for (unsigned int d = 0; d < dim; ++d)
          forces.local_element(dim * i.node + d) +=
            i.weight * cell_forces[i.vertex][d];

        const bool            is_owned = i.node < n_owned;
        NodeBlockMatrix<dim> &rows     = is_owned ? owned_rows : outgoing_rows;
        const unsigned int    row =
          is_owned ? i.node : outgoing_row_of_ghost[i.node - n_owned];
        for (const Share &j : shares)
          {
            if (stores_half<dim> && is_owned && j.node < i.node)
              continue;
            double *block = rows.block(row, position(rows, row, j.node));
            const Tensor<2, dim> &values = blocks(i.vertex, j.vertex);
            const double          weight = i.weight * j.weight;
            for (unsigned int r = 0; r < dim; ++r)
              for (unsigned int c = 0; c < dim; ++c)
                block[r * dim + c] += weight * values[r][c];
          }
      }
  }



  template <int dim>
  void
  LeafAssembler<dim>::finish(VectorType &forces)
  {
    AssertThrow(n_cells_done * n_vertices == vertex_nodes.size(),
                ExcMessage("Each of the process' own active cells has to be "
                           "added, in the order of the iterator."));
    forces.compress(VectorOperation::add);
    if (Utilities::MPI::n_mpi_processes(communicator) > 1)
      {
        std::map<unsigned int, std::vector<double>> messages;
        const unsigned int n_owned = constraints->n_owned_nodes();
        for (const auto &process : outgoing)
          for (const Row &row : process.second)
            for (const GlobalNode column : row.columns)
              {
                const unsigned int number =
                  outgoing_row_of_ghost[row.row - n_owned];
                const double *block = outgoing_rows.block(
                  number, position(outgoing_rows, number, column));
                messages[process.first].insert(
                  messages[process.first].end(), block, block + dim * dim);
              }
        const auto received =
          Utilities::MPI::some_to_some(communicator, messages);
        for (const auto &process : incoming)
          {
            const double *values = received.at(process.first).data();
            for (const Row &row : process.second)
              for (const GlobalNode column : row.columns)
                {
                  if (!stores_half<dim> || column >= row.row)
                    {
                      double *block = owned_rows.block(
                        row.row, position(owned_rows, row.row, column));
                      for (unsigned int e = 0; e < dim * dim; ++e)
                        block[e] += values[e];
                    }
                  values += dim * dim;
                }
          }
      }
    outgoing_rows = NodeBlockMatrix<dim>();
  }



  template class LeafAssembler<2>;
  template class LeafAssembler<3>;
} // namespace Friction

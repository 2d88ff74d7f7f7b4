#include <common/levels/level_matrices.h>
#include <common/nodes/interface_damping.h>
#include <common/parallel/phase_costs.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <initializer_list>

namespace Friction
{
  namespace
  {
    constexpr int tag = 4712;

    // To the left of the diagonal, where it need not be added.
    constexpr std::size_t is_elsewhere = static_cast<std::size_t>(-1);
  } // namespace



  template <int dim>
  LevelMatrices<dim>::LevelMatrices(const NodeBlockMatrix<dim>  &leaf_matrix,
                                    const LevelHierarchy<dim>   &hierarchy,
                                    const NodalConstraints<dim> &constraints)
    : leaf_matrix(leaf_matrix)
    , hierarchy(hierarchy)
    , constraints(constraints)
    , truncation(constraints)
    , matrices(std::max(1u, hierarchy.n_levels() - 1))
    , inverses(matrices.size())
    , untruncated_traces(matrices.size())
    , outgoing(matrices.size())
    , incoming(matrices.size())
    , parts_of_row(matrices.size())
    , outgoing_row_of(matrices.size())
    , leaf_rows_of_ghost(constraints.n_nodes() - constraints.n_owned_nodes())
    , position_of_column(matrices.size())
  {
    for (unsigned int i = 0; i < leaf_matrix.n_rows(); ++i)
      for (std::size_t e = leaf_matrix.row_begin(i); e < leaf_matrix.row_end(i);
           ++e)
        if (leaf_matrix.column(e) >= constraints.n_owned_nodes())
          leaf_rows_of_ghost[leaf_matrix.column(e) -
                             constraints.n_owned_nodes()]
            .push_back(i);

    unsigned int largest = 0;
    for (unsigned int k = 0; k < hierarchy.n_levels(); ++k)
      largest = std::max(largest, hierarchy.level(k).n_local_nodes());
    slot_of_finer_column.assign(largest, 0);

    for (unsigned int k = matrices.size(); k-- > 0;)
      {
        const auto        &level   = hierarchy.level(k);
        const unsigned int n_nodes = level.n_nodes();
        position_of_column[k].assign(level.n_local_nodes(),
                                     numbers::invalid_unsigned_int);
        matrices[k] = NodeBlockMatrix<dim>(level.couplings());
        prepare_exchange(k);
        for (const unsigned int row : level.outgoing_rows())
          compute_row(k, row);
        exchange_parts(k, level.outgoing_rows());

        inverses[k].resize(n_nodes);
        untruncated_traces[k].resize(n_nodes);
        if (k == 0)
          null_spaces.resize(n_nodes);
        for (unsigned int row = 0; row < n_nodes; ++row)
          {
            compute_row(k, row);
            untruncated_traces[k][row] = matrices[k].is_empty(row)
              ? 0.
              : trace<dim>(matrices[k].diagonal(row));
            compute_inverse(k, row);
          }
      }
  }



  template <int dim>
  void
  LevelMatrices<dim>::prepare_exchange(const unsigned int k)
  {
    const auto &level = hierarchy.level(k);
    if (level.numbering().distribution().n_processes() == 1)
      return;

    outgoing[k] = NodeBlockMatrix<dim>(level.outgoing_couplings());
    outgoing_row_of[k].assign(level.n_local_nodes() - level.n_nodes(),
                              numbers::invalid_unsigned_int);
    for (unsigned int r = 0; r < level.outgoing_rows().size(); ++r)
      outgoing_row_of[k][level.outgoing_rows()[r] - level.n_nodes()] = r;

    parts_of_row[k].resize(level.n_nodes());
    for (const auto &rows : level.incoming_rows())
      {
        auto &parts = incoming[k][rows.first];
        for (const auto &row : rows.second)
          {
            IncomingPart part;
            for (const unsigned int column : row.columns)
              part.positions.push_back(stores_half<dim> && column < row.row
                                         ? is_elsewhere
                                         : matrices[k].find(row.row, column));
            part.values.assign(part.positions.size() * dim * dim, 0.);
            parts.push_back(std::move(part));
          }
        for (unsigned int r = 0; r < parts.size(); ++r)
          parts_of_row[k][rows.second[r].row].push_back(&parts[r]);
      }
  }



  template <int dim>
  std::vector<unsigned int>
  LevelMatrices<dim>::exchange_parts(
    const unsigned int k, const std::vector<unsigned int> &changed_rows)
  {
    std::vector<unsigned int> received_rows;
    const auto               &level = hierarchy.level(k);
    const NodeDistribution   &nodes = level.numbering().distribution();
    if (nodes.n_processes() == 1)
      return received_rows;

    // To each process that owns some of our outgoing rows: which of these have
    // changed, counted among those that are its own, and their blocks.
    std::map<unsigned int, std::vector<double>> messages;
    std::map<unsigned int, unsigned int>        counts;
    std::vector<char> changed(outgoing[k].n_rows(), 0);
    for (const unsigned int row : changed_rows)
      changed[outgoing_row_of[k][row - level.n_nodes()]] = 1;
    for (unsigned int r = 0; r < outgoing[k].n_rows(); ++r)
      {
        const unsigned int owner =
          nodes.owner(level.numbering().global(level.outgoing_rows()[r]));
        auto              &message = messages[owner];
        const unsigned int n       = counts[owner]++;
        if (!changed[r])
          continue;
        message.push_back(n);
        const double *blocks = outgoing[k].block(r, outgoing[k].row_begin(r));
        message.insert(message.end(),
                       blocks,
                       blocks +
                         dim * dim *
                           (outgoing[k].row_end(r) - outgoing[k].row_begin(r)));
      }
    std::vector<MPI_Request> requests;
    for (const auto &message : messages)
      {
        count_message(nodes.communicator(),
                      message.second.size() * sizeof(double));
        requests.emplace_back();
        MPI_Isend(message.second.data(),
                  message.second.size(),
                  MPI_DOUBLE,
                  message.first,
                  tag,
                  nodes.communicator(),
                  &requests.back());
      }

    for (auto &parts : incoming[k])
      {
        MPI_Status         status;
        int                size;
        const WaitingScope waiting(nodes.communicator());
        MPI_Probe(parts.first, tag, nodes.communicator(), &status);
        MPI_Get_count(&status, MPI_DOUBLE, &size);
        std::vector<double> message(size);
        MPI_Recv(message.data(),
                 size,
                 MPI_DOUBLE,
                 parts.first,
                 tag,
                 nodes.communicator(),
                 MPI_STATUS_IGNORE);
        const auto &rows = level.incoming_rows().at(parts.first);
        for (auto entry = message.begin(); entry != message.end();)
          {
            const unsigned int   r    = static_cast<unsigned int>(*entry++);
            std::vector<double> &part = parts.second[r].values;
            std::copy_n(entry, part.size(), part.begin());
            entry += part.size();
            received_rows.push_back(rows[r].row);
          }
      }
    const WaitingScope waiting(nodes.communicator());
    MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
    return received_rows;
  }



  // The blocks that make up a row of level k: those of the leaf matrix that
  // belong to this level, and all those of the next finer level (of the leaf
  // matrix itself if that level is the finest, which has no matrix), weighted
  // with both parents' shares; P^T B first, summed up by columns of the finer
  // level, of which there are far fewer than blocks, then times P.
  template <int dim>
  void
  LevelMatrices<dim>::compute_row(const unsigned int k, const unsigned int row)
  {
    const auto                &level    = hierarchy.level(k);
    const bool                 is_owned = (row < level.n_nodes());
    NodeBlockMatrix<dim>      &B        = is_owned ? matrices[k] : outgoing[k];
    std::vector<unsigned int> &position = position_of_column[k];
    const unsigned int         row_of_B =
      is_owned ? row : outgoing_row_of[k][row - level.n_nodes()];
    const std::size_t begin = B.row_begin(row_of_B),
                      end   = B.stored_end(row_of_B);
    if (begin == end)
      return;
    double *const sums = B.block(row_of_B, begin);
    std::fill_n(sums, dim * dim * (end - begin), 0.);
    for (std::size_t e = begin; e < end; ++e)
      position[B.column(e)] = e - begin;
    // What is to the left of the diagonal is stored elsewhere. Blocks are
    // summed up row by row, as they are stored; truncated, they change places.
    const unsigned int first_column = stores_half<dim> && is_owned ? row : 0;
    const auto         add_to =
      [&](const unsigned int column, const double weight, const double *block) {
        if (column < first_column)
          return;
        double *target = sums + dim * dim * position[column];
        for (unsigned int d = 0; d < dim * dim; ++d)
          target[d] += weight * block[d];
      };

    if (const LeafNode leaf = level.leaf_node(row); leaf.exists())
      leaf_matrix.for_each_block(
        leaf.number(), [&](const unsigned int j, const double *block) {
          const unsigned int i = leaf.number();
          if (std::min(hierarchy.finest_level(leaf),
                       hierarchy.finest_level(LeafNode(j))) != k)
            return;
          const unsigned int column = hierarchy.node_of_leaf(k, LeafNode(j));
          if (truncation.is_identity(i) && truncation.is_identity(j))
            add_to(column, 1., block);
          else
            add_to(column, 1., truncation.linearized_block(j, block, i).data());
        });

    if (k + 1 < hierarchy.n_levels())
      {
        finer_columns.clear();
        finer_sums.clear();
        const auto add = [&](const double       weight,
                             const unsigned int finer_column,
                             const double      *block) {
          unsigned int &slot = slot_of_finer_column[finer_column];
          if (slot >= finer_columns.size() ||
              finer_columns[slot] != finer_column)
            {
              slot = finer_columns.size();
              finer_columns.push_back(finer_column);
              finer_sums.push_back(zero_block<dim>());
            }
          for (unsigned int d = 0; d < dim * dim; ++d)
            finer_sums[slot][d] += weight * block[d];
        };
        if (k + 2 < hierarchy.n_levels())
          for (auto child = level.children().begin(row);
               child != level.children().end(row);
               ++child)
            matrices[k + 1].for_each_block(
              child->node, [&](const unsigned int column, const double *block) {
                add(child->weight, column, block);
              });
        else
          for (auto child = level.leaf_children().begin(row);
               child != level.leaf_children().end(row);
               ++child)
            {
              const unsigned int i = child->node.number();
              leaf_matrix.for_each_block(
                i, [&](const unsigned int j, const double *block) {
                  if (hierarchy.finest_level(LeafNode(j)) != k + 1)
                    return;
                  const unsigned int column =
                    hierarchy.node_of_leaf(k + 1, LeafNode(j));
                  if (truncation.is_identity(i) && truncation.is_identity(j))
                    add(child->weight, column, block);
                  else
                    add(child->weight,
                        column,
                        truncation.linearized_block(j, block, i).data());
                });
            }

        const NodeWeights<unsigned int> &parents =
          hierarchy.level(k + 1).parents();
        for (unsigned int slot = 0; slot < finer_columns.size(); ++slot)
          for (auto p = parents.begin(finer_columns[slot]);
               p != parents.end(finer_columns[slot]);
               ++p)
            add_to(p->node, p->weight, finer_sums[slot].data());
      }

    // What others contribute, in the order of the processes.
    if (is_owned && !parts_of_row[k].empty())
      for (const IncomingPart *part : parts_of_row[k][row])
        for (unsigned int p = 0; p < part->positions.size(); ++p)
          {
            if (part->positions[p] == is_elsewhere)
              continue;
            double *target = B.block(row, part->positions[p]);
            for (unsigned int d = 0; d < dim * dim; ++d)
              target[d] += part->values[p * dim * dim + d];
          }
  }



  // Prescribed components and hanging nodes have nothing to solve for.
  template <int dim>
  NodeBlock<dim>
  LevelMatrices<dim>::free_diagonal(const unsigned int    k,
                                    const unsigned int    row,
                                    const NodeBlock<dim> &addition) const
  {
    const NodeBlockMatrix<dim> &B     = matrices[k];
    const auto                 &level = hierarchy.level(k);
    NodeBlock<dim>              block = zero_block<dim>();
    if (B.is_empty(row) || level.is_hanging(row))
      return block;

    const double *diagonal = B.diagonal(row);
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int r = 0; r < dim; ++r)
        if (!level.is_prescribed(row, c) && !level.is_prescribed(row, r))
          block[c * dim + r] = diagonal[c * dim + r] + addition[c * dim + r];
    return block;
  }



  template <int dim>
  NodeBlock<dim>
  LevelMatrices<dim>::majorized_diagonal(const unsigned int k,
                                         const unsigned int row) const
  {
    return free_diagonal(k, row, interface_majorant(matrices[k], row));
  }



  template <int dim>
  void
  LevelMatrices<dim>::compute_inverse(const unsigned int k,
                                      const unsigned int row)
  {
    const double cut = 1e-10 * untruncated_traces[k][row];
    inverses[k][row] = pseudo_inverse<dim>(
      free_diagonal(k, row, interface_damping(matrices[k], row)), cut);
    if (k == 0)
      pseudo_inverse<dim>(
        free_diagonal(k, row, zero_block<dim>()), cut, &null_spaces[row]);
  }



  template <int dim>
  std::size_t
  LevelMatrices<dim>::update(const Truncation<dim> &new_truncation)
  {
    // Which leaf nodes have changed, ghosts included, and which leaf rows that
    // touches.
    const std::vector<unsigned int> changed_nodes =
      truncation.differences(new_truncation);
    if (!true_on_any_process(!changed_nodes.empty(),
                             constraints.communicator()))
      return 0;
    std::vector<char> changes_subspace;
    for (const unsigned int node : changed_nodes)
      {
        changes_subspace.push_back(truncation.projector(node) !=
                                   new_truncation.projector(node));
        truncation.set(
          node, new_truncation.projector(node), new_truncation.curvature(node));
      }

    // Another subspace of node i changes the blocks of its row and of its
    // column, another second derivative the one of its diagonal only. Each
    // shows in the row that it is in, of the level that it belongs to; from
    // there in the rows of all parents.
    std::vector<std::vector<unsigned int>> rows(hierarchy.n_levels());
    const unsigned int n_owned = constraints.n_owned_nodes();
    const auto         mark = [&](const unsigned int i, const unsigned int j) {
      if (i >= n_owned)
        return;
      const unsigned int k = std::min(hierarchy.finest_level(LeafNode(i)),
                                      hierarchy.finest_level(LeafNode(j)));
      rows[k].push_back(hierarchy.node_of_leaf(k, LeafNode(i)));
    };
    for (unsigned int c = 0; c < changed_nodes.size(); ++c)
      if (const unsigned int i = changed_nodes[c]; !changes_subspace[c])
        {
          if (i < n_owned && !leaf_matrix.is_empty(i))
            mark(i, i);
        }
      else if (i < n_owned)
        for (std::size_t e = leaf_matrix.row_begin(i);
             e < leaf_matrix.row_end(i);
             ++e)
          {
            const unsigned int j = leaf_matrix.column(e);
            mark(i, j);
            mark(j, i);
          }
      else
        for (const unsigned int j : leaf_rows_of_ghost[i - n_owned])
          mark(j, i);

    std::size_t n_rows = 0;
    const auto  sort   = [](std::vector<unsigned int> &numbers) {
      std::sort(numbers.begin(), numbers.end());
      numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    };
    for (unsigned int k = hierarchy.n_levels(); k-- > 0;)
      {
        sort(rows[k]);
        if (k < matrices.size())
          {
            // Parts of others' rows first, then ours, with what others have
            // found out about them.
            const auto first_ghost = std::lower_bound(
              rows[k].begin(), rows[k].end(), hierarchy.level(k).n_nodes());
            const std::vector<unsigned int> outgoing_rows(first_ghost,
                                                          rows[k].end());
            rows[k].erase(first_ghost, rows[k].end());
            for (const unsigned int row : outgoing_rows)
              compute_row(k, row);
            const std::vector<unsigned int> received =
              exchange_parts(k, outgoing_rows);
            rows[k].insert(rows[k].end(), received.begin(), received.end());
            sort(rows[k]);
            for (const unsigned int row : rows[k])
              {
                compute_row(k, row);
                compute_inverse(k, row);
              }
            n_rows += rows[k].size() + outgoing_rows.size();
          }
        if (k > 0)
          for (const unsigned int row : rows[k])
            for (auto p = hierarchy.level(k).parents().begin(row);
                 p != hierarchy.level(k).parents().end(row);
                 ++p)
              rows[k - 1].push_back(p->node);
      }
    ++version;
    return n_rows;
  }



  template <int dim>
  std::size_t
  LevelMatrices<dim>::memory_consumption() const
  {
    std::size_t bytes = slot_of_finer_column.capacity() * sizeof(unsigned int);
    for (unsigned int k = 0; k < matrices.size(); ++k)
      bytes += matrices[k].memory_consumption() +
        outgoing[k].memory_consumption() +
        inverses[k].capacity() * sizeof(NodeBlock<dim>) +
        untruncated_traces[k].capacity() * sizeof(double) +
        position_of_column[k].capacity() * sizeof(unsigned int);
    return bytes;
  }



  template class LevelMatrices<2>;
  template class LevelMatrices<3>;
} // namespace Friction

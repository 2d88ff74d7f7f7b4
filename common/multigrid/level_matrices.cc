#include <common/multigrid/level_matrices.h>

#include <algorithm>
#include <initializer_list>

namespace Friction
{
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
    , position_of_column(matrices.size())
  {
    unsigned int largest = 0;
    for (unsigned int k = 0; k < hierarchy.n_levels(); ++k)
      largest = std::max(largest, hierarchy.level(k).n_nodes());
    slot_of_finer_column.assign(largest, 0);

    for (unsigned int k = matrices.size(); k-- > 0;)
      {
        const unsigned int n_nodes = hierarchy.level(k).n_nodes();
        position_of_column[k].assign(n_nodes, numbers::invalid_unsigned_int);
        make_pattern(k);

        inverses[k].resize(n_nodes);
        untruncated_traces[k].resize(n_nodes);
        if (k == 0)
          null_spaces.resize(n_nodes);
        for (unsigned int row = 0; row < n_nodes; ++row)
          {
            compute_row(k, row);
            untruncated_traces[k][row] =
              matrices[k].row_begin(row) == matrices[k].row_end(row)
              ? 0.
              : trace<dim>(matrices[k].block(matrices[k].row_begin(row)));
            compute_inverse(k, row);
          }
      }
  }



  // The blocks that make up a row of level k: those of the leaf matrix that
  // belong to this level, and all those of the next finer level (of the leaf
  // matrix itself if that level is the finest, which has no matrix).
  template <int dim>
  template <typename OwnBlock, typename FinerBlock>
  void
  LevelMatrices<dim>::for_each_contribution(const unsigned int k,
                                            const unsigned int row,
                                            const OwnBlock    &own_block,
                                            const FinerBlock &finer_block) const
  {
    const auto        &level = hierarchy.level(k);
    const unsigned int i     = level.leaf_node(row);
    if (!constraints.is_hanging(i) && hierarchy.finest_level(i) >= k)
      for (std::size_t e = leaf_matrix.row_begin(i); e < leaf_matrix.row_end(i);
           ++e)
        {
          const unsigned int j = leaf_matrix.column(e);
          if (std::min(hierarchy.finest_level(i), hierarchy.finest_level(j)) ==
              k)
            own_block(level.node_of_leaf(j), i, j, e);
        }

    // A mesh of one level only has nothing finer.
    if (k + 1 == hierarchy.n_levels())
      return;
    const auto &finer      = hierarchy.level(k + 1);
    const bool  finer_last = (k + 2 == hierarchy.n_levels());
    for (auto child = level.children().begin(row);
         child != level.children().end(row);
         ++child)
      if (!finer_last)
        {
          const NodeBlockMatrix<dim> &B = matrices[k + 1];
          for (std::size_t e = B.row_begin(child->node);
               e < B.row_end(child->node);
               ++e)
            finer_block(child->weight, B.column(e), B.block(e));
        }
      else
        {
          const unsigned int i = finer.leaf_node(child->node);
          if (constraints.is_hanging(i))
            continue;
          for (std::size_t e = leaf_matrix.row_begin(i);
               e < leaf_matrix.row_end(i);
               ++e)
            {
              const unsigned int j = leaf_matrix.column(e);
              if (hierarchy.finest_level(j) != k + 1)
                continue;
              const unsigned int column = finer.node_of_leaf(j);
              if (truncation.is_identity(i) && truncation.is_identity(j))
                finer_block(child->weight, column, leaf_matrix.block(e));
              else
                {
                  NodeBlock<dim> block =
                    truncation.sandwich(i, leaf_matrix.block(e), j);
                  if (i == j)
                    for (unsigned int d = 0; d < dim * dim; ++d)
                      block[d] += truncation.curvature(i)[d];
                  finer_block(child->weight, column, block.data());
                }
            }
        }
  }



  template <int dim>
  const NodeWeights &
  LevelMatrices<dim>::finer_parents(const unsigned int k) const
  {
    static const NodeWeights none;
    return k + 1 < hierarchy.n_levels() ? hierarchy.level(k + 1).parents()
                                        : none;
  }



  template <int dim>
  void
  LevelMatrices<dim>::make_pattern(const unsigned int k)
  {
    const unsigned int         n_nodes = hierarchy.level(k).n_nodes();
    const NodeWeights         &parents = finer_parents(k);
    std::vector<std::size_t>   starts  = {0};
    std::vector<unsigned int>  columns, row_columns;
    std::vector<unsigned int> &seen = position_of_column[k];
    for (unsigned int row = 0; row < n_nodes; ++row)
      {
        row_columns.clear();
        const auto add = [&](const unsigned int column) {
          if (seen[column] != row)
            {
              seen[column] = row;
              row_columns.push_back(column);
            }
        };
        for_each_contribution(
          k,
          row,
          [&](const unsigned int column,
              const unsigned int,
              const unsigned int,
              const std::size_t) { add(column); },
          [&](const double, const unsigned int finer_column, const double *) {
            for (auto p = parents.begin(finer_column);
                 p != parents.end(finer_column);
                 ++p)
              add(p->node);
          });
        std::sort(row_columns.begin(), row_columns.end());
        const auto diagonal =
          std::find(row_columns.begin(), row_columns.end(), row);
        if (diagonal != row_columns.end())
          std::rotate(row_columns.begin(), diagonal, diagonal + 1);
        columns.insert(columns.end(), row_columns.begin(), row_columns.end());
        starts.push_back(columns.size());
      }
    columns.shrink_to_fit();
    matrices[k] = NodeBlockMatrix<dim>(std::move(starts), std::move(columns));
  }



  template <int dim>
  void
  LevelMatrices<dim>::compute_row(const unsigned int k, const unsigned int row)
  {
    NodeBlockMatrix<dim>      &B        = matrices[k];
    std::vector<unsigned int> &position = position_of_column[k];
    const NodeWeights         &parents  = finer_parents(k);
    const std::size_t          begin = B.row_begin(row), end = B.row_end(row);
    for (std::size_t e = begin; e < end; ++e)
      {
        position[B.column(e)] = e - begin;
        std::fill_n(B.block(e), dim * dim, 0.);
      }

    // P^T B first, summed up by columns of the finer level, of which there are
    // far fewer than blocks; then times P.
    finer_columns.clear();
    finer_sums.clear();
    for_each_contribution(
      k,
      row,
      [&](const unsigned int column,
          const unsigned int i,
          const unsigned int j,
          const std::size_t  leaf_position) {
        double *target = B.block(begin + position[column]);
        if (truncation.is_identity(i) && truncation.is_identity(j))
          {
            const double *block = leaf_matrix.block(leaf_position);
            for (unsigned int d = 0; d < dim * dim; ++d)
              target[d] += block[d];
          }
        else
          {
            const NodeBlock<dim> block =
              truncation.sandwich(i, leaf_matrix.block(leaf_position), j);
            for (unsigned int d = 0; d < dim * dim; ++d)
              target[d] +=
                block[d] + (i == j ? truncation.curvature(i)[d] : 0.);
          }
      },
      [&](const double       weight,
          const unsigned int finer_column,
          const double      *block) {
        unsigned int &slot = slot_of_finer_column[finer_column];
        if (slot >= finer_columns.size() || finer_columns[slot] != finer_column)
          {
            slot = finer_columns.size();
            finer_columns.push_back(finer_column);
            finer_sums.push_back(zero_block<dim>());
          }
        for (unsigned int d = 0; d < dim * dim; ++d)
          finer_sums[slot][d] += weight * block[d];
      });
    for (unsigned int slot = 0; slot < finer_columns.size(); ++slot)
      for (auto p = parents.begin(finer_columns[slot]);
           p != parents.end(finer_columns[slot]);
           ++p)
        {
          double *target = B.block(begin + position[p->node]);
          for (unsigned int d = 0; d < dim * dim; ++d)
            target[d] += p->weight * finer_sums[slot][d];
        }
  }



  template <int dim>
  void
  LevelMatrices<dim>::compute_inverse(const unsigned int k,
                                      const unsigned int row)
  {
    const NodeBlockMatrix<dim> &B    = matrices[k];
    const unsigned int          leaf = hierarchy.level(k).leaf_node(row);

    NodeBlock<dim> block = zero_block<dim>();
    if (B.row_begin(row) != B.row_end(row))
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int r = 0; r < dim; ++r)
          if (!constraints.is_hanging(leaf) &&
              !constraints.is_prescribed(leaf, c) &&
              !constraints.is_prescribed(leaf, r))
            block[c * dim + r] = B.block(B.row_begin(row))[c * dim + r];

    const double cut = 1e-10 * untruncated_traces[k][row];
    inverses[k][row] =
      pseudo_inverse<dim>(block, cut, k == 0 ? &null_spaces[row] : nullptr);
  }



  template <int dim>
  std::size_t
  LevelMatrices<dim>::update(const Truncation<dim> &new_truncation)
  {
    // Which leaf nodes have changed, and which leaf rows that touches.
    std::vector<unsigned int> changed_nodes;
    for (const Truncation<dim> *special :
         std::initializer_list<const Truncation<dim> *>{&new_truncation,
                                                        &truncation})
      for (const unsigned int node : special->special_nodes())
        if (!truncation.agrees(new_truncation, node))
          changed_nodes.push_back(node);
    if (changed_nodes.empty())
      return 0;
    std::sort(changed_nodes.begin(), changed_nodes.end());
    changed_nodes.erase(std::unique(changed_nodes.begin(), changed_nodes.end()),
                        changed_nodes.end());
    for (const unsigned int node : changed_nodes)
      truncation.set(
        node, new_truncation.projector(node), new_truncation.curvature(node));

    // A change of the leaf block (i,j) shows in row i, and for j=i in the rows
    // of all neighbours of i, of the level that the block belongs to; from
    // there in the rows of all parents.
    std::vector<std::vector<unsigned int>> rows(hierarchy.n_levels());
    const auto mark = [&](const unsigned int i, const unsigned int j) {
      const unsigned int k =
        std::min(hierarchy.finest_level(i), hierarchy.finest_level(j));
      rows[k].push_back(hierarchy.level(k).node_of_leaf(i));
    };
    for (const unsigned int i : changed_nodes)
      for (std::size_t e = leaf_matrix.row_begin(i); e < leaf_matrix.row_end(i);
           ++e)
        {
          const unsigned int j = leaf_matrix.column(e);
          mark(i, j);
          mark(j, i);
        }

    std::size_t n_rows = 0;
    for (unsigned int k = hierarchy.n_levels(); k-- > 0;)
      {
        std::sort(rows[k].begin(), rows[k].end());
        rows[k].erase(std::unique(rows[k].begin(), rows[k].end()),
                      rows[k].end());
        if (k < matrices.size())
          {
            for (const unsigned int row : rows[k])
              {
                compute_row(k, row);
                compute_inverse(k, row);
              }
            n_rows += rows[k].size();
          }
        if (k > 0)
          for (const unsigned int row : rows[k])
            for (auto p = hierarchy.level(k).parents().begin(row);
                 p != hierarchy.level(k).parents().end(row);
                 ++p)
              rows[k - 1].push_back(p->node);
      }
    if (!rows[0].empty())
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
        inverses[k].capacity() * sizeof(NodeBlock<dim>) +
        untruncated_traces[k].capacity() * sizeof(double) +
        position_of_column[k].capacity() * sizeof(unsigned int);
    return bytes;
  }



  template class LevelMatrices<2>;
  template class LevelMatrices<3>;
} // namespace Friction

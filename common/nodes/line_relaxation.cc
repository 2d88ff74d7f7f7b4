#include <common/nodes/interface_damping.h>
#include <common/nodes/line_relaxation.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/types.h>

#include <algorithm>
#include <array>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = numbers::invalid_unsigned_int;

    // The two strongest couplings of a node that belongs to a line, in parts of
    // its diagonal.
    constexpr double anisotropy = .8;

    constexpr unsigned int shortest_line = 3;

    // One node in so many has to be in a line, or there are none. To see that
    // there are none it is enough to look at every seventh node.
    constexpr unsigned int fewest = 50, sample = 7;

    // The strong partners of a node, at most two; the others are none.
    using Partners = std::array<unsigned int, 2>;

    template <int dim>
    Partners
    strong_partners(const NodeBlockMatrix<dim> &A,
                    const unsigned int          row,
                    const std::vector<char>    &is_relaxed)
    {
      double   strengths[2] = {};
      Partners partners{{none, none}};
      for (std::size_t k = A.row_begin(row) + 1; k < A.row_end(row); ++k)
        {
          double       strength = -trace<dim>(A.block(k));
          unsigned int column   = A.column(k);
          for (unsigned int i = 0; i < 2; ++i)
            if (strength > strengths[i])
              {
                std::swap(strength, strengths[i]);
                std::swap(column, partners[i]);
              }
        }
      const double diagonal = trace<dim>(A.block(A.row_begin(row)));
      if (strengths[0] + strengths[1] < anisotropy * diagonal || diagonal <= 0.)
        return Partners{{none, none}};
      for (unsigned int &partner : partners)
        if (partner != none && (partner >= A.n_rows() || !is_relaxed[partner]))
          partner = none;
      return partners;
    }



    // See interface_damping(). The matrix of a line has eigenvalues that are
    // much smaller than those of its diagonal blocks, so that nothing of these
    // can be set off against the couplings to other processes: the damping is
    // half of the majorant.
    template <int dim>
    NodeBlock<dim>
    damping_of(const NodeBlockMatrix<dim> &A,
               const unsigned int          row,
               const bool                  is_alone)
    {
      if (is_alone)
        return interface_damping(A, row);
      NodeBlock<dim> damping = interface_majorant(A, row);
      for (double &entry : damping)
        entry *= .5;
      return damping;
    }
  } // namespace



  template <int dim>
  LineRelaxation<dim>::LineRelaxation(const NodeBlockMatrix<dim> &A,
                                      const NodeRanges           &relaxed_nodes,
                                      const MPI_Comm              communicator)
    : A(&A)
  {
    std::vector<char> is_relaxed(A.n_rows());
    for (const RowRange &range : relaxed_nodes)
      std::fill(is_relaxed.begin() + range.first,
                is_relaxed.begin() + range.second,
                true);

    types::global_dof_index n_sampled = 0, n_stretched = 0;
    for (const RowRange &range : relaxed_nodes)
      for (unsigned int i = range.first; i < range.second; ++i)
        if (i % sample == 0)
          {
            ++n_sampled;
            const Partners partners = strong_partners(A, i, is_relaxed);
            n_stretched += partners[0] != none || partners[1] != none;
          }
    starts = {0};
    if (fewest * Utilities::MPI::sum(n_stretched, communicator) <=
        Utilities::MPI::sum(n_sampled, communicator))
      return;
    find_lines(is_relaxed, communicator);
    if (!worthwhile)
      {
        starts = {0};
        nodes  = {};
        return;
      }
    for (const unsigned int i : nodes)
      cuts.push_back(1e-10 * trace<dim>(A.block(A.row_begin(i))));
    inverse_pivots.resize(nodes.size());
    couplings.resize(nodes.size());
  }



  template <int dim>
  void
  LineRelaxation<dim>::find_lines(const std::vector<char> &is_relaxed,
                                  const MPI_Comm           communicator)
  {
    const unsigned int    n = A->n_rows();
    std::vector<Partners> partners(n, Partners{{none, none}});
    for (unsigned int i = 0; i < n; ++i)
      if (is_relaxed[i])
        partners[i] = strong_partners(*A, i, is_relaxed);
    // Whoever is asked, the answer is the same: so decide first and change
    // afterwards.
    std::vector<Partners> mutual = partners;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int &j : mutual[i])
        if (j != none && partners[j][0] != i && partners[j][1] != i)
          j = none;

    // A line by its first and last index in a list of nodes. First those that
    // have ends, from the end with the lower number; then rings, cut at their
    // lowest node.
    std::vector<char>         is_taken(n);
    std::vector<unsigned int> found;
    std::vector<RowRange>     ranges;
    const auto                walk = [&](const unsigned int first) {
      const unsigned int begin = found.size();
      for (unsigned int i = first, next = none; i != none; i = next)
        {
          is_taken[i] = true;
          found.push_back(i);
          next = none;
          for (const unsigned int j : mutual[i])
            if (j != none && !is_taken[j])
              next = j;
        }
      ranges.emplace_back(begin, found.size());
    };
    for (const bool with_ends : {true, false})
      for (unsigned int i = 0; i < n; ++i)
        if (is_relaxed[i] && !is_taken[i] &&
            (!with_ends || mutual[i][0] == none || mutual[i][1] == none))
          walk(i);

    // By their first nodes, so that a sweep goes through the matrix in order;
    // what is too short falls to pieces.
    types::global_dof_index n_in_lines = 0, n_relaxed = found.size();
    std::vector<RowRange>   pieces;
    for (const RowRange &range : ranges)
      if (range.second - range.first >= shortest_line)
        {
          n_in_lines += range.second - range.first;
          pieces.push_back(range);
        }
      else
        for (unsigned int k = range.first; k < range.second; ++k)
          pieces.emplace_back(k, k + 1);
    std::sort(pieces.begin(), pieces.end(), [&](const auto &a, const auto &b) {
      return found[a.first] < found[b.first];
    });
    for (const RowRange &piece : pieces)
      {
        nodes.insert(nodes.end(),
                     found.begin() + piece.first,
                     found.begin() + piece.second);
        starts.push_back(nodes.size());
      }
    worthwhile = fewest * Utilities::MPI::sum(n_in_lines, communicator) >
      Utilities::MPI::sum(n_relaxed, communicator);
  }



  template <int dim>
  std::vector<std::vector<unsigned int>>
  LineRelaxation<dim>::lines() const
  {
    std::vector<std::vector<unsigned int>> result;
    for (unsigned int l = 0; l + 1 < starts.size(); ++l)
      if (starts[l + 1] > starts[l] + 1)
        result.emplace_back(nodes.begin() + starts[l],
                            nodes.begin() + starts[l + 1]);
    return result;
  }



  template <int dim>
  void
  LineRelaxation<dim>::factorise(const Truncation<dim> *the_truncation)
  {
    truncation       = the_truncation;
    const auto block = [&](const unsigned int i, const std::size_t position) {
      NodeBlock<dim> result;
      std::copy_n(A->block(position), dim * dim, result.begin());
      if (truncation == nullptr)
        return result;
      return truncation->truncated_block(i, result.data(), A->column(position));
    };

    for (unsigned int l = 0; l + 1 < starts.size(); ++l)
      for (unsigned int k = starts[l]; k < starts[l + 1]; ++k)
        {
          const bool           is_alone = starts[l] + 1 == starts[l + 1];
          const unsigned int   i        = nodes[k];
          NodeBlock<dim>       pivot    = block(i, A->row_begin(i));
          const NodeBlock<dim> damping  = damping_of(*A, i, is_alone);
          for (unsigned int e = 0; e < dim * dim; ++e)
            pivot[e] += damping[e];
          if (truncation != nullptr && !truncation->is_identity(i))
            {
              if (damping != zero_block<dim>())
                pivot = truncation->truncated_block(i, pivot.data(), i);
              for (unsigned int e = 0; e < dim * dim; ++e)
                pivot[e] += truncation->curvature(i)[e];
            }
          if (k > starts[l])
            {
              const std::size_t position = A->find(i, nodes[k - 1]);
              couplings[k]               = block(i, position);
              NodeBlock<dim> transposed;
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int r = 0; r < dim; ++r)
                  transposed[r * dim + c] = couplings[k][c * dim + r];
              const NodeBlock<dim> taken = times<dim>(
                couplings[k], times<dim>(inverse_pivots[k - 1], transposed));
              for (unsigned int e = 0; e < dim * dim; ++e)
                pivot[e] -= taken[e];
            }
          inverse_pivots[k] = pseudo_inverse<dim>(pivot, cuts[k]);
        }
  }



  template <int dim>
  NodeValue<dim>
  LineRelaxation<dim>::residual_of(const unsigned int node,
                                   const double      *b,
                                   const double      *x) const
  {
    NodeValue<dim> r = A->row_times(node, x);
    for (unsigned int d = 0; d < dim; ++d)
      r[d] = b[dim * node + d] - r[d];
    if (truncation != nullptr && !truncation->is_identity(node))
      {
        const NodeValue<dim> curved =
          times<dim>(truncation->curvature(node).data(), x + dim * node);
        for (unsigned int d = 0; d < dim; ++d)
          r[d] -= curved[d];
        r = times<dim>(truncation->projector(node).data(), r.data());
      }
    return r;
  }



  template <int dim>
  void
  LineRelaxation<dim>::relax_line(const unsigned int line,
                                  const double      *b,
                                  double            *x) const
  {
    const unsigned int begin = starts[line], end = starts[line + 1];
    values.resize(end - begin);
    for (unsigned int k = begin; k < end; ++k)
      {
        NodeValue<dim> &y = values[k - begin];
        y                 = residual_of(nodes[k], b, x);
        if (k > begin)
          {
            const NodeValue<dim> taken =
              times<dim>(couplings[k].data(),
                         times<dim>(inverse_pivots[k - 1].data(),
                                    values[k - 1 - begin].data())
                           .data());
            for (unsigned int d = 0; d < dim; ++d)
              y[d] -= taken[d];
          }
      }
    for (unsigned int k = end; k-- > begin;)
      {
        NodeValue<dim> &y = values[k - begin];
        if (k + 1 < end)
          {
            const NodeBlock<dim> &C    = couplings[k + 1];
            const NodeValue<dim> &next = values[k + 1 - begin];
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int r = 0; r < dim; ++r)
                y[c] -= C[c * dim + r] * next[r];
          }
        y = times<dim>(inverse_pivots[k].data(), y.data());
        for (unsigned int d = 0; d < dim; ++d)
          x[dim * nodes[k] + d] += y[d];
      }
  }



  template <int dim>
  void
  LineRelaxation<dim>::run(const Sweeps  &sweeps,
                           const double  *b,
                           double        *x,
                           GhostExchange &ghosts,
                           double        *residual) const
  {
    const unsigned int n = starts.size() - 1;
    for (unsigned int s = 0; s < sweeps.number; ++s)
      {
        for (unsigned int l = 0; l < n; ++l)
          relax_line(sweeps.backwards ? n - 1 - l : l, b, x);
        ghosts.update(x, dim);
      }
    if (residual != nullptr)
      for (unsigned int i = 0; i < A->n_rows(); ++i)
        {
          const NodeValue<dim> r = residual_of(i, b, x);
          std::copy(r.begin(), r.end(), residual + dim * i);
        }
  }



  template <int dim>
  std::size_t
  LineRelaxation<dim>::memory_consumption() const
  {
    return (starts.capacity() + nodes.capacity()) * sizeof(unsigned int) +
      cuts.capacity() * sizeof(double) +
      (inverse_pivots.capacity() + couplings.capacity()) *
      sizeof(NodeBlock<dim>);
  }



  template class LineRelaxation<2>;
  template class LineRelaxation<3>;
} // namespace Friction

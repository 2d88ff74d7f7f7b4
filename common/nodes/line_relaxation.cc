#include <common/nodes/interface_damping.h>
#include <common/nodes/line_relaxation.h>
#include <common/nodes/relaxed_together.h>

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
    // its diagonal. In squares they are a quarter of it, in cells that are
    // twice as long as wide seven tenths, and with these relaxation of single
    // nodes takes twice as many cycles already.
    constexpr double anisotropy = .65;

    constexpr unsigned int shortest_line = 3;

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
          double       strength = -A.trace_of(row, k);
          unsigned int column   = A.column(k);
          for (unsigned int i = 0; i < 2; ++i)
            if (strength > strengths[i])
              {
                std::swap(strength, strengths[i]);
                std::swap(column, partners[i]);
              }
        }
      const double diagonal = trace<dim>(A.diagonal(row));
      if (strengths[0] + strengths[1] < anisotropy * diagonal || diagonal <= 0.)
        return Partners{{none, none}};
      for (unsigned int &partner : partners)
        if (partner != none && (partner >= A.n_rows() || !is_relaxed[partner]))
          partner = none;
      return partners;
    }



    // Whether a line that has got the nodes before `last` and `last` itself
    // stays block tridiagonal with one more: the node must couple to none of
    // them but the last.
    template <int dim>
    bool
    may_follow(const NodeBlockMatrix<dim>      &A,
               const unsigned int               node,
               const unsigned int               last,
               const std::vector<unsigned int> &line_of_node,
               const unsigned int               line)
    {
      for (std::size_t k = A.row_begin(node) + 1; k < A.row_end(node); ++k)
        {
          const unsigned int other = A.column(k);
          if (other < A.n_rows() && other != last &&
              line_of_node[other] == line)
            return false;
        }
      return true;
    }
  } // namespace



  template <int dim>
  LineRelaxation<dim>::LineRelaxation(const NodeBlockMatrix<dim> &A,
                                      const NodeRanges           &relaxed_nodes,
                                      const IsHeld               &is_held,
                                      const MPI_Comm              communicator)
    : A(&A)
  {
    const std::vector<char> is_relaxed =
      RelaxedTogether::flags(A.n_rows(), relaxed_nodes);
    const auto has_partners = [&](const unsigned int i) {
      const Partners partners = strong_partners(A, i, is_relaxed);
      return partners[0] != none || partners[1] != none;
    };
    if (!RelaxedTogether::are_there(
          A.n_rows(), relaxed_nodes, has_partners, communicator))
      return;

    find_lines(is_relaxed);
    share = RelaxedTogether::share_of(nodes.size(), is_relaxed, communicator);
    if (!has_lines())
      {
        starts = {0};
        nodes  = {};
        return;
      }
    for (const unsigned int i : nodes)
      {
        cuts.push_back(1e-10 * trace<dim>(A.diagonal(i)));
        unsigned char components = 0;
        for (unsigned int c = 0; c < dim; ++c)
          if (!is_held(i, c))
            components |= 1u << c;
        free_components.push_back(components);
      }
    inverse_pivots.resize(nodes.size());
    couplings.resize(nodes.size());
  }



  template <int dim>
  void
  LineRelaxation<dim>::find_lines(const std::vector<char> &is_relaxed)
  {
    const unsigned int    n = A->n_rows();
    std::vector<Partners> partners(n, Partners{{none, none}});
    for (unsigned int i = 0; i < n; ++i)
      if (is_relaxed[i])
        partners[i] = strong_partners(*A, i, is_relaxed);
    // In whatever order nodes are asked, the answer is the same: so decide
    // first and change afterwards.
    std::vector<Partners> mutual = partners;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int &j : mutual[i])
        if (j != none && partners[j][0] != i && partners[j][1] != i)
          j = none;

    // First the chains that have ends, from the end with the lower number; then
    // rings, from their lowest node.
    std::vector<unsigned int> line_of_node(n, none), found;
    std::vector<RowRange>     ranges;
    const auto                walk = [&](const unsigned int first) {
      unsigned int begin = found.size(), last = none;
      for (unsigned int i = first, next = none; i != none; i = next)
        {
          if (last != none &&
              !may_follow(*A, i, last, line_of_node, ranges.size()))
            {
              ranges.emplace_back(begin, found.size());
              begin = found.size();
            }
          line_of_node[i] = ranges.size();
          found.push_back(i);
          last = i;
          next = none;
          for (const unsigned int j : mutual[i])
            if (j != none && line_of_node[j] == none)
              next = j;
        }
      ranges.emplace_back(begin, found.size());
    };
    for (const bool with_ends : {true, false})
      for (unsigned int i = 0; i < n; ++i)
        if (is_relaxed[i] && line_of_node[i] == none &&
            (!with_ends || mutual[i][0] == none || mutual[i][1] == none))
          walk(i);

    // By their first nodes, so that a sweep goes through the matrix in order.
    std::sort(ranges.begin(), ranges.end(), [&](const auto &a, const auto &b) {
      return found[a.first] < found[b.first];
    });
    for (const RowRange &range : ranges)
      if (range.second - range.first >= shortest_line)
        {
          nodes.insert(nodes.end(),
                       found.begin() + range.first,
                       found.begin() + range.second);
          starts.push_back(nodes.size());
        }
  }



  template <int dim>
  std::vector<std::vector<unsigned int>>
  LineRelaxation<dim>::lines() const
  {
    std::vector<std::vector<unsigned int>> result;
    for (unsigned int l = 0; l + 1 < starts.size(); ++l)
      result.emplace_back(nodes.begin() + starts[l],
                          nodes.begin() + starts[l + 1]);
    return result;
  }



  template <int dim>
  NodeRanges
  LineRelaxation<dim>::other_nodes(const NodeRanges &all) const
  {
    if (!has_lines())
      return all;
    std::vector<char> is_in_line(A->n_rows());
    for (const unsigned int i : nodes)
      is_in_line[i] = true;
    return RelaxedTogether::others(all, is_in_line);
  }



  template <int dim>
  void
  LineRelaxation<dim>::factorise(const Truncation<dim> *the_truncation)
  {
    truncation       = the_truncation;
    const auto block = [&](const unsigned int i, const std::size_t position) {
      const NodeBlock<dim> result = A->value(i, position);
      if (truncation == nullptr)
        return result;
      return truncation->truncated_block(i, result.data(), A->column(position));
    };

    for (unsigned int l = 0; l + 1 < starts.size(); ++l)
      for (unsigned int k = starts[l]; k < starts[l + 1]; ++k)
        {
          const unsigned int i     = nodes[k];
          NodeBlock<dim>     pivot = block(i, A->row_begin(i));
          // See interface_damping(). The matrix of a line has eigenvalues that
          // are much smaller than those of its diagonal blocks, so that nothing
          // of these can be set off against the couplings to other processes:
          // the damping is half of the majorant.
          const NodeBlock<dim> majorant  = interface_majorant(*A, i);
          const bool           is_damped = majorant != zero_block<dim>();
          for (unsigned int e = 0; e < dim * dim; ++e)
            pivot[e] += .5 * majorant[e];
          if (truncation != nullptr && !truncation->is_identity(i))
            {
              if (is_damped)
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
          // What is held has no row in the inverse, and so no change, neither
          // its own nor one that it would cause.
          const auto is_free = [&](const unsigned int c) {
            return (free_components[k] >> c) & 1;
          };
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int r = 0; r < dim; ++r)
              if (!is_free(c) || !is_free(r))
                pivot[c * dim + r] = 0.;
          inverse_pivots[k] = pseudo_inverse<dim>(pivot, cuts[k]);
        }
    is_factorised = true;
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
        y = RelaxedTogether::residual<dim>(*A, truncation, nodes[k], b, x);
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
  LineRelaxation<dim>::run(const unsigned int n_sweeps,
                           const double      *b,
                           double            *x,
                           GhostExchange     &ghosts,
                           double            *residual) const
  {
    Assert(is_factorised || !has_lines(), ExcInvalidState());
    const unsigned int n = starts.size() - 1;
    for (unsigned int s = 0; s < n_sweeps; ++s)
      {
        for (unsigned int l = 0; l < n; ++l)
          relax_line(l, b, x);
        ghosts.update(x, dim);
      }
    if (residual != nullptr)
      RelaxedTogether::residuals<dim>(*A, truncation, b, x, residual);
  }



  template <int dim>
  std::size_t
  LineRelaxation<dim>::memory_consumption() const
  {
    return (starts.capacity() + nodes.capacity()) * sizeof(unsigned int) +
      free_components.capacity() + cuts.capacity() * sizeof(double) +
      (inverse_pivots.capacity() + couplings.capacity()) *
      sizeof(NodeBlock<dim>);
  }



  template class LineRelaxation<2>;
  template class LineRelaxation<3>;
} // namespace Friction

#ifndef friction_nodes_relaxed_together_h
#define friction_nodes_relaxed_together_h

#include <common/nodes/node_block_matrix.h>
#include <common/nodes/truncation.h>
#include <common/parallel/reductions.h>

#include <mpi.h>

#include <algorithm>
#include <array>
#include <vector>

namespace Friction
{
  /**
   * What relaxation of several nodes at once, in lines or in planes, has to ask
   * of a matrix and of its nodes.
   */
  namespace RelaxedTogether
  {
    /** The share of nodes that has to be relaxed together, or none are. */
    constexpr double fewest = .02;

    /** For each row of a matrix whether it is among @p nodes. */
    inline std::vector<char>
    flags(const unsigned int n_rows, const NodeRanges &nodes)
    {
      std::vector<char> is_among(n_rows);
      for (const RowRange &range : nodes)
        for (unsigned int i = range.first; i < range.second; ++i)
          is_among[i] = true;
      return is_among;
    }

    /** Those of @p all that are not among @p some. */
    inline NodeRanges
    others(const NodeRanges &all, const std::vector<char> &some)
    {
      NodeRanges result;
      for (const RowRange &range : all)
        for (unsigned int i = range.first; i < range.second; ++i)
          if (!some[i])
            append(result, i);
      return result;
    }

    /**
     * Whether more than the least share of @p nodes is stretched, which where
     * there are many is seen from every seventh: where cells are not stretched,
     * this is all that is paid. Collective.
     */
    template <typename IsStretched>
    bool
    are_there(const unsigned int n_rows,
              const NodeRanges  &nodes,
              const IsStretched &is_stretched,
              const MPI_Comm     communicator)
    {
      constexpr unsigned int sample = 7, many = 10000;
      const unsigned int     step = n_rows > many ? sample : 1;
      // Each stands for as many as its process passes over.
      std::array<double, 2> sampled = {{0, 0}};
      for (const RowRange &range : nodes)
        for (unsigned int i = range.first; i < range.second; ++i)
          if (i % step == 0)
            {
              sampled[0] += step;
              if (is_stretched(i))
                sampled[1] += step;
            }
      sampled = sum_over_processes(sampled, communicator);
      return sampled[1] > fewest * sampled[0];
    }

    /** The share of nodes that have been found, over all processes, of those
     * that are to be relaxed; nothing if it is too small. Collective. */
    inline double
    share_of(const std::size_t        n_found,
             const std::vector<char> &is_relaxed,
             const MPI_Comm           communicator)
    {
      const double n_relaxed =
        std::count(is_relaxed.begin(), is_relaxed.end(), true);
      const std::array<double, 2> sums = sum_over_processes(
        std::array<double, 2>{{n_relaxed, double(n_found)}}, communicator);
      return sums[1] <= fewest * sums[0] ? 0. : sums[1] / sums[0];
    }

    /** What becomes of a row of the residual $b-Ax$ with a truncation. */
    template <int dim>
    NodeValue<dim>
    truncated(const Truncation<dim> &truncation,
              const unsigned int     node,
              const double          *r,
              const double          *x)
    {
      const NodeValue<dim> curved =
        times<dim>(truncation.curvature(node).data(), x + dim * node);
      NodeValue<dim> rest;
      for (unsigned int d = 0; d < dim; ++d)
        rest[d] = r[d] - curved[d];
      return times<dim>(truncation.projector(node).data(), rest.data());
    }

    /**
     * The residual $T(b-(A+\omega'')x)$ of a row, with truncated b; without a
     * truncation $b-Ax$.
     */
    template <int dim>
    NodeValue<dim>
    residual(const NodeBlockMatrix<dim> &A,
             const Truncation<dim>      *truncation,
             const unsigned int          node,
             const double               *b,
             const double               *x)
    {
      NodeValue<dim> r = A.row_times(node, x);
      for (unsigned int d = 0; d < dim; ++d)
        r[d] = b[dim * node + d] - r[d];
      if (truncation != nullptr && !truncation->is_identity(node))
        r = truncated(*truncation, node, r.data(), x);
      return r;
    }

    /** The same of all rows. */
    template <int dim>
    void
    residuals(const NodeBlockMatrix<dim> &A,
              const Truncation<dim>      *truncation,
              const double               *b,
              const double               *x,
              double                     *result)
    {
      A.residual(result, b, x);
      if (truncation != nullptr)
        for (unsigned int i = 0; i < A.n_rows(); ++i)
          if (!truncation->is_identity(i))
            {
              const NodeValue<dim> r =
                truncated(*truncation, i, result + dim * i, x);
              std::copy(r.begin(), r.end(), result + dim * i);
            }
    }
  } // namespace RelaxedTogether
} // namespace Friction

#endif

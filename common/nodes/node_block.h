#ifndef friction_nodes_node_block_h
#define friction_nodes_node_block_h

#include <deal.II/base/config.h>

#include <array>
#include <cmath>

namespace Friction
{
  /**
   * The values of a vector-valued function at one node.
   */
  template <int dim>
  using NodeValue = std::array<double, dim>;

  /**
   * The coupling of two nodes: a dense dim x dim matrix, column by column.
   * (Inside of a NodeBlockMatrix they are stored row by row.)
   */
  template <int dim>
  using NodeBlock = std::array<double, dim * dim>;

  /** The zero block. */
  template <int dim>
  constexpr NodeBlock<dim>
  zero_block()
  {
    return NodeBlock<dim>{};
  }

  /** The identity block. */
  template <int dim>
  NodeBlock<dim>
  identity_block()
  {
    NodeBlock<dim> block{};
    for (int d = 0; d < dim; ++d)
      block[d * dim + d] = 1.;
    return block;
  }

  /** The product A x. In the loops over nodes a call would cost more than the
   * product. */
  template <int dim>
  inline DEAL_II_ALWAYS_INLINE NodeValue<dim>
                               times(const double *A, const double *x)
  {
    NodeValue<dim> y{};
    for (int c = 0; c < dim; ++c)
      for (int r = 0; r < dim; ++r)
        y[r] += A[c * dim + r] * x[c];
    return y;
  }

  /** The product A B. */
  template <int dim>
  NodeBlock<dim>
  times(const NodeBlock<dim> &A, const NodeBlock<dim> &B)
  {
    NodeBlock<dim> C{};
    for (int c = 0; c < dim; ++c)
      for (int k = 0; k < dim; ++k)
        for (int r = 0; r < dim; ++r)
          C[c * dim + r] += A[k * dim + r] * B[c * dim + k];
    return C;
  }

  /** The rank-one block a b^T. */
  template <int dim>
  NodeBlock<dim>
  outer(const NodeValue<dim> &a, const NodeValue<dim> &b)
  {
    NodeBlock<dim> C;
    for (int c = 0; c < dim; ++c)
      for (int r = 0; r < dim; ++r)
        C[c * dim + r] = a[r] * b[c];
    return C;
  }

  template <int dim>
  double
  dot(const double *a, const double *b)
  {
    double sum = 0;
    for (int d = 0; d < dim; ++d)
      sum += a[d] * b[d];
    return sum;
  }

  template <int dim>
  double
  trace(const double *A)
  {
    double sum = 0;
    for (int d = 0; d < dim; ++d)
      sum += A[d * dim + d];
    return sum;
  }

  /**
   * The pseudo-inverse of a symmetric positive semidefinite block: eigenvalues
   * not above @p cut count as zero. If @p null_space is given, it receives the
   * orthogonal projector onto the discarded directions.
   *
   * Truncated coarse functions may vanish in one direction at a node and live
   * on in the other; skipping the whole node because one entry is zero would
   * lose that other direction.
   */
  template <int dim>
  NodeBlock<dim> pseudo_inverse(const NodeBlock<dim> &A,
                                const double          cut,
                                NodeBlock<dim>       *null_space = nullptr);
} // namespace Friction

#endif

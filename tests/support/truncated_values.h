#ifndef friction_tests_support_truncated_values_h
#define friction_tests_support_truncated_values_h

// For tests of what is relaxed within a truncation T.

#include <common/discretization/discretization.h>
#include <common/nodes/truncation.h>

#include <tests/support/random.h>

namespace Tests
{
  /** Nodes that do not hang and can move in some direction. */
  template <int dim>
  Friction::NodeRanges
  movable_nodes(const Friction::Discretization<dim> &d)
  {
    Friction::NodeRanges nodes;
    for (unsigned int i = 0; i < d.constraints().n_owned_nodes(); ++i)
      if (!d.constraints().is_fixed(i))
        append(nodes, i);
    return nodes;
  }



  /** T x for random x at these nodes. */
  template <int dim>
  Friction::VectorType
  random_truncated(const Friction::Discretization<dim> &d,
                   const Friction::Truncation<dim>     &truncation,
                   Random                              &random)
  {
    Friction::VectorType v = d.vector();
    for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
      v.local_element(i) =
        d.constraints().is_fixed(i / dim) ? 0. : random(-1., 1.);
    truncation.apply(v.begin());
    return v;
  }



  /** T (A + w) x, with T x = x. */
  template <int dim>
  Friction::VectorType
  truncated_product(const Friction::Discretization<dim> &d,
                    const Friction::Truncation<dim>     &truncation,
                    const Friction::VectorType          &x)
  {
    Friction::VectorType y = d.vector();
    d.stiffness().vmult(y, x);
    for (unsigned int i = 0; i < d.constraints().n_owned_nodes(); ++i)
      {
        const Friction::NodeValue<dim> more = Friction::times<dim>(
          truncation.curvature(i).data(), x.begin() + dim * i);
        for (unsigned int c = 0; c < dim; ++c)
          y.local_element(dim * i + c) += more[c];
      }
    truncation.apply(y.begin());
    return y;
  }
} // namespace Tests

#endif

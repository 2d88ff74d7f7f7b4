#include <common/nodes/truncation.h>

#include <algorithm>

#include <cmath>

namespace Friction
{
  template <int dim>
  Truncation<dim>::Truncation(const NodalConstraints<dim> &constraints)
    : n_owned(constraints.n_owned_nodes())
    , slot(constraints.n_nodes(), identity_slot)
    , projectors{identity_block<dim>(), zero_block<dim>()}
    , curvatures{zero_block<dim>(), zero_block<dim>()}
  {
    for (unsigned int node = 0; node < constraints.n_nodes(); ++node)
      if (constraints.is_fixed(node))
        slot[node] = zero_slot;
      else if (!constraints.is_free(node))
        {
          NodeBlock<dim> projector = identity_block<dim>();
          for (unsigned int d = 0; d < dim; ++d)
            if (constraints.is_prescribed(node, d))
              projector[d * dim + d] = 0.;
          set(node, projector, zero_block<dim>());
        }
    held_by_constraints = n_held_components();
  }



  template <int dim>
  void
  Truncation<dim>::set(const unsigned int    node,
                       const NodeBlock<dim> &projector,
                       const NodeBlock<dim> &curvature)
  {
    if (slot[node] <= zero_slot)
      {
        slot[node] = projectors.size();
        projectors.emplace_back();
        curvatures.emplace_back();
        specials.push_back(node);
      }
    projectors[slot[node]] = projector;
    curvatures[slot[node]] = curvature;
  }



  template <int dim>
  void
  Truncation<dim>::apply(double *v) const
  {
    for (unsigned int i = 0; i < n_owned; ++i)
      if (slot[i] != identity_slot)
        {
          const NodeValue<dim> value =
            times<dim>(projectors[slot[i]].data(), v + dim * i);
          for (unsigned int d = 0; d < dim; ++d)
            v[dim * i + d] = value[d];
        }
  }



  template <int dim>
  NodeBlock<dim>
  Truncation<dim>::truncated_block(const unsigned int i,
                                   const double      *block,
                                   const unsigned int j) const
  {
    NodeBlock<dim> result;
    for (unsigned int e = 0; e < dim * dim; ++e)
      result[e] = block[e];
    if (slot[i] != identity_slot)
      result = times<dim>(projectors[slot[i]], result);
    if (slot[j] != identity_slot)
      result = times<dim>(result, projectors[slot[j]]);
    return result;
  }



  template <int dim>
  NodeBlock<dim>
  Truncation<dim>::linearized_block(const unsigned int i,
                                    const double      *block,
                                    const unsigned int j) const
  {
    NodeBlock<dim> result = truncated_block(i, block, j);
    if (i == j)
      for (unsigned int d = 0; d < dim * dim; ++d)
        result[d] += curvature(i)[d];
    return result;
  }



  template <int dim>
  std::vector<unsigned int>
  Truncation<dim>::differences(const Truncation &other) const
  {
    std::vector<unsigned int> nodes;
    for (const std::vector<unsigned int> *some : {&specials, &other.specials})
      for (const unsigned int node : *some)
        if (!agrees(other, node))
          nodes.push_back(node);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }



  template <int dim>
  bool
  Truncation<dim>::agrees(const Truncation  &other,
                          const unsigned int node) const
  {
    return projectors[slot[node]] == other.projectors[other.slot[node]] &&
      curvatures[slot[node]] == other.curvatures[other.slot[node]];
  }



  template <int dim>
  unsigned int
  Truncation<dim>::n_held_components() const
  {
    unsigned int sum = 0;
    for (const unsigned int node : specials)
      if (node < n_owned)
        sum += dim - std::lround(trace<dim>(projectors[slot[node]].data()));
    return sum;
  }



  template <int dim>
  unsigned int
  Truncation<dim>::n_truncated_components() const
  {
    return n_held_components() - held_by_constraints;
  }



  template class Truncation<2>;
  template class Truncation<3>;
} // namespace Friction

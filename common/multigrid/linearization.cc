#include <common/multigrid/linearization.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Friction
{
  template <int dim>
  Linearization<dim>::Linearization(const NodalConstraints<dim> &constraints,
                                    const ContactBoundary<dim>  &contact,
                                    const double friction_coefficient,
                                    const TruncationVariant variant)
    : contact(contact)
    , friction_coefficient(friction_coefficient)
    , variant(variant)
    , current(constraints)
  {
    static_assert(dim == 2,
                  "In three dimensions the second derivative of friction has "
                  "to be added here.");
  }



  template <int dim>
  void
  Linearization<dim>::update(const VectorType &, const ContactState &state)
  {
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const ContactNode<dim> &node = contact[p];
        const bool              all_is_held =
          state.in_contact(p) && variant == TruncationVariant::contact;

        NodeBlock<dim> projector = zero_block<dim>();
        const auto     add       = [&](const Tensor<1, dim> &direction) {
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int r = 0; r < dim; ++r)
              projector[c * dim + r] += direction[r] * direction[c];
        };
        if (!state.in_contact(p))
          add(node.normal());
        if (!state.sticks(p) && !all_is_held)
          for (unsigned int t = 1; t <= node.n_free_tangents; ++t)
            add(node.frame[t]);

        // Everything free must be the identity to the last bit, so that the
        // block is the leaf matrix's own.
        if (!state.in_contact(p) && !state.sticks(p) &&
            node.n_free_tangents == dim - 1)
          projector = identity_block<dim>();
        current.set(node.node, projector, zero_block<dim>());
      }
  }



  template <int dim>
  void
  Linearization<dim>::linearize_residual(VectorType         &r,
                                         const VectorType   &u,
                                         const ContactState &state) const
  {
    if (state.has_friction())
      for (unsigned int p = 0; p < contact.size(); ++p)
        if (state.normal_force(p) > 0 && !state.sticks(p))
          {
            const ContactNode<dim> &node = contact[p];
            const auto              u_T  = tangential_components<dim>(node, u);
            double                  norm = 0;
            for (const double component : u_T)
              norm += component * component;
            norm = std::sqrt(norm);
            if (norm > 0)
              for (unsigned int t = 1; t < dim; ++t)
                for (unsigned int d = 0; d < dim; ++d)
                  r.local_element(dim * node.node + d) -= friction_coefficient *
                    state.normal_force(p) * u_T[t - 1] / norm *
                    node.frame[t][d];
          }
    current.apply(r.begin());
  }



  template <int dim>
  void
  Linearization<dim>::bounds(VectorType         &lower,
                             VectorType         &upper,
                             const VectorType   &u,
                             const ContactState &state) const
  {
    const double infinity = std::numeric_limits<double>::infinity();
    lower                 = -infinity;
    upper                 = infinity;
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const ContactNode<dim> &node = contact[p];

        // a.v <= b, with b >= 0 up to rounding.
        const auto add = [&](const Tensor<1, dim> &a, const double b) {
          double one_norm = 0;
          for (unsigned int d = 0; d < dim; ++d)
            one_norm += std::abs(a[d]);
          const double side = std::max(0., b) / one_norm;
          for (unsigned int d = 0; d < dim; ++d)
            {
              double &lo = lower.local_element(dim * node.node + d);
              double &up = upper.local_element(dim * node.node + d);
              if (a[d] > 0)
                up = std::min(up, side);
              else if (a[d] < 0)
                lo = std::max(lo, -side);
            }
        };

        if (!state.in_contact(p))
          add(node.normal(), node.gap - normal_component(node, u));
        if (friction_coefficient * state.normal_force(p) > 0 &&
            !state.sticks(p))
          {
            // Each tangential component keeps its sign.
            const auto u_T = tangential_components<dim>(node, u);
            for (unsigned int t = 1; t < dim; ++t)
              add((u_T[t - 1] > 0 ? -1. : 1.) * node.frame[t],
                  std::abs(u_T[t - 1]));
          }
      }
  }



  template class Linearization<2>;
} // namespace Friction

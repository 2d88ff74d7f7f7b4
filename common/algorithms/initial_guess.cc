#include <common/algorithms/initial_guess.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  template <int dim>
  VectorType
  contact_tractions(const VectorType            &residual,
                    const NodalConstraints<dim> &constraints,
                    const ContactBoundary<dim>  &contact,
                    const ContactState          &state)
  {
    VectorType tractions(constraints.partitioner());
    for (unsigned int p = 0; p < contact.size(); ++p)
      if (state.in_contact(p) || state.normal_force(p) > 0)
        {
          const Tensor<1, dim> force = contact_force(contact[p], residual);
          for (unsigned int d = 0; d < dim; ++d)
            tractions.local_element(dim * contact[p].node + d) =
              force[d] / contact[p].measure;
        }
    return tractions;
  }



  double
  lift_above_rounding(VectorType &v)
  {
    const double largest = v.linfty_norm();
    const double lift =
      largest > 0 ? std::exp2(std::ceil(std::log2(largest)) + 1.) : 0.;
    v.add(lift);
    v.update_ghost_values();
    return lift;
  }



  template <int dim>
  ContactState
  make_initial_guess(VectorType                  &u,
                     const VectorType            &tractions,
                     const NodalConstraints<dim> &constraints,
                     const ContactBoundary<dim>  &contact,
                     const bool                   with_friction)
  {
    constraints.impose(u);
    ContactState state(contact.size(), with_friction);
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const ContactNode<dim> &node   = contact[p];
        const double            excess = normal_component(node, u) - node.gap;
        if (excess > 0)
          for (unsigned int d = 0; d < dim; ++d)
            u.local_element(dim * node.node + d) -= excess * node.normal()[d];
        state.set_normal_force(
          p, node.measure * std::max(0., -normal_component(node, tractions)));
        state.set(p, excess >= 0, false);
      }
    return state;
  }



  template VectorType contact_tractions(const VectorType &,
                                        const NodalConstraints<2> &,
                                        const ContactBoundary<2> &,
                                        const ContactState &);
  template VectorType contact_tractions(const VectorType &,
                                        const NodalConstraints<3> &,
                                        const ContactBoundary<3> &,
                                        const ContactState &);

  template ContactState make_initial_guess(VectorType &,
                                           const VectorType &,
                                           const NodalConstraints<2> &,
                                           const ContactBoundary<2> &,
                                           const bool);
  template ContactState make_initial_guess(VectorType &,
                                           const VectorType &,
                                           const NodalConstraints<3> &,
                                           const ContactBoundary<3> &,
                                           const bool);
} // namespace Friction

#include <common/contact/contact_forces.h>

#include <algorithm>

namespace Friction
{
  template <int dim>
  Tensor<1, dim>
  contact_force(const ContactNode<dim> &p, const VectorType &residual)
  {
    Tensor<1, dim> force;
    for (unsigned int e = 0; e <= p.n_free_tangents; ++e)
      for (unsigned int d = 0; d < dim; ++d)
        force -=
          p.frame[e][d] * residual.local_element(dim * p.node + d) * p.frame[e];
    return force;
  }



  template <int dim>
  void
  set_normal_forces(const ContactBoundary<dim> &contact,
                    const VectorType           &residual,
                    ContactState               &state)
  {
    for (unsigned int p = 0; p < contact.size(); ++p)
      if (!contact[p].bound_is_given)
        state.set_normal_force(
          p,
          state.in_contact(p)
            ? std::max(0., normal_component(contact[p], residual))
            : 0.);
  }



  template <int dim>
  VectorType
  contact_tractions(const ContactBoundary<dim> &contact,
                    const VectorType           &residual,
                    const ContactState         &state)
  {
    VectorType tractions(residual.get_partitioner());
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



  template Tensor<1, 2> contact_force(const ContactNode<2> &,
                                      const VectorType &);
  template Tensor<1, 3> contact_force(const ContactNode<3> &,
                                      const VectorType &);

  template void set_normal_forces(const ContactBoundary<2> &,
                                  const VectorType &,
                                  ContactState &);
  template void set_normal_forces(const ContactBoundary<3> &,
                                  const VectorType &,
                                  ContactState &);

  template VectorType contact_tractions(const ContactBoundary<2> &,
                                        const VectorType &,
                                        const ContactState &);
  template VectorType contact_tractions(const ContactBoundary<3> &,
                                        const VectorType &,
                                        const ContactState &);
} // namespace Friction

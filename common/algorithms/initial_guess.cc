#include <common/algorithms/initial_guess.h>
#include <common/parallel/collective_error.h>

#include <algorithm>

namespace Friction
{
  template <int dim>
  ContactState
  make_initial_guess(const Discretization<dim> &discretization,
                     VectorType                &u,
                     const VectorType          &tractions)
  {
    const ContactBoundary<dim> &contact = discretization.contact();
    const Scene<dim>           &scene   = discretization.scene();
    ContactState state(contact.size(), discretization.problem().has_friction());
    discretization.constraints().impose(u);
    on_all_processes(discretization.constraints().communicator(), [&]() {
      for (unsigned int p = 0; p < contact.size(); ++p)
        {
          const ContactNode<dim> &node   = contact[p];
          const double            excess = move_out_of_obstacle(node, u);
          const auto             &given =
            scene.contact_conditions()[node.condition].friction_bound;
          const double stress = given != nullptr
            ? given->value(node.point)
            : std::max(0., -normal_component(node, tractions));
          state.set_normal_force(p, node.measure * stress);
          state.set(p, excess >= 0, false);
        }
    });
    return state;
  }



  template ContactState make_initial_guess(const Discretization<2> &,
                                           VectorType &,
                                           const VectorType &);
  template ContactState make_initial_guess(const Discretization<3> &,
                                           VectorType &,
                                           const VectorType &);
} // namespace Friction

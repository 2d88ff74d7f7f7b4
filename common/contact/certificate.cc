#include <common/contact/certificate.h>
#include <common/contact/peak_pressure.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

namespace Friction
{
  namespace
  {
    // The larger of the two, where nothing is larger than NaN: a result that is
    // not a number must never look like a small one.
    void
    raise(double &largest, const double value)
    {
      if (!std::isnan(largest) && !(value <= largest))
        largest = value;
    }



    struct Entry
    {
      const char *name;
      double Certificate::*value;
    };

    constexpr std::array<Entry, 7> entries = {
      {{"equilibrium", &Certificate::equilibrium},
       {"penetration", &Certificate::penetration},
       {"tension", &Certificate::tension},
       {"complementarity", &Certificate::complementarity},
       {"friction cone", &Certificate::cone},
       {"slip direction", &Certificate::slip},
       {"state of a node", &Certificate::state}}};



    // The force that takes a node this far if all others stay where they are:
    // a^T A_pp a / |a|.
    template <int dim>
    double
    force_for(const DiscreteProblem<dim> &problem,
              const unsigned int          node,
              const Tensor<1, dim>       &displacement)
    {
      const double length = displacement.norm();
      if (length == 0)
        return 0.;
      NodeValue<dim> a;
      for (unsigned int d = 0; d < dim; ++d)
        a[d] = displacement[d] / length;
      const NodeValue<dim> Aa =
        times<dim>(problem.stiffness.diagonal_block(node), a.data());
      return length * dot<dim>(a.data(), Aa.data());
    }



    // The vector with these components along the first tangents of a contact
    // node.
    template <int dim>
    Tensor<1, dim>
    along_tangents(const ContactNode<dim>            &node,
                   const std::array<double, dim - 1> &components,
                   const unsigned int                 n_tangents = dim - 1)
    {
      Tensor<1, dim> sum;
      for (unsigned int t = 0; t < n_tangents; ++t)
        sum += components[t] * node.frame[t + 1];
      return sum;
    }
  } // namespace



  double
  Certificate::largest() const
  {
    double largest = 0;
    for (const Entry &entry : entries)
      raise(largest, this->*entry.value);
    return largest;
  }



  std::string
  Certificate::describe() const
  {
    std::ostringstream text;
    text.precision(2);
    text << std::scientific;
    for (const Entry &entry : entries)
      text << (&entry == entries.begin() ? "" : ", ") << entry.name << ' '
           << this->*entry.value;
    return text.str();
  }



  template <int dim>
  Certificate
  make_certificate(const DiscreteProblem<dim> &problem,
                   const VectorType           &u,
                   const VectorType           &residual,
                   const ContactState         &state)
  {
    const NodalConstraints<dim> &constraints = problem.constraints;
    const ContactBoundary<dim>  &contact     = problem.contact;
    const PeakPressure<dim>      unit(problem, u, residual, state);
    std::vector<char> is_contact_node(constraints.n_owned_nodes(), 0);
    for (const ContactNode<dim> &node : contact)
      is_contact_node[node.node] = 1;

    Certificate result;
    for (unsigned int node = 0; node < constraints.n_owned_nodes(); ++node)
      if (!constraints.is_hanging(node) && !is_contact_node[node])
        {
          double force = 0;
          for (unsigned int d = 0; d < dim; ++d)
            if (!constraints.is_prescribed(node, d))
              raise(force, std::abs(residual.local_element(dim * node + d)));
          // Few nodes come that far.
          if (!(unit.relative_force(force, node, problem.face_measures[node]) <=
                result.equilibrium))
            raise(result.equilibrium, unit.relative_force_inside(force, node));
        }

    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const ContactNode<dim> &node     = contact[p];
        const auto              relative = [&](const double force) {
          return unit.relative_force(force, node.node, node.measure);
        };
        const auto relative_of_zone = [&](const double force) {
          const double share =
            node.measure / std::max(node.measure, unit.contact_measure());
          return relative(force) * std::pow(share, 1. / (dim - 1));
        };

        // The force on the body at the node, R = A u - f, is minus the
        // residual. A distance counts as the force that would close it.
        const double pressing = normal_component(node, residual);
        const double room     = node.gap - normal_component(node, u);
        const double distance =
          force_for<dim>(problem, node.node, room * node.normal());
        if (!(room >= 0))
          raise(result.penetration, relative_of_zone(distance));
        raise(result.tension, relative(-pressing));
        raise(result.complementarity,
              room <= 0 ? 0. : relative(std::min(pressing, distance)));

        // A prescribed component takes part in the slip; the force in its
        // direction is a reaction, of which friction is but a part.
        const bool   coulomb = problem.has_coulomb_friction(node);
        const double tau =
          coulomb ? std::max(0., pressing) : state.normal_force(p);
        const double bound = problem.effective_coefficient(node) * tau;
        const auto   r_T =
          along_tangents<dim>(node,
                              tangential_components<dim>(node, residual),
                              node.n_free_tangents);
        const auto   components = slip_components<dim>(node, u);
        const auto   u_T        = along_tangents<dim>(node, components);
        const double slip       = force_for<dim>(problem, node.node, u_T);
        const auto   slips_by =
          along_tangents<dim>(node, components, node.n_free_tangents) /
          (slip == 0 ? 1. : u_T.norm());
        raise(result.cone, relative(r_T.norm() - bound));

        // Where it slides the force opposes the slip with full strength. Like
        // complementarity this is a choice of two, so that rounding in the
        // displacement of a sticking node is no violation.
        raise(result.slip,
              slip == 0
                ? 0.
                : relative(std::min((r_T - bound * slips_by).norm(), slip)));

        // The state of the node has made these choices.
        const bool touches = state.in_contact(p);
        raise(result.state,
              touches ? relative_of_zone(distance)
                      : relative(std::abs(pressing)));
        if (!problem.has_friction() || node.n_free_tangents == 0 ||
            (coulomb && !touches))
          continue;
        const double missing =
          bound * (slip == 0 ? 1. : slips_by.norm()) - r_T.norm();
        raise(result.state,
              state.sticks(p) ? relative_of_zone(slip) : relative(missing));
      }

    // The largest on any process. What is not a number must not get lost.
    const MPI_Comm comm = constraints.communicator();
    if (Utilities::MPI::n_mpi_processes(comm) > 1)
      {
        std::array<double, entries.size()> all;
        for (unsigned int i = 0; i < all.size(); ++i)
          all[i] = std::isnan(result.*entries[i].value)
            ? std::numeric_limits<double>::infinity()
            : result.*entries[i].value;
        all = max_over_processes(all, comm);
        for (unsigned int i = 0; i < all.size(); ++i)
          result.*entries[i].value = all[i];
      }
    return result;
  }



  template Certificate make_certificate(const DiscreteProblem<2> &,
                                        const VectorType &,
                                        const VectorType &,
                                        const ContactState &);
  template Certificate make_certificate(const DiscreteProblem<3> &,
                                        const VectorType &,
                                        const VectorType &,
                                        const ContactState &);
} // namespace Friction

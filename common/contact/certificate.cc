#include <common/contact/certificate.h>
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



    std::array<std::pair<const char *, double>, 6>
    entries(const Certificate &c)
    {
      return {{{"equilibrium", c.equilibrium},
               {"penetration", c.penetration},
               {"tension", c.tension},
               {"complementarity", c.complementarity},
               {"friction cone", c.cone},
               {"slip direction", c.slip}}};
    }
  } // namespace



  double
  Certificate::largest() const
  {
    double largest = 0;
    for (const auto &entry : entries(*this))
      raise(largest, entry.second);
    return largest;
  }



  std::string
  Certificate::describe() const
  {
    std::ostringstream text;
    text.precision(2);
    text << std::scientific;
    for (const auto &entry : entries(*this))
      text << (entry.first == entries(*this)[0].first ? "" : ", ")
           << entry.first << ' ' << entry.second;
    return text.str();
  }



  template <int dim>
  double
  force_of_rounding(const DiscreteProblem<dim> &problem, const VectorType &u)
  {
    const NodeBlockMatrix<dim> &A       = problem.stiffness.blocks();
    double                      largest = 0;
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      if (A.row_begin(i) < A.row_end(i))
        largest = std::max(
          largest,
          trace<dim>(A.block(A.row_begin(i))) *
            std::sqrt(dot<dim>(u.begin() + dim * i, u.begin() + dim * i)));
    return 1e-8 * max_over_processes(largest, problem.communicator());
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
    std::vector<char>            is_contact_node(constraints.n_owned_nodes(), 0);
    double force_scale = force_of_rounding(problem, u), length_scale = 0;
    for (const ContactNode<dim> &node : contact)
      is_contact_node[node.node] = 1;

    Certificate result;
    for (unsigned int node = 0; node < constraints.n_owned_nodes(); ++node)
      if (!constraints.is_hanging(node))
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double r = std::abs(residual.local_element(dim * node + d));
            force_scale    = std::max(force_scale, r);
            if (!is_contact_node[node] && !constraints.is_prescribed(node, d))
              raise(result.equilibrium, r);
          }
    for (const ContactNode<dim> &node : contact)
      for (unsigned int d = 0; d < dim; ++d)
        length_scale =
          std::max({length_scale,
                    std::abs(u.local_element(dim * node.node + d)),
                    std::abs(normal_component(node, u) - node.gap)});
    const MPI_Comm comm   = constraints.communicator();
    const auto     scales = max_over_processes(
      std::array<double, 2>{{force_scale, length_scale}}, comm);
    force_scale  = scales[0];
    length_scale = scales[1];
    // Without any force or displacement there is nothing to compare with.
    if (force_scale == 0)
      force_scale = 1.;
    if (length_scale == 0)
      length_scale = 1.;
    result.equilibrium /= force_scale;

    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const ContactNode<dim> &node = contact[p];
        const double pressing = normal_component(node, residual) / force_scale;
        const double room =
          (node.gap - normal_component(node, u)) / length_scale;
        raise(result.penetration, -room);
        raise(result.tension, -pressing);
        raise(result.complementarity, std::min(pressing, room));

        // The force on the body at the node, R = A u - f, is minus the
        // residual.
        const double tau   = problem.has_coulomb_friction()
            ? std::max(0., pressing)
            : state.normal_force(p) / force_scale;
        const double bound = problem.effective_coefficient(node) * tau;
        const auto   r_T   = tangential_components<dim>(node, residual);
        const auto   u_T   = tangential_components<dim>(node, u);
        double       norm = 0, slip_norm = 0;
        for (unsigned int t = 0; t < node.n_free_tangents; ++t)
          norm += r_T[t] * r_T[t];
        // A prescribed component takes part in the slip; the force in its
        // direction is a reaction, of which friction is but a part.
        for (const double component : u_T)
          slip_norm += component * component;
        norm      = std::sqrt(norm) / force_scale;
        slip_norm = std::sqrt(slip_norm);
        raise(result.cone, norm - bound);

        // Where it slides the force opposes the slip with full strength. Like
        // complementarity this is a choice of two, so that rounding in the
        // displacement of a sticking node is no violation.
        double deviation = 0;
        for (unsigned int t = 0; t < node.n_free_tangents; ++t)
          if (slip_norm > 0)
            deviation +=
              std::pow(r_T[t] / force_scale - bound * u_T[t] / slip_norm, 2);
        raise(result.slip,
              std::min(std::sqrt(deviation), slip_norm / length_scale));
      }

    // The largest on any process. What is not a number must not get lost.
    if (Utilities::MPI::n_mpi_processes(comm) > 1)
      {
        const std::array<double *, 6> values = {{&result.equilibrium,
                                                 &result.penetration,
                                                 &result.tension,
                                                 &result.complementarity,
                                                 &result.cone,
                                                 &result.slip}};
        std::array<double, 6>         all;
        for (unsigned int i = 0; i < values.size(); ++i)
          all[i] = std::isnan(*values[i])
            ? std::numeric_limits<double>::infinity()
            : *values[i];
        all = max_over_processes(all, comm);
        for (unsigned int i = 0; i < values.size(); ++i)
          *values[i] = all[i];
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

  template double force_of_rounding(const DiscreteProblem<2> &,
                                    const VectorType &);
  template double force_of_rounding(const DiscreteProblem<3> &,
                                    const VectorType &);
} // namespace Friction

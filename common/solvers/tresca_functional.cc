#include <common/solvers/tresca_functional.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace Friction
{
  namespace
  {
    // What rounding may do to gap and displacements at a contact node.
    template <int dim>
    double
    rounding_at(const ContactNode<dim> &node,
                const VectorType       &u,
                const VectorType       &v)
    {
      double size = std::abs(node.gap);
      for (unsigned int d = 0; d < dim; ++d)
        size += std::abs(u.local_element(dim * node.node + d)) +
          std::abs(v.local_element(dim * node.node + d));
      return 2e-15 * size;
    }
  } // namespace



  template <int dim>
  TrescaFunctional<dim>::TrescaFunctional(const DiscreteProblem<dim> &problem)
    : problem(problem)
  {}



  template <int dim>
  double
  TrescaFunctional<dim>::energy(const VectorType   &u,
                                const ContactState &state) const
  {
    VectorType r(u);
    problem.matrix.residual(r.begin(), problem.forces.begin(), u.begin());
    return energy(u, r, state);
  }



  // u.Au/2 - f.u = -u.(r+f)/2. Values of u at hanging nodes meet zero rows.
  template <int dim>
  double
  TrescaFunctional<dim>::energy(const VectorType   &u,
                                const VectorType   &r,
                                const ContactState &state) const
  {
    double sum = 0;
    for (unsigned int node = 0; node < problem.constraints.n_owned_nodes();
         ++node)
      if (!problem.constraints.is_hanging(node))
        for (unsigned int i = dim * node; i < dim * (node + 1); ++i)
          sum -= .5 * u.local_element(i) *
            (r.local_element(i) + problem.forces.local_element(i));
    if (state.has_friction())
      for (unsigned int p = 0; p < problem.contact.size(); ++p)
        {
          double square = 0;
          for (const double component :
               tangential_components<dim>(problem.contact[p], u))
            square += component * component;
          sum += problem.friction_coefficient * state.normal_force(p) *
            std::sqrt(square);
        }
    return sum;
  }



  template <int dim>
  double
  TrescaFunctional<dim>::largest_penetration(const VectorType &u) const
  {
    double largest = -std::numeric_limits<double>::infinity();
    for (const ContactNode<dim> &node : problem.contact)
      largest = std::max(largest, normal_component(node, u) - node.gap);
    return largest;
  }



  template <int dim>
  unsigned int
  TrescaFunctional<dim>::project(VectorType &v, const VectorType &u) const
  {
    unsigned int n_projected = 0;
    for (const ContactNode<dim> &node : problem.contact)
      {
        // A node that is in contact already has no normal correction but
        // rounding, which is no reason to project.
        const double v_n = normal_component(node, v);
        if (v_n <= 0)
          continue;
        const double room = std::max(0., node.gap - normal_component(node, u));
        if (v_n > room)
          {
            for (unsigned int d = 0; d < dim; ++d)
              v.local_element(dim * node.node + d) -=
                (v_n - room) * node.normal()[d];
            if (v_n - room > rounding_at(node, u, v))
              ++n_projected;
          }
      }
    return n_projected;
  }



  template <int dim>
  unsigned int
  TrescaFunctional<dim>::keep_slip(VectorType         &v,
                                   const VectorType   &u,
                                   const ContactState &state) const
  {
    unsigned int n_changed = 0;
    if (state.has_friction())
      for (unsigned int p = 0; p < problem.contact.size(); ++p)
        if (state.normal_force(p) > 0 && !state.sticks(p))
          {
            const ContactNode<dim> &node = problem.contact[p];
            const auto              a    = tangential_components<dim>(node, u);
            const auto              b    = tangential_components<dim>(node, v);
            double                  uu = 0, uv = 0;
            // What is prescribed does not change, but takes part in the slip.
            double free = 0;
            for (unsigned int t = 0; t < dim - 1; ++t)
              {
                uu += a[t] * a[t];
                if (t < node.n_free_tangents)
                  {
                    uv += a[t] * b[t];
                    free += a[t] * a[t];
                  }
              }
            if (uu + uv >= 0 || free == 0)
              continue;
            ++n_changed;
            for (unsigned int t = 1; t <= node.n_free_tangents; ++t)
              for (unsigned int d = 0; d < dim; ++d)
                v.local_element(dim * node.node + d) -=
                  (uu + uv) / free * a[t - 1] * node.frame[t][d];
          }
    return n_changed;
  }



  template <int dim>
  double
  TrescaFunctional<dim>::minimize_along(const VectorType   &v,
                                        const VectorType   &u,
                                        const ContactState &state,
                                        const double        slope,
                                        const double        curvature,
                                        const double        largest) const
  {
    // Per node with friction: bound, and the coefficients of
    // |u_T + alpha v_T|^2.
    struct Term
    {
      double bound, uu, uv, vv;
    };
    std::vector<Term> terms;
    if (state.has_friction())
      for (unsigned int p = 0; p < problem.contact.size(); ++p)
        if (state.normal_force(p) > 0)
          {
            const auto a    = tangential_components<dim>(problem.contact[p], u);
            const auto b    = tangential_components<dim>(problem.contact[p], v);
            Term       term = {
                    problem.friction_coefficient * state.normal_force(p), 0, 0, 0};
            for (unsigned int t = 0; t < dim - 1; ++t)
              {
                term.uu += a[t] * a[t];
                term.uv += a[t] * b[t];
                term.vv += b[t] * b[t];
              }
            if (term.vv > 0)
              terms.push_back(term);
          }

    // The derivative from the right; it never decreases.
    const auto derivative = [&](const double alpha) {
      double value = alpha * curvature - slope;
      for (const Term &t : terms)
        {
          const double inner  = t.uv + alpha * t.vv;
          const double square = t.uu + alpha * (t.uv + inner);
          // At rest the node starts to move along v.
          value += t.bound *
            (square > 1e-30 * (t.uu + t.vv) ? inner / std::sqrt(square)
                                            : std::sqrt(t.vv));
        }
      return value;
    };

    if (!(derivative(0.) < 0.))
      return 0.;
    if (terms.empty())
      return std::min(largest, slope / curvature);
    if (derivative(largest) <= 0.)
      return largest;

    // Regula falsi with bisection as a safeguard. Without a kink in between the
    // derivative is close to linear, and one or two steps suffice.
    double low = 0., high = largest;
    double d_low = derivative(low), d_high = derivative(high);
    for (unsigned int i = 0; i < 100 && high - low > 1e-12 * high; ++i)
      {
        double trial = low - d_low * (high - low) / (d_high - d_low);
        if (i % 3 == 2 || !(trial > low && trial < high))
          trial = .5 * (low + high);
        const double d = derivative(trial);
        if (d <= 0)
          {
            low   = trial;
            d_low = d;
          }
        else
          {
            high   = trial;
            d_high = d;
          }
        if (std::abs(d) <= 1e-13 * std::abs(slope))
          return trial;
      }
    return low;
  }



  template <int dim>
  double
  TrescaFunctional<dim>::admissible_length(const VectorType &v,
                                           const VectorType &u,
                                           const double      largest) const
  {
    double length = largest;
    for (const ContactNode<dim> &node : problem.contact)
      {
        // A correction that has been projected uses up its room to the last
        // digit, and at a node in contact both are nothing but rounding of the
        // numbers involved; neither must cut the step.
        const double rounding = rounding_at(node, u, v);
        const double v_n      = normal_component(node, v);
        const double room = std::max(0., node.gap - normal_component(node, u));
        if (v_n > rounding && v_n * length > room + rounding)
          length = (room + rounding) / v_n;
      }
    return length;
  }



  template class TrescaFunctional<2>;
  template class TrescaFunctional<3>;
} // namespace Friction

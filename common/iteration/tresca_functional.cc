#include <common/iteration/tresca_functional.h>
#include <common/parallel/owned_values.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <array>
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



    // By how many times its slip in u a sliding node would go too far back with
    // v, or zero. What is prescribed does not change, but takes part in the
    // slip.
    template <int dim>
    double
    excess_of_reversal(const ContactNode<dim> &node,
                       const VectorType       &v,
                       const VectorType       &u)
    {
      const auto a  = slip_components<dim>(node, u);
      const auto b  = tangential_components<dim>(node, v);
      double     uu = 0, uv = 0, free = 0;
      for (unsigned int t = 0; t < dim - 1; ++t)
        {
          uu += a[t] * a[t];
          if (t < node.n_free_tangents)
            {
              uv += a[t] * b[t];
              free += a[t] * a[t];
            }
        }
      return (uu + uv >= 0 || free == 0) ? 0. : -(uu + uv) / free;
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
    problem.stiffness.residual(r, problem.forces, u);
    return energy(u, r, state);
  }



  template <int dim>
  double
  TrescaFunctional<dim>::energy(const VectorType   &u,
                                const VectorType   &r,
                                const ContactState &state) const
  {
    return sum_over_processes(energy_share(u, r, state),
                              problem.communicator());
  }



  // u.Au/2 - f.u = -u.(r+f)/2. Values of u at hanging nodes meet zero rows.
  template <int dim>
  double
  TrescaFunctional<dim>::energy_share(const VectorType   &u,
                                      const VectorType   &r,
                                      const ContactState &state) const
  {
    // Rows of hanging nodes are empty.
    const double *displacement = u.begin(), *residual = r.begin(),
                 *force = problem.forces.begin();
    double sum =
      -.5 * sum_of_terms(u.locally_owned_size(), [=](const unsigned int i) {
        return displacement[i] * (residual[i] + force[i]);
      });
    if (state.has_friction())
      for (unsigned int p = 0; p < problem.contact.size(); ++p)
        {
          double square = 0;
          for (const double component :
               slip_components<dim>(problem.contact[p], u))
            square += component * component;
          sum += problem.effective_coefficient(problem.contact[p]) *
            state.normal_force(p) * std::sqrt(square);
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
    return max_over_processes(largest, problem.communicator());
  }



  template <int dim>
  unsigned int
  TrescaFunctional<dim>::project(VectorType       &v,
                                 const VectorType &u,
                                 const double      length) const
  {
    unsigned int n_projected = 0;
    for (const ContactNode<dim> &node : problem.contact)
      {
        // A node that is in contact already has no normal correction but
        // rounding, which is no reason to project.
        const double v_n = length * normal_component(node, v);
        if (v_n <= 0)
          continue;
        const double room = std::max(0., node.gap - normal_component(node, u));
        if (v_n > room)
          {
            for (unsigned int d = 0; d < dim; ++d)
              v.local_element(dim * node.node + d) -=
                (v_n - room) / length * node.normal()[d];
            if (v_n - room > rounding_at(node, u, v))
              ++n_projected;
          }
      }
    return n_projected;
  }



  template <int dim>
  std::vector<unsigned int>
  TrescaFunctional<dim>::reversing_nodes(const VectorType   &v,
                                         const VectorType   &u,
                                         const ContactState &state) const
  {
    std::vector<unsigned int> nodes;
    if (state.has_friction())
      for (unsigned int p = 0; p < problem.contact.size(); ++p)
        if (problem.effective_coefficient(problem.contact[p]) *
                state.normal_force(p) >
              0 &&
            !state.sticks(p) &&
            excess_of_reversal(problem.contact[p], v, u) > 0)
          nodes.push_back(p);
    return nodes;
  }



  template <int dim>
  void
  TrescaFunctional<dim>::stop(
    VectorType                      &v,
    const VectorType                &u,
    const std::vector<unsigned int> &contact_nodes) const
  {
    for (const unsigned int p : contact_nodes)
      {
        const ContactNode<dim> &node   = problem.contact[p];
        const auto              slip   = slip_components<dim>(node, u);
        const double            excess = excess_of_reversal(node, v, u);
        for (unsigned int t = 1; t <= node.n_free_tangents; ++t)
          for (unsigned int d = 0; d < dim; ++d)
            v.local_element(dim * node.node + d) +=
              excess * slip[t - 1] * node.frame[t][d];
      }
  }



  template <int dim>
  unsigned int
  TrescaFunctional<dim>::keep_slip(VectorType         &v,
                                   const VectorType   &u,
                                   const ContactState &state) const
  {
    const std::vector<unsigned int> nodes = reversing_nodes(v, u, state);
    stop(v, u, nodes);
    return nodes.size();
  }



  template <int dim>
  double
  TrescaFunctional<dim>::minimize_along(const VectorType &v,
                                        const Iterate    &x,
                                        const double      slope,
                                        const double      curvature,
                                        const double      largest) const
  {
    const VectorType   &u     = x.u;
    const ContactState &state = x.state;

    // Per node with friction: bound, and the coefficients of
    // |u_T - s + alpha v_T|^2.
    struct Term
    {
      double bound, uu, uv, vv;
    };
    std::vector<Term> terms;
    if (state.has_friction())
      for (unsigned int p = 0; p < problem.contact.size(); ++p)
        if (state.normal_force(p) > 0)
          {
            const ContactNode<dim> &node = problem.contact[p];
            const auto              a    = slip_components<dim>(node, u);
            const auto              b    = tangential_components<dim>(node, v);
            Term term = {problem.effective_coefficient(node) *
                           state.normal_force(p),
                         0,
                         0,
                         0};
            for (unsigned int t = 0; t < dim - 1; ++t)
              {
                term.uu += a[t] * a[t];
                term.uv += a[t] * b[t];
                term.vv += b[t] * b[t];
              }
            if (term.vv > 0)
              terms.push_back(term);
          }

    // The derivative from the right, which never decreases, at several points
    // at once.
    constexpr unsigned int n_trials = 4;
    using Values                    = std::array<double, n_trials>;
    const auto derivatives          = [&](const Values &alphas) {
      Values values{};
      for (unsigned int i = 0; i < n_trials; ++i)
        for (const Term &t : terms)
          {
            const double inner  = t.uv + alphas[i] * t.vv;
            const double square = t.uu + alphas[i] * (t.uv + inner);
            // At rest the node starts to move along v.
            values[i] += t.bound *
              (square > 1e-30 * (t.uu + t.vv) ? inner / std::sqrt(square)
                                                       : std::sqrt(t.vv));
          }
      values = sum_over_processes(values, problem.communicator());
      for (unsigned int i = 0; i < n_trials; ++i)
        values[i] += alphas[i] * curvature - slope;
      return values;
    };

    if (!state.has_friction())
      return slope > 0 ? std::min(largest, slope / curvature) : 0.;

    // Without a kink in between the derivative is close to linear, and one or
    // two rounds suffice. Each leaves the smallest interval between trials in
    // which the sign changes: that of regula falsi, and points to its left and
    // right and in the middle of the interval.
    const double guess = std::min(largest, slope / curvature);
    Values       alphas{{0., largest, guess, .5 * guess}};
    Values       d   = derivatives(alphas);
    double       low = 0., high = largest, d_low = d[0], d_high = d[1];
    double       last_width = std::numeric_limits<double>::infinity();
    if (!(d_low < 0.))
      return 0.;
    if (d_high <= 0.)
      return largest;
    for (unsigned int round = 0; round < 30; ++round)
      {
        for (unsigned int i = 0; i < n_trials; ++i)
          {
            if (std::abs(d[i]) <= 1e-13 * std::abs(slope))
              return alphas[i];
            if (d[i] <= 0 && alphas[i] > low)
              {
                low   = alphas[i];
                d_low = d[i];
              }
            else if (d[i] > 0 && alphas[i] < high)
              {
                high   = alphas[i];
                d_high = d[i];
              }
          }
        const double width = high - low;
        if (width <= 1e-12 * high)
          break;
        if (width > .25 * last_width)
          // Regula falsi does not do at a kink.
          alphas = {{low + .2 * width,
                     low + .4 * width,
                     low + .6 * width,
                     low + .8 * width}};
        else
          {
            const double trial = std::min(
              high, std::max(low, low - d_low * width / (d_high - d_low)));
            alphas = {{trial,
                       std::max(low, trial - .01 * width),
                       std::min(high, trial + .01 * width),
                       .5 * (low + high)}};
          }
        last_width = width;
        d          = derivatives(alphas);
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
    return -max_over_processes(-length, problem.communicator());
  }



  template class TrescaFunctional<2>;
  template class TrescaFunctional<3>;
} // namespace Friction

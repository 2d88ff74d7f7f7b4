#include <common/iteration/linearization.h>
#include <common/parallel/owned_values.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Friction
{
  namespace
  {
    double
    norm_of(const std::array<double, 1> &u_T)
    {
      return std::abs(u_T[0]);
    }

    double
    norm_of(const std::array<double, 2> &u_T)
    {
      return std::sqrt(u_T[0] * u_T[0] + u_T[1] * u_T[1]);
    }

    // On a line there is nothing to turn.
    NodeBlock<2>
    friction_curvature(const ContactNode<2> &,
                       const std::array<double, 1> &,
                       const double,
                       const double)
    {
      return zero_block<2>();
    }

    // The second derivative of s |u_T| on the free tangents.
    NodeBlock<3>
    friction_curvature(const ContactNode<3>        &node,
                       const std::array<double, 2> &u_T,
                       const double                 s,
                       const double                 largest)
    {
      const double norm   = norm_of(u_T);
      const double factor = (s < largest * norm) ? s / norm : largest;

      // Perpendicular to the slip; components that cannot move are left out.
      const double turned[2] = {-u_T[1] / norm, u_T[0] / norm};
      Tensor<1, 3> e;
      NodeBlock<3> curvature;
      for (unsigned int t = 0; t < node.n_free_tangents; ++t)
        e += turned[t] * node.frame[t + 1];
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int r = 0; r < 3; ++r)
          curvature[c * 3 + r] = factor * e[r] * e[c];
      return curvature;
    }

    // Whether two blocks agree within a tenth of their size, or of the
    // stiffness that they are added to.
    template <int dim>
    bool
    is_close(const NodeBlock<dim> &block,
             const NodeBlock<dim> &other,
             const double          stiffness)
    {
      double difference = 0, size = 0;
      for (unsigned int i = 0; i < dim * dim; ++i)
        {
          difference += (block[i] - other[i]) * (block[i] - other[i]);
          size += other[i] * other[i];
        }
      return std::sqrt(difference) <= .1 * (std::sqrt(size) + stiffness);
    }
  } // namespace



  template <int dim>
  Linearization<dim>::Linearization(const DiscreteProblem<dim> &problem,
                                    const TruncationVariant     variant)
    : problem(problem)
    , variant(variant)
    , current(problem)
  {}



  template <int dim>
  void
  Linearization<dim>::update(const Iterate &x)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    const ContactBoundary<dim> &contact = problem.contact;
    const ContactState         &state   = x.state;
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        const ContactNode<dim> &node = contact[p];
        const bool              all_is_held =
          state.in_contact(p) && variant == TruncationVariant::contact;

        const NodeBlock<dim> projector = current.projector(
          p, !state.in_contact(p), !state.sticks(p) && !all_is_held);
        NodeBlock<dim> curvature = zero_block<dim>();
        if (dim == 3 &&
            variant != TruncationVariant::phases_without_second_order)
          {
            const double bound =
              problem.effective_coefficient(node) * state.normal_force(p);
            const auto   u_T = slip_components<dim>(node, x.u);
            const double stiffness =
              trace<dim>(problem.stiffness.diagonal_block(node.node)) / dim;
            if (bound > 0 && !state.sticks(p) && !all_is_held &&
                norm_of(u_T) > 0)
              curvature = friction_curvature(node, u_T, bound, 1e8 * stiffness);
            if (projector == truncation().projector(node.node) &&
                is_close<dim>(
                  truncation().curvature(node.node), curvature, stiffness))
              continue;
          }
        current.set(p, projector, curvature);
      }
    current.exchange();
  }



  template <int dim>
  void
  Linearization<dim>::hold(const std::vector<unsigned int> &contact_nodes,
                           const Iterate                   &x)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    for (const unsigned int p : contact_nodes)
      current.set(p,
                  current.projector(p, !x.state.in_contact(p), false),
                  zero_block<dim>());
    current.exchange();
  }



  template <int dim>
  void
  Linearization<dim>::linearize_residual(VectorType &r, const Iterate &x) const
  {
    const ContactBoundary<dim> &contact = problem.contact;
    const ContactState         &state   = x.state;
    r                                   = x.residual;
    if (state.has_friction())
      for (unsigned int p = 0; p < contact.size(); ++p)
        if (state.normal_force(p) > 0 && !state.sticks(p))
          {
            const ContactNode<dim> &node = contact[p];
            const auto              u_T  = slip_components<dim>(node, x.u);
            const double            norm = norm_of(u_T);
            if (norm > 0)
              for (unsigned int t = 1; t < dim; ++t)
                for (unsigned int d = 0; d < dim; ++d)
                  r.local_element(dim * node.node + d) -=
                    problem.effective_coefficient(node) *
                    state.normal_force(p) * u_T[t - 1] / norm *
                    node.frame[t][d];
          }
    truncation().apply(r.begin());
  }



  template <int dim>
  void
  Linearization<dim>::linearized_defect(VectorType       &defect,
                                        const VectorType &r,
                                        const VectorType &v) const
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::line_search);
    problem.stiffness.vmult(defect, v);
    scale_owned(defect, -1.);
    add_owned(defect, 1., r);
    for (const unsigned int node : truncation().changed_nodes())
      if (dim * node < v.locally_owned_size())
        {
          const NodeValue<dim> image = times<dim>(
            truncation().curvature(node).data(), v.begin() + dim * node);
          for (unsigned int d = 0; d < dim; ++d)
            defect.local_element(dim * node + d) -= image[d];
        }
    truncation().apply(defect.begin());
  }



  template <int dim>
  void
  Linearization<dim>::bounds(VectorType    &lower,
                             VectorType    &upper,
                             const Iterate &x) const
  {
    const ContactBoundary<dim> &contact = problem.contact;
    const ContactState         &state   = x.state;
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
          add(node.normal(), node.gap - normal_component(node, x.u));
        if (problem.effective_coefficient(node) * state.normal_force(p) > 0 &&
            !state.sticks(p))
          {
            // The displacement keeps a part in the direction of its slip.
            const auto     u_T  = slip_components<dim>(node, x.u);
            const double   norm = norm_of(u_T);
            Tensor<1, dim> back;
            for (unsigned int t = 1; t < dim; ++t)
              back -= (norm > 0 ? u_T[t - 1] / norm : 1.) * node.frame[t];
            add(back, norm);
          }
      }
  }



  template class Linearization<2>;
  template class Linearization<3>;
} // namespace Friction

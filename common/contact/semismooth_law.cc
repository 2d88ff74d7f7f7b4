#include <common/contact/semismooth_law.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  namespace
  {
    template <std::size_t n>
    double
    norm_of(const std::array<double, n> &v, const unsigned int n_free = n)
    {
      double sum = 0;
      for (unsigned int t = 0; t < n_free; ++t)
        sum += v[t] * v[t];
      return std::sqrt(sum);
    }



    // What a node and its law are made of: forces and slip in its frame.
    template <int dim>
    struct AtNode
    {
      double                      pressing, room, node_stiffness;
      std::array<double, dim - 1> force, slip;
      unsigned int                n_free;

      AtNode(const DiscreteProblem<dim> &problem,
             const ContactNode<dim>     &node,
             const VectorType           &u,
             const VectorType           &residual)
        : pressing(normal_component(node, residual))
        , room(node.gap - normal_component(node, u))
        , node_stiffness(
            trace<dim>(problem.stiffness.diagonal_block(node.node)) / dim)
        , force(tangential_components<dim>(node, residual))
        , slip(slip_components<dim>(node, u))
        , n_free(node.n_free_tangents)
      {}

      // Slip that is prescribed never vanishes, and so friction has a direction
      // and is smooth.
      bool
      slip_is_prescribed() const
      {
        for (unsigned int t = n_free; t < dim - 1; ++t)
          if (slip[t] != 0)
            return true;
        return false;
      }
    };



    // How much turning the slip of a node may cost, in stiffnesses of the node
    // or of the zone; larger numbers would only cost digits.
    constexpr double largest_turn = 1e4;



    // r_T = bound * slip / |slip|, for a slip that does not vanish.
    template <int dim>
    void
    slide_along_slip(SemismoothLaw<dim> &law,
                     const AtNode<dim>  &at,
                     const double        F,
                     const double        bound,
                     const bool          bound_is_given)
    {
      law.tangent       = SemismoothLaw<dim>::Tangent::slides;
      const double size = norm_of(at.slip);
      const double turn =
        std::min(bound, largest_turn * at.node_stiffness * size) / size;
      for (unsigned int s = 0; s < at.n_free; ++s)
        {
          const double e = at.slip[s] / size;
          law.slope[s]   = bound_is_given ? 0. : F * e;
          law.rhs[s] =
            at.force[s] - (bound_is_given ? bound * e : F * e * at.pressing);
          law.violation[s + 1] = at.force[s] - bound * e;
          for (unsigned int t = 0; t < at.n_free; ++t)
            law.curvature[t * (dim - 1) + s] =
              turn * ((s == t ? 1. : 0.) - e * at.slip[t] / size);
        }
    }



    template <int dim>
    void
    stick(SemismoothLaw<dim> &law, const AtNode<dim> &at, const double c)
    {
      law.tangent = SemismoothLaw<dim>::Tangent::sticks;
      for (unsigned int t = 0; t < at.n_free; ++t)
        {
          law.known_step[t + 1] = -at.slip[t];
          law.violation[t + 1]  = -c * at.slip[t];
        }
    }
  } // namespace



  template <int dim>
  SemismoothLaw<dim>
  linearize_law(const DiscreteProblem<dim> &problem,
                const ContactNode<dim>     &node,
                const LawAtNode            &at_node,
                const VectorType           &u,
                const VectorType           &residual)
  {
    const double       c = at_node.stiffness;
    SemismoothLaw<dim> law;
    const AtNode<dim>  at(problem, node, u, residual);

    const double tau = at.pressing - c * at.room;
    law.in_contact   = tau > 0;
    if (law.in_contact)
      law.known_step[0] = at.room;
    law.violation[0] = law.in_contact ? c * at.room : at.pressing;

    const double F       = problem.effective_coefficient(node);
    const bool   coulomb = problem.has_coulomb_friction(node);
    const double bound =
      F * (coulomb ? std::max(0., tau) : at_node.given_normal_force);
    if (!(bound > 0) || at.n_free == 0)
      {
        for (unsigned int t = 0; t < at.n_free; ++t)
          law.violation[t + 1] = at.force[t];
        return law;
      }
    if (at.slip_is_prescribed())
      {
        slide_along_slip(law, at, F, bound, !coulomb);
        return law;
      }

    std::array<double, dim - 1> z{};
    for (unsigned int t = 0; t < at.n_free; ++t)
      z[t] = at.force[t] + c * at.slip[t];
    const double size = norm_of(z, at.n_free);
    if (size <= bound)
      {
        stick(law, at, c);
        return law;
      }

    law.tangent = SemismoothLaw<dim>::Tangent::slides;
    // On a line there is nothing to turn. At the limit of slip derivative and
    // right hand side have the same factor, so that where a step leads to does
    // not depend on its limit.
    const double share =
      at.n_free < 2 ? 0. : std::min(bound / (size - bound), largest_turn);
    double along = 0;
    for (unsigned int t = 0; t < at.n_free; ++t)
      {
        z[t] /= size;
        along += z[t] * at.force[t];
      }
    for (unsigned int s = 0; s < at.n_free; ++s)
      {
        const double across = at.force[s] - z[s] * along;
        law.direction[s]    = z[s];
        law.slope[s]        = coulomb ? F * z[s] : 0.;
        law.rhs[s]          = at.force[s] + share * across -
          z[s] * (coulomb ? F * at.pressing : bound);
        law.violation[s + 1] = at.force[s] - bound * z[s];
        for (unsigned int t = 0; t < at.n_free; ++t)
          law.curvature[t * (dim - 1) + s] =
            share * c * ((s == t ? 1. : 0.) - z[s] * z[t]);
      }
    return law;
  }



  template <int dim>
  SemismoothLaw<dim>
  linearize_law_of_guess(const DiscreteProblem<dim> &problem,
                         const unsigned int          p,
                         const ContactState         &state,
                         const VectorType           &u,
                         const VectorType           &residual)
  {
    SemismoothLaw<dim>      law;
    const ContactNode<dim> &node = problem.contact[p];
    const AtNode<dim>       at(problem, node, u, residual);
    law.in_contact = state.in_contact(p);
    if (law.in_contact)
      law.known_step[0] = at.room;

    const double F       = problem.effective_coefficient(node);
    const bool   coulomb = problem.has_coulomb_friction(node);
    if (!(F > 0) || at.n_free == 0 || (coulomb && !law.in_contact))
      return law;
    if (state.sticks(p) || norm_of(at.slip) == 0)
      stick(law, at, 0.);
    else
      {
        slide_along_slip(law, at, F, F * state.normal_force(p), !coulomb);
        for (unsigned int t = 0; t < at.n_free && !at.slip_is_prescribed(); ++t)
          law.direction[t] = at.slip[t] / norm_of(at.slip);
      }
    return law;
  }



  template <int dim>
  std::vector<double>
  stiffnesses_of_zone(const DiscreteProblem<dim> &problem,
                      const ContactState         &state)
  {
    std::array<double, 2> measures = {{0., 0.}};
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      {
        measures[0] += state.in_contact(p) ? problem.contact[p].measure : 0.;
        measures[1] += problem.contact[p].measure;
      }
    measures          = sum_over_processes(measures, problem.communicator());
    const double zone = measures[0] > 0 ? measures[0] : measures[1];

    std::vector<double> result;
    for (const ContactNode<dim> &node : problem.contact)
      {
        NodeValue<dim> n;
        for (unsigned int d = 0; d < dim; ++d)
          n[d] = node.normal()[d];
        const NodeValue<dim> An =
          times<dim>(problem.stiffness.diagonal_block(node.node), n.data());
        result.push_back(3. * dot<dim>(n.data(), An.data()) *
                         std::pow(node.measure / std::max(zone, node.measure),
                                  1. / (dim - 1)));
      }
    return result;
  }



#define INSTANTIATE(dim)                                                  \
  template SemismoothLaw<dim> linearize_law(const DiscreteProblem<dim> &, \
                                            const ContactNode<dim> &,     \
                                            const LawAtNode &,            \
                                            const VectorType &,           \
                                            const VectorType &);          \
  template SemismoothLaw<dim> linearize_law_of_guess(                     \
    const DiscreteProblem<dim> &,                                         \
    const unsigned int,                                                   \
    const ContactState &,                                                 \
    const VectorType &,                                                   \
    const VectorType &);                                                  \
  template std::vector<double> stiffnesses_of_zone(                       \
    const DiscreteProblem<dim> &, const ContactState &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Friction

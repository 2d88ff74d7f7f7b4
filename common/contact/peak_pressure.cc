#include <common/contact/contact_forces.h>
#include <common/contact/peak_pressure.h>
#include <common/parallel/reductions.h>

#include <array>
#include <cmath>

namespace Friction
{
  template <int dim>
  PeakPressure<dim>::PeakPressure(const DiscreteProblem<dim> &problem,
                                  const VectorType           &u,
                                  const VectorType           &residual,
                                  const ContactState         &state)
    : problem(problem)
    , u(u)
  {
    if (problem.previous_displacement != nullptr)
      previous_length = problem.previous_displacement->linfty_norm();
    problem.stiffness.update_ghosts(u);
    double inside = 0;
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      {
        const ContactNode<dim> &node = problem.contact[p];
        inside = std::max(inside, stress_inside(node.node));
        if (state.in_contact(p))
          {
            touching += node.measure;
            stress =
              std::max(stress, normal_component(node, residual) / node.measure);
          }
        if (problem.has_friction() && !problem.has_coulomb_friction(node))
          {
            const Tensor<1, dim> friction =
              tangential_part(node, contact_force(node, residual));
            const double bound =
              problem.effective_coefficient(node) * state.normal_force(p);
            stress =
              std::max(stress, std::min(bound, friction.norm()) / node.measure);
          }
      }
    const MPI_Comm comm = problem.communicator();
    touching            = sum_over_processes(touching, comm);
    if (touching == 0)
      for (unsigned int node = 0; node < problem.face_measures.size(); ++node)
        if (!problem.constraints.is_hanging(node))
          inside = std::max(inside, stress_inside(node));
    const auto largest =
      max_over_processes(std::array<double, 2>{{stress, inside}}, comm);
    constexpr double barely = 1e-3;
    stress = std::max(largest[0], (touching > 0 ? barely : 1.) * largest[1]);
  }



  template <int dim>
  double
  PeakPressure<dim>::stress_inside(const unsigned int node) const
  {
    const NodeBlockMatrix<dim> &A   = problem.stiffness.blocks();
    const double               *all = u.begin(), *own = all + dim * node;
    double                      sum = 0;
    for (std::size_t e = A.row_begin(node) + 1; e < A.row_end(node); ++e)
      {
        NodeValue<dim> difference;
        for (unsigned int d = 0; d < dim; ++d)
          difference[d] = all[dim * A.column(e) + d] - own[d];
        const NodeValue<dim> force =
          times<dim>(A.value(node, e).data(), difference.data());
        sum += std::sqrt(dot<dim>(force.data(), force.data()));
      }
    return .5 * sum / problem.face_measures[node];
  }



  template <int dim>
  double
  PeakPressure<dim>::force_of_rounding(const unsigned int node) const
  {
    // A millionth of it, which certificates are to be below by default, is
    // above the rounding errors of a row: of 18 or 81 products, with blocks
    // that are together twice as large as the diagonal one.
    constexpr double part = (dim == 2 ? 1e-8 : 2e-8);
    const double    *u_p  = u.begin() + dim * node;
    return part * trace<dim>(problem.stiffness.diagonal_block(node)) *
      std::max(std::sqrt(dot<dim>(u_p, u_p)), previous_length);
  }



  template class PeakPressure<2>;
  template class PeakPressure<3>;
} // namespace Friction

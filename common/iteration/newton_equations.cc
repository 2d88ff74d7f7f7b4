#include <common/iteration/newton_equations.h>
#include <common/parallel/owned_values.h>

namespace Friction
{
  template <int dim>
  NewtonEquations<dim>::NewtonEquations(const DiscreteProblem<dim> &problem)
    : problem(problem)
    , current(problem)
    , slides(problem.contact.size(), 0)
    , all_slopes(problem.contact.size())
  {}



  template <int dim>
  void
  NewtonEquations<dim>::update(const std::vector<SemismoothLaw<dim>> &laws)
  {
    using Tangent = typename SemismoothLaw<dim>::Tangent;
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        const SemismoothLaw<dim> &law     = laws[p];
        const ContactNode<dim>   &node    = problem.contact[p];
        NodeBlock<dim>            turning = zero_block<dim>();
        all_slopes[p]                     = {};
        slides[p]                         = law.tangent == Tangent::slides;
        if (slides[p])
          for (unsigned int s = 0; s < node.n_free_tangents; ++s)
            {
              for (unsigned int d = 0; d < dim; ++d)
                all_slopes[p][d] += law.slope[s] * node.frame[s + 1][d];
              for (unsigned int t = 0; t < node.n_free_tangents; ++t)
                for (unsigned int c = 0; c < dim; ++c)
                  for (unsigned int r = 0; r < dim; ++r)
                    turning[c * dim + r] += law.curvature[t * (dim - 1) + s] *
                      node.frame[s + 1][r] * node.frame[t + 1][c];
            }
        current.set(
          p,
          current.projector(p, !law.in_contact, law.tangent != Tangent::sticks),
          turning);
      }
    current.exchange();
  }



  template <int dim>
  void
  NewtonEquations<dim>::vmult(VectorType &result, const VectorType &v) const
  {
    problem.stiffness.vmult(result, v);
    for (unsigned int p = 0; p < slides.size(); ++p)
      if (slides[p])
        {
          const ContactNode<dim> &node   = problem.contact[p];
          const double            normal = normal_component(node, result);
          const NodeValue<dim>    turning =
            times<dim>(truncation().curvature(node.node).data(),
                       v.begin() + dim * node.node);
          for (unsigned int d = 0; d < dim; ++d)
            result.local_element(dim * node.node + d) +=
              turning[d] - all_slopes[p][d] * normal;
        }
    truncation().apply(result.begin());
  }



  template <int dim>
  void
  NewtonEquations<dim>::eliminate_known(
    const std::vector<SemismoothLaw<dim>> &laws,
    const VectorType                      &residual,
    VectorType                            &step,
    VectorType                            &rhs) const
  {
    step = 0.;
    rhs  = residual;
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        const ContactNode<dim>   &node   = problem.contact[p];
        const SemismoothLaw<dim> &law    = laws[p];
        const unsigned int        dof    = dim * node.node;
        const double              normal = normal_component(node, residual);
        for (unsigned int d = 0; d < dim; ++d)
          {
            double known = 0, value = normal * node.normal()[d];
            for (unsigned int e = 0; e < dim; ++e)
              known += law.known_step[e] * node.frame[e][d];
            for (unsigned int t = 0; t < node.n_free_tangents; ++t)
              value += law.rhs[t] * node.frame[t + 1][d];
            step.local_element(dof + d) = known;
            if (slides[p])
              rhs.local_element(dof + d) = value;
          }
      }
    truncation().apply(rhs.begin());
    VectorType image(rhs);
    vmult(image, step);
    add_owned(rhs, -1., image);
  }



  template <int dim>
  void
  subtract_change_of_bound(NodeBlock<dim>         &block,
                           const NodeValue<dim>   &slope,
                           const ContactNode<dim> &slider,
                           const NodeBlock<dim>   &column)
  {
    for (unsigned int c = 0; c < dim; ++c)
      {
        double normal = 0;
        for (unsigned int d = 0; d < dim; ++d)
          normal += slider.normal()[d] * column[c * dim + d];
        for (unsigned int r = 0; r < dim; ++r)
          block[c * dim + r] -= slope[r] * normal;
      }
  }



  template class NewtonEquations<2>;
  template class NewtonEquations<3>;

  template void subtract_change_of_bound<2>(NodeBlock<2> &,
                                            const NodeValue<2> &,
                                            const ContactNode<2> &,
                                            const NodeBlock<2> &);
  template void subtract_change_of_bound<3>(NodeBlock<3> &,
                                            const NodeValue<3> &,
                                            const ContactNode<3> &,
                                            const NodeBlock<3> &);
} // namespace Friction

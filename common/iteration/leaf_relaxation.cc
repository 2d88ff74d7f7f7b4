#include <common/iteration/leaf_relaxation.h>
#include <common/nodes/interface_damping.h>
#include <common/parallel/run_clock.h>

namespace Friction
{
  namespace
  {
    // The diagonal block, enlarged where it has to be.
    template <int dim>
    NodeBlock<dim>
    damped_diagonal(const DiscreteProblem<dim> &problem,
                    const unsigned int          node)
    {
      const double        *diagonal = problem.stiffness.diagonal_block(node);
      const NodeBlock<dim> damping =
        interface_damping(problem.stiffness.blocks(), node);
      NodeBlock<dim> block;
      for (unsigned int e = 0; e < dim * dim; ++e)
        block[e] = diagonal[e] + damping[e];
      return block;
    }
  } // namespace



  template <int dim>
  LeafRelaxation<dim>::LeafRelaxation(const DiscreteProblem<dim>  &problem,
                                      const MonotoneSmoother<dim> &smoother)
    : problem(problem)
    , ordinary_nodes(smoother.relaxation_of_ordinary_nodes())
    , inverses(problem.contact.size())
  {}



  template <int dim>
  void
  LeafRelaxation<dim>::update(const Truncation<dim>             &truncation,
                              const std::vector<NodeValue<dim>> &new_slopes)
  {
    current = &truncation;
    slopes  = &new_slopes;
    for (unsigned int p = 0; p < inverses.size(); ++p)
      {
        const unsigned int    node = problem.contact[p].node;
        const NodeBlock<dim> &T    = truncation.projector(node);
        NodeBlock<dim>        block =
          times<dim>(T, times<dim>(damped_diagonal(problem, node), T));
        for (unsigned int e = 0; e < dim * dim; ++e)
          block[e] += truncation.curvature(node)[e];
        // Its own rounding must not bring back what is truncated.
        const NodeBlock<dim> inverse = pseudo_inverse<dim>(
          block, 1e-10 * trace<dim>(problem.stiffness.diagonal_block(node)));
        inverses[p] = times<dim>(T, times<dim>(inverse, T));
      }
  }



  template <int dim>
  void
  LeafRelaxation<dim>::run(VectorType        &v,
                           const VectorType  &r,
                           const unsigned int n_sweeps,
                           VectorType        *defect) const
  {
    Assert(current != nullptr, ExcMessage("The truncation is not known yet."));
    const PhaseScope phase(problem.communicator(), SolverPhase::leading_sweeps);
    const ContactBoundary<dim> &contact = problem.contact;
    const NodeBlockMatrix<dim> &matrix  = problem.stiffness.blocks();

    // Of a defect r - A v at a node makes that of the rows with friction.
    // A part of r in normal direction would be no part of the problem.
    const auto apply_law = [&](const unsigned int p, double *defect_at_node) {
      const unsigned int   node = contact[p].node;
      const NodeValue<dim> turning =
        times<dim>(current->curvature(node).data(), v.begin() + dim * node);
      double normal = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        normal += contact[p].normal()[d] * defect_at_node[d];
      for (unsigned int d = 0; d < dim; ++d)
        defect_at_node[d] -= turning[d] + (*slopes)[p][d] * normal;
    };
    const auto relax_contact_nodes = [&]() {
      for (unsigned int p = 0; p < contact.size(); ++p)
        {
          // Where normal forces act along a node, it would not settle: they
          // may answer by more than what has been taken away.
          if ((*slopes)[p] != NodeValue<dim>{})
            continue;
          const unsigned int   node    = contact[p].node;
          const NodeValue<dim> product = matrix.row_times(node, v.begin());
          NodeValue<dim>       rest;
          for (unsigned int d = 0; d < dim; ++d)
            rest[d] = r.local_element(dim * node + d) - product[d];
          apply_law(p, rest.data());
          const NodeValue<dim> step =
            times<dim>(inverses[p].data(), rest.data());
          for (unsigned int d = 0; d < dim; ++d)
            v.local_element(dim * node + d) += step[d];
        }
    };

    // Contact nodes by themselves, since the matrix does not have what friction
    // adds.
    for (unsigned int i = 0; i < n_sweeps; ++i)
      {
        problem.stiffness.update_ghosts(v);
        ordinary_nodes.run(1, r.begin(), v.begin(), problem.stiffness.ghosts());
        relax_contact_nodes();
      }
    current->apply(v.begin());
    if (defect == nullptr)
      return;
    problem.stiffness.residual(*defect, r, v);
    for (unsigned int p = 0; p < contact.size(); ++p)
      apply_law(p, defect->begin() + dim * contact[p].node);
    current->apply(defect->begin());
  }



  template class LeafRelaxation<2>;
  template class LeafRelaxation<3>;
} // namespace Friction

#include <common/iteration/aggregate_correction.h>
#include <common/parallel/owned_values.h>

namespace Friction
{
  template <int dim>
  AggregateCorrection<dim>::AggregateCorrection(
    Levels<dim>                &levels,
    const DiscreteProblem<dim> &problem,
    const Cycle                 cycle,
    const unsigned int          smoothing_steps)
    : problem(problem)
    , mesh_levels(levels, cycle, smoothing_steps)
    , aggregates(problem.stiffness.blocks(),
                 problem.constraints,
                 node_positions(levels.dof_handler(), problem.constraints))
    , defect(problem.constraints.partitioner())
    , second(defect)
  {}



  template <int dim>
  void
  AggregateCorrection<dim>::update(const Linearization<dim> &linearization,
                                   const Iterate            &x)
  {
    mesh_levels.update(linearization, x);
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    aggregates.update(linearization.truncation());
  }



  template <int dim>
  void
  AggregateCorrection<dim>::apply(VectorType &v, const VectorType &r)
  {
    mesh_levels.apply(v, r);

    // What that leaves over, r - T (A + omega'') v.
    const PhaseScope phase(problem.communicator(), SolverPhase::coarse_sweeps);
    const Truncation<dim> &truncation = aggregates.current_truncation();
    problem.stiffness.residual(defect, r, v);
    for (const unsigned int node : truncation.changed_nodes())
      if (node < problem.constraints.n_owned_nodes())
        {
          const NodeValue<dim> turning = times<dim>(
            truncation.curvature(node).data(), v.begin() + dim * node);
          for (unsigned int d = 0; d < dim; ++d)
            defect.local_element(dim * node + d) -= turning[d];
        }
    truncation.apply(defect.begin());
    aggregates.apply(second.begin(), defect.begin());
    add_owned(v, 1., second);
  }



  template <int dim>
  std::size_t
  AggregateCorrection<dim>::memory_consumption() const
  {
    return mesh_levels.memory_consumption() + aggregates.memory_consumption() +
      defect.memory_consumption() + second.memory_consumption();
  }



  template class AggregateCorrection<2>;
  template class AggregateCorrection<3>;
} // namespace Friction

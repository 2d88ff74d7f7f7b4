#include <common/levels/levels.h>

namespace Friction
{
  template <int dim>
  Levels<dim>::Levels(const DoFHandler<dim>      &dof_handler,
                      const DiscreteProblem<dim> &problem,
                      const CoarsestMethod        coarsest_method)
    : Levels(RunScope(problem.communicator(), RunPart::levels),
             dof_handler,
             problem,
             coarsest_method)
  {}



  template <int dim>
  Levels<dim>::Levels(const RunScope &,
                      const DoFHandler<dim>      &dof_handler,
                      const DiscreteProblem<dim> &problem,
                      const CoarsestMethod        coarsest_method)
    : problem(problem)
    , level_hierarchy(
        dof_handler, problem.constraints, problem.stiffness.blocks())
    , level_transfer(dof_handler, level_hierarchy, problem.constraints)
    , level_matrices(
        problem.stiffness.blocks(), level_hierarchy, problem.constraints)
    , coarsest(level_hierarchy, level_matrices, coarsest_method)
  {
    for (unsigned int k = 0; k < n_correction_levels(); ++k)
      {
        const auto &level = level_hierarchy.level(k);
        relaxations.emplace_back(level_matrices.matrix(k),
                                 level_matrices.inverse_diagonals(k),
                                 level.relaxed_nodes());
        coupled.emplace_back(level.numbering(), level.coupled_ghosts());
      }
  }



  template <int dim>
  std::size_t
  Levels<dim>::update(const Truncation<dim> &truncation)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    return level_matrices.update(truncation);
  }



  template <int dim>
  void
  Levels<dim>::relax(const unsigned int k,
                     VectorType        &c,
                     const VectorType  &b,
                     const Sweeps      &sweeps,
                     VectorType        *defect)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::coarse_sweeps);
    relaxations[k].run(sweeps,
                       b.begin(),
                       c.begin(),
                       coupled[k],
                       defect != nullptr ? defect->begin() : nullptr);
  }



  template <int dim>
  std::size_t
  Levels<dim>::memory_consumption() const
  {
    return level_hierarchy.memory_consumption() +
      level_matrices.memory_consumption() + level_transfer.memory_consumption();
  }



  template class Levels<2>;
  template class Levels<3>;
} // namespace Friction

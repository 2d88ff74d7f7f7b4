#include <common/levels/levels.h>

namespace Friction
{
  namespace
  {
    template <int dim>
    NodeRanges
    movable_nodes(const NodalConstraints<dim> &constraints)
    {
      NodeRanges nodes;
      for (unsigned int i = 0; i < constraints.n_owned_nodes(); ++i)
        if (!constraints.is_fixed(i))
          append(nodes, i);
      return nodes;
    }
  } // namespace



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
    , leaf_lines(problem.stiffness.blocks(),
                 movable_nodes(problem.constraints),
                 problem.communicator())
    , have_lines(leaf_lines.has_lines())
  {
    for (unsigned int k = 0; k < n_correction_levels(); ++k)
      {
        const auto &level = level_hierarchy.level(k);
        relaxations.emplace_back(level_matrices.matrix(k),
                                 level_matrices.inverse_diagonals(k),
                                 level.relaxed_nodes());
        lines.emplace_back(level_matrices.matrix(k),
                           level.relaxed_nodes(),
                           problem.communicator());
        have_lines = have_lines || lines.back().has_lines();
        coupled.emplace_back(level.numbering(), level.coupled_ghosts());
      }
  }



  template <int dim>
  std::size_t
  Levels<dim>::update(const Truncation<dim> &truncation)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    const std::size_t n_rows = level_matrices.update(truncation);
    // Nothing has to be known of other processes for this: their rows have no
    // part in the lines of this one.
    if (have_lines && (n_rows > 0 || !lines_are_factorised))
      {
        for (LineRelaxation<dim> &of_level : lines)
          of_level.factorise();
        leaf_lines.factorise(&level_matrices.current_truncation());
        lines_are_factorised = true;
      }
    return n_rows;
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
    double *const    result = defect != nullptr ? defect->begin() : nullptr;
    if (lines[k].has_lines())
      lines[k].run(sweeps, b.begin(), c.begin(), coupled[k], result);
    else
      relaxations[k].run(sweeps, b.begin(), c.begin(), coupled[k], result);
  }



  template <int dim>
  void
  Levels<dim>::relax_leaf(VectorType       &v,
                          const VectorType &r,
                          const Sweeps     &sweeps,
                          VectorType       *defect)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::coarse_sweeps);
    problem.stiffness.update_ghosts(v);
    leaf_lines.run(sweeps,
                   r.begin(),
                   v.begin(),
                   problem.stiffness.ghosts(),
                   defect != nullptr ? defect->begin() : nullptr);
  }



  template <int dim>
  std::size_t
  Levels<dim>::memory_consumption() const
  {
    std::size_t bytes = level_hierarchy.memory_consumption() +
      level_matrices.memory_consumption() +
      level_transfer.memory_consumption() + leaf_lines.memory_consumption();
    for (const LineRelaxation<dim> &of_level : lines)
      bytes += of_level.memory_consumption();
    return bytes;
  }



  template class Levels<2>;
  template class Levels<3>;
} // namespace Friction

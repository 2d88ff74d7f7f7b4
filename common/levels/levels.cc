#include <common/levels/levels.h>

#include <utility>

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
    : leaf_and_levels(dof_handler)
    , problem(problem)
    , level_hierarchy(
        dof_handler, problem.constraints, problem.stiffness.blocks())
    , level_transfer(dof_handler, level_hierarchy, problem.constraints)
    , level_matrices(
        problem.stiffness.blocks(), level_hierarchy, problem.constraints)
    , coarsest(level_hierarchy, level_matrices, coarsest_method)
    , leaf_lines(
        problem.stiffness.blocks(),
        movable_nodes(problem.constraints),
        [&problem](const unsigned int node, const unsigned int c) {
          return problem.constraints.is_prescribed(node, c);
        },
        problem.communicator())
    , factorised(level_matrices.n_levels() + 1, 0)
  {
    for (unsigned int k = 0; k < n_correction_levels(); ++k)
      {
        const auto &level = level_hierarchy.level(k);
        lines.emplace_back(
          level_matrices.matrix(k),
          level.relaxed_nodes(),
          [&level](const unsigned int node, const unsigned int c) {
            return level.is_prescribed(node, c);
          },
          problem.communicator());
        relaxations.emplace_back(
          level_matrices.matrix(k),
          level_matrices.inverse_diagonals(k),
          lines.back().other_nodes(level.relaxed_nodes()));
        coupled.emplace_back(level.numbering(), level.coupled_ghosts());
      }
  }



  template <int dim>
  void
  Levels<dim>::update(const Truncation<dim> &truncation)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    const std::size_t n_rows = level_matrices.update(truncation);
    // Rows of other processes have no part in the lines of this one.
    if (n_rows > 0)
      ++version;
    updated_rows += n_rows;
  }



  template <int dim>
  bool
  Levels<dim>::needs_factorisation(const unsigned int k)
  {
    return std::exchange(factorised[k], version) != version;
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
    double *const    result    = defect != nullptr ? defect->begin() : nullptr;
    const bool       has_lines = lines[k].has_lines();
    if (has_lines && needs_factorisation(k))
      lines[k].factorise();
    if (has_lines && sweeps.backwards)
      lines[k].run(sweeps, b.begin(), c.begin(), coupled[k]);
    const bool is_last = !has_lines || sweeps.backwards;
    relaxations[k].run(
      sweeps, b.begin(), c.begin(), coupled[k], is_last ? result : nullptr);
    if (!is_last)
      lines[k].run(sweeps, b.begin(), c.begin(), coupled[k], result);
  }



  template <int dim>
  void
  Levels<dim>::relax_leaf(VectorType       &v,
                          const VectorType &r,
                          const Sweeps     &sweeps,
                          VectorType       *defect)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::coarse_sweeps);
    if (needs_factorisation(n_correction_levels()))
      leaf_lines.factorise(&level_matrices.current_truncation());
    problem.stiffness.update_ghosts(v);
    leaf_lines.run(sweeps,
                   r.begin(),
                   v.begin(),
                   problem.stiffness.ghosts(),
                   defect != nullptr ? defect->begin() : nullptr);
    // The problem of a long line is so badly conditioned that its rounding
    // would leave what is truncated.
    level_matrices.current_truncation().apply(v.begin());
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

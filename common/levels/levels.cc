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
    : leaf_and_levels(dof_handler)
    , problem(problem)
    , coarsest_method(coarsest_method)
  {}



  template <int dim>
  Levels<dim>::~Levels() = default;



  template <int dim>
  void
  Levels<dim>::make_now() const
  {
    if (made)
      return;
    const RunScope part(communicator(), RunPart::levels);
    made = std::make_unique<Parts>(leaf_and_levels, problem, coarsest_method);
  }



  template <int dim>
  Levels<dim>::Parts::Parts(const DoFHandler<dim>      &dof_handler,
                            const DiscreteProblem<dim> &problem,
                            const CoarsestMethod        coarsest_method)
    : hierarchy(dof_handler, problem.constraints, problem.stiffness.blocks())
    , transfer(dof_handler, hierarchy, problem.constraints)
    , matrices(problem.stiffness.blocks(), hierarchy, problem.constraints)
    , coarsest(hierarchy, matrices, coarsest_method)
    , leaf_lines(
        problem.stiffness.blocks(),
        movable_nodes(problem.constraints),
        [&problem](const unsigned int node, const unsigned int c) {
          return problem.constraints.is_prescribed(node, c);
        },
        problem.communicator())
    , factorised(matrices.n_levels() + 1, 0)
  {
    for (unsigned int k = 0; k < matrices.n_levels(); ++k)
      {
        const auto &level = hierarchy.level(k);
        lines.emplace_back(
          matrices.matrix(k),
          level.relaxed_nodes(),
          [&level](const unsigned int node, const unsigned int c) {
            return level.is_prescribed(node, c);
          },
          problem.communicator());
        relaxations.emplace_back(
          matrices.matrix(k),
          matrices.inverse_diagonals(k),
          lines.back().other_nodes(level.relaxed_nodes()));
        coupled.emplace_back(level.numbering(), level.coupled_ghosts());
      }
  }



  template <int dim>
  void
  Levels<dim>::update(const Truncation<dim> &truncation)
  {
    Parts           &its = parts();
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    const std::size_t n_rows = its.matrices.update(truncation);
    // Rows of other processes have no part in the lines of this one.
    if (n_rows > 0)
      ++its.version;
    updated_rows += n_rows;
  }



  template <int dim>
  bool
  Levels<dim>::Parts::needs_factorisation(const unsigned int k)
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
    double *const    result     = defect != nullptr ? defect->begin() : nullptr;
    Parts           &its        = parts();
    LineRelaxation<dim> &lines  = its.lines[k];
    GhostExchange       &ghosts = its.coupled[k];
    const bool           has_lines = lines.has_lines();
    if (has_lines && its.needs_factorisation(k))
      lines.factorise();
    if (has_lines && sweeps.backwards)
      lines.run(sweeps, b.begin(), c.begin(), ghosts);
    const bool is_last = !has_lines || sweeps.backwards;
    its.relaxations[k].run(
      sweeps, b.begin(), c.begin(), ghosts, is_last ? result : nullptr);
    if (!is_last)
      lines.run(sweeps, b.begin(), c.begin(), ghosts, result);
  }



  template <int dim>
  void
  Levels<dim>::relax_leaf(VectorType       &v,
                          const VectorType &r,
                          const Sweeps     &sweeps,
                          VectorType       *defect)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::coarse_sweeps);
    Parts           &its              = parts();
    const Truncation<dim> &truncation = its.matrices.current_truncation();
    if (its.needs_factorisation(n_correction_levels()))
      its.leaf_lines.factorise(&truncation);
    problem.stiffness.update_ghosts(v);
    its.leaf_lines.run(sweeps,
                       r.begin(),
                       v.begin(),
                       problem.stiffness.ghosts(),
                       defect != nullptr ? defect->begin() : nullptr);
    // The problem of a long line is so badly conditioned that its rounding
    // would leave what is truncated.
    truncation.apply(v.begin());
  }



  template <int dim>
  std::size_t
  Levels<dim>::memory_consumption() const
  {
    if (!made)
      return 0;
    std::size_t bytes = made->hierarchy.memory_consumption() +
      made->matrices.memory_consumption() +
      made->transfer.memory_consumption() +
      made->leaf_lines.memory_consumption();
    for (const LineRelaxation<dim> &of_level : made->lines)
      bytes += of_level.memory_consumption();
    return bytes;
  }



  template class Levels<2>;
  template class Levels<3>;
} // namespace Friction

#include <common/levels/aggregate_levels.h>
#include <common/levels/levels.h>
#include <common/nodes/places.h>

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



    template <int dim>
    Places
    leaf_positions(const DoFHandler<dim>      &dof_handler,
                   const DiscreteProblem<dim> &problem)
    {
      Places result;
      for (const Point<dim> &point :
           node_positions(dof_handler, problem.constraints))
        result.push_back(place_of(point));
      return result;
    }



    // Of the owned nodes of level k.
    template <int dim>
    Places
    level_positions(const DoFHandler<dim>  &dof_handler,
                    const NodeDistribution &owned,
                    const unsigned int      k)
    {
      Places result(owned.n_owned());
      for (const auto &cell : dof_handler.mg_cell_iterators_on_level(k))
        if (cell->is_locally_owned_on_level())
          for (const unsigned int v : cell->vertex_indices())
            {
              const GlobalNode node = cell->mg_vertex_dof_index(k, v, 0) / dim;
              if (owned.is_owned(node))
                result[owned.local(node)] = place_of(cell->vertex(v));
            }
      return result;
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
    , factorised(matrices.n_levels() + 1, 0)
  {
    for (unsigned int k = 0; k < matrices.n_levels(); ++k)
      {
        const auto  &level = hierarchy.level(k);
        RelaxedNodes nodes;
        nodes.nodes   = level.relaxed_nodes();
        nodes.is_held = [&level](const unsigned int node,
                                 const unsigned int c) {
          return level.is_prescribed(node, c);
        };
        nodes.positions = [&dof_handler, &level, k]() {
          return level_positions(
            dof_handler, level.numbering().distribution(), k);
        };
        stretched.emplace_back(
          matrices.matrix(k), nodes, problem.communicator());
        relaxations.emplace_back(matrices.matrix(k),
                                 matrices.inverse_diagonals(k),
                                 stretched.back().other_nodes(nodes.nodes));
        coupled.emplace_back(level.numbering(), level.coupled_ghosts());
      }

    RelaxedNodes nodes;
    nodes.nodes   = movable_nodes(problem.constraints);
    nodes.is_held = [&problem](const unsigned int node, const unsigned int c) {
      return problem.constraints.is_prescribed(node, c);
    };
    for (const ContactNode<dim> &p : problem.contact)
      nodes.truncated.push_back(p.node);
    nodes.positions = [&dof_handler, &problem]() {
      return leaf_positions(dof_handler, problem);
    };
    stretched.emplace_back(
      problem.stiffness.blocks(), nodes, problem.communicator());
  }



  template <int dim>
  void
  Levels<dim>::update(const Truncation<dim> &truncation)
  {
    Parts           &its = parts();
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    const std::size_t n_rows = its.matrices.update(truncation);
    // Rows of other processes have no part in lines and planes of this one.
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
                     const unsigned int n_sweeps,
                     VectorType        *defect)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::coarse_sweeps);
    double *const    result = defect != nullptr ? defect->begin() : nullptr;
    Parts           &its    = parts();
    StretchedRelaxation<dim> &stretched = its.stretched[k];
    GhostExchange            &ghosts    = its.coupled[k];
    const bool                there_are = stretched.share() > 0.;
    if (there_are && its.needs_factorisation(k))
      stretched.factorise();
    its.relaxations[k].run(
      n_sweeps, b.begin(), c.begin(), ghosts, there_are ? nullptr : result);
    if (there_are)
      stretched.run(n_sweeps, b.begin(), c.begin(), ghosts, result);
  }



  template <int dim>
  void
  Levels<dim>::relax_leaf(VectorType        &v,
                          const VectorType  &r,
                          const unsigned int n_sweeps,
                          VectorType        *defect)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::coarse_sweeps);
    Parts           &its                 = parts();
    StretchedRelaxation<dim> &stretched  = its.stretched.back();
    const Truncation<dim>    &truncation = its.matrices.current_truncation();
    if (its.needs_factorisation(n_correction_levels()))
      stretched.factorise(&truncation);
    problem.stiffness.update_ghosts(v);
    stretched.run(n_sweeps,
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
      made->matrices.memory_consumption() + made->transfer.memory_consumption();
    for (const StretchedRelaxation<dim> &of_level : made->stretched)
      bytes += of_level.memory_consumption();
    return bytes;
  }



  template class Levels<2>;
  template class Levels<3>;
} // namespace Friction

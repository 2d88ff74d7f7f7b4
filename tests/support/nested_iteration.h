#ifndef friction_tests_support_nested_iteration_h
#define friction_tests_support_nested_iteration_h

#include <common/compatibility.h>
#include <common/discretization/discretization.h>
#include <common/estimate/contact_estimate.h>
#include <common/estimate/marking.h>
#include <common/algorithms/coulomb_solver.h>
#include <common/algorithms/initial_guess.h>

#include <deal.II/base/timer.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace Tests
{
  using namespace dealii;
  using namespace Friction;

  /**
   * The loop over levels of the step programs, one call at a time, for tests
   * that want to look at the solution of each level, or at several solutions
   * on the same mesh.
   */
  template <int dim>
  class NestedIteration
  {
  public:
    using Stiffening = typename Discretization<dim>::Stiffening;

    /** Makes the first mesh. The initial guess is zero. */
    explicit NestedIteration(const Parameters &parameters,
                             const Stiffening &stiffening = {})
      : parameters(parameters)
      , stiffening(stiffening)
      , scene(parameters)
      , mesh(make_triangulation<dim>())
    {
      scene.make_coarse_mesh(*mesh);
      mesh->refine_global(parameters.refinement.initial_refinements);
      discretize();
      guess.reinit(discretization->constraints->partitioner());
      guess_tractions.reinit(guess);
    }

    /** The initial guess of this level, made admissible. */
    ContactState
    make_guess(VectorType &u) const
    {
      u = guess;
      return make_initial_guess(u,
                                guess_tractions,
                                *discretization->constraints,
                                *discretization->contact,
                                discretization->problem().has_friction());
    }

    /** Solves with other settings, starting from the same guess, and leaves
     * the iteration over the levels alone. */
    SolverReport
    solve_with(const SolverSettings &settings, VectorType &u, ContactState &s)
    {
      s = make_guess(u);
      Timer              timer;
      CoulombSolver<dim> solver(
        *discretization->hierarchy, discretization->problem(), settings);
      setup_seconds = timer.wall_time();
      timer.restart();
      SolverReport result = solver.solve(u, s);
      solve_seconds       = timer.wall_time();
      cost                = solver.multigrid().cost();
      discretization->hanging.distribute(u);
      return result;
    }

    /** Solves on this level. */
    void
    solve()
    {
      report = solve_with(parameters.solver, displacement, state);
      accept();
    }

    /** Takes displacement, state and report, set by the caller, as the solution
     * on this level. */
    void
    accept()
    {
      discretization->hanging.distribute(displacement);
      displacement.update_ghost_values();
      tractions = contact_tractions(report.residual,
                                    *discretization->constraints,
                                    *discretization->contact,
                                    state);
      discretization->hanging.distribute(tractions);
      tractions.update_ghost_values();
    }

    /** Goes on to the next level, as the parameters say. Returns false if this
     * was the last one. */
    bool
    refine()
    {
      if (level >= parameters.refinement.levels ||
          discretization->dof_handler.n_dofs() >=
            parameters.refinement.maximum_dofs)
        return false;
      refine(parameters.refinement.strategy);
      return true;
    }

    /** Goes on to a next level in any case, refining as is said here. */
    void
    refine(const RefinementStrategy strategy)
    {
      ++level;
      if (strategy == RefinementStrategy::uniform)
        mesh->set_all_refine_flags();
      else
        mark();

      const std::unique_ptr<Discretization<dim>> old =
        std::move(discretization);
      Compatibility::SolutionTransfer<dim, VectorType> transfer(
        old->dof_handler);
      const double lift_of_displacement = lift_above_rounding(displacement);
      const double lift_of_tractions    = lift_above_rounding(tractions);
      mesh->prepare_coarsening_and_refinement();
      const std::vector<const VectorType *> old_vectors = {&displacement,
                                                           &tractions};
      transfer.prepare_for_coarsening_and_refinement(old_vectors);
      mesh->execute_coarsening_and_refinement();
      old->dof_handler.distribute_dofs(old->fe);
      discretize();

      // Interpolated with the old object's new degrees of freedom, then
      // carried over to those of the new one, whose numbers may differ.
      VectorType u(old->dof_handler.locally_owned_dofs(), MPI_COMM_WORLD), t(u);
      std::vector<VectorType *> new_vectors = {&u, &t};
      transfer.interpolate(new_vectors);
      u.add(-lift_of_displacement);
      t.add(-lift_of_tractions);
      guess.reinit(discretization->constraints->partitioner());
      guess_tractions.reinit(guess);
      for (const auto &cell :
           discretization->dof_handler.active_cell_iterators())
        {
          const typename DoFHandler<dim>::active_cell_iterator old_cell(
            mesh.get(), cell->level(), cell->index(), &old->dof_handler);
          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int c = 0; c < dim; ++c)
              {
                guess(cell->vertex_dof_index(v, c)) =
                  u(old_cell->vertex_dof_index(v, c));
                guess_tractions(cell->vertex_dof_index(v, c)) =
                  t(old_cell->vertex_dof_index(v, c));
              }
        }
    }

    const Parameters                                           parameters;
    const Stiffening                                           stiffening;
    const Scene<dim>                                           scene;
    std::unique_ptr<parallel::distributed::Triangulation<dim>> mesh;
    std::unique_ptr<Discretization<dim>>                       discretization;
    unsigned int                                               level = 0;

    VectorType   guess, guess_tractions;
    VectorType   displacement, tractions;
    ContactState state = ContactState(0, false);
    SolverReport report;

    /// Of the last solution, by whatever settings.
    double        setup_seconds = 0, solve_seconds = 0;
    MultigridCost cost;

  private:
    void
    discretize()
    {
      discretization =
        std::make_unique<Discretization<dim>>(scene, *mesh, stiffening);
    }

    void
    mark()
    {
      const Discretization<dim> &d = *discretization;
      mark_by_maximum(*mesh,
                      estimate_contact_error(scene,
                                             d.mapping,
                                             d.dof_handler,
                                             d.hanging,
                                             *d.constraints,
                                             *d.contact,
                                             displacement,
                                             tractions)
                        .cell_errors,
                      parameters.refinement.marking);
      if (parameters.refinement.contact_zone)
        mark_contact_zone(d.dof_handler, *d.constraints, *d.contact, state);
    }
  };



  /** The points of all nodes, by node number. */
  template <int dim>
  std::vector<Point<dim>>
  node_points(const Discretization<dim> &d)
  {
    std::vector<Point<dim>> points(d.constraints->n_nodes());
    for (const auto &cell : d.dof_handler.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        points[d.constraints->node_of_dof(cell->vertex_dof_index(v, 0))] =
          cell->vertex(v);
    return points;
  }
} // namespace Tests

#endif

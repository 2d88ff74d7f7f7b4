#ifndef friction_discretization_discretization_h
#define friction_discretization_discretization_h

#include <common/discretization/contact_boundary.h>
#include <common/contact/contact_state.h>
#include <common/nodes/nodal_constraints.h>
#include <common/levels/level_hierarchy.h>
#include <common/scene/scene.h>
#include <common/discretization/discrete_problem.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <functional>
#include <memory>

namespace Friction
{
  using namespace dealii;

  /**
   * An empty mesh of the kind that the multigrid method needs: with a hierarchy
   * of levels on all processes, and levels of cells at a vertex that differ by
   * one at most.
   */
  template <int dim>
  std::unique_ptr<parallel::distributed::Triangulation<dim>>
  make_triangulation(const MPI_Comm communicator = MPI_COMM_WORLD);



  /**
   * A scene discretised on a given mesh by bilinear or trilinear elements:
   * degrees of freedom with their levels, constraints, the contact boundary,
   * the assembled stiffness matrix and forces, and the hierarchy of levels. A
   * solver takes hierarchy and problem():
   *
   * @code
   *   Discretization<dim> discretization(scene, mesh);
   *   VectorType          u     = discretization.admissible_start();
   *   ContactState        state = discretization.no_friction_yet();
   *   CoulombSolver<dim>  solver(*discretization.hierarchy,
   *                             discretization.problem(),
   *                             settings);
   *   solver.solve(u, state);
   * @endcode
   *
   * The mesh must outlive the object and must not be refined as long as the
   * object is used. All members are collective where the mesh is distributed.
   */
  template <int dim>
  class Discretization
  {
  public:
    /** By how many times the material is stiffer at a point than the scene
     * says, the same in all of a cell: that of its middle. */
    using Stiffening = std::function<double(const Point<dim> &)>;

    Discretization(const Scene<dim>         &scene,
                   const Triangulation<dim> &mesh,
                   const Stiffening         &stiffening = {});

    /** What solvers take: references to this object. */
    DiscreteProblem<dim> problem() const;

    /** Zero, but for prescribed values, and moved out of the obstacle. */
    VectorType admissible_start() const;

    /** A state of contact without normal forces, to start from. */
    ContactState no_friction_yet() const;

    DoFHandler<dim>                        dof_handler;
    MappingQ<dim>                          mapping;
    FESystem<dim>                          fe;
    AffineConstraints<double>              hanging;
    std::unique_ptr<NodalConstraints<dim>> constraints;
    NodeBlockMatrix<dim>                   matrix;
    VectorType                             forces;
    std::unique_ptr<ContactBoundary<dim>>  contact;
    std::unique_ptr<LevelHierarchy<dim>>   hierarchy;
    FrictionLaw                            friction_law;
    double                                 friction_coefficient;

  private:
    void assemble(const Scene<dim> &scene, const Stiffening &stiffening);

    DynamicSparsityPattern pattern;
  };
} // namespace Friction

#endif

#ifndef friction_discretization_discretization_h
#define friction_discretization_discretization_h

#include <common/discretization/contact_boundary.h>
#include <common/discretization/discrete_problem.h>
#include <common/discretization/elasticity.h>
#include <common/discretization/leaf_matrix.h>
#include <common/discretization/make_triangulation.h>
#include <common/nodes/leaf_operator.h>
#include <common/nodes/nodal_constraints.h>
#include <common/scene/scene.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>

#include <deal.II/lac/affine_constraints.h>

#include <memory>
#include <vector>

namespace Friction
{
  using namespace dealii;

  /**
   * The discrete problem on a mesh: a scene discretised by bilinear or
   * trilinear elements. It holds
   * - the degrees of freedom of the leaf mesh and of all levels, numbered node
   *   by node,
   * - hanging nodes as constraints of deal.II, which are condensed,
   * - what else is known about single nodes before any contact,
   *   NodalConstraints, prescribed components among it, whose rows stay in the
   *   matrix,
   * - the nodes that may get into contact, ContactBoundary,
   * - stiffness and loads, assembled.
   *
   * Solvers see of it what problem() refers to, with parameters from
   * read_parameters():
   * @code
   *   Scene<dim> scene(parameters);
   *   const auto mesh = make_triangulation<dim>();
   *   scene.make_coarse_mesh(*mesh);
   *
   *   Discretization<dim> discretization(scene, *mesh);
   *   discretization.set_up();
   *   discretization.assemble(elasticity<dim>(scene.materials()));
   *
   *   VectorType         u = discretization.vector();
   *   VectorType         no_tractions(u);
   *   ContactState       state = make_initial_guess(discretization, u,
   *                                                 no_tractions);
   *   ContactSolver<dim> solver(discretization, parameters.solver);
   *   SolverReport       report = solver.solve(u, state);
   *   discretization.interpolate_hanging_nodes(u);
   * @endcode
   *
   * Scene and mesh must outlive the object. After the mesh has been refined,
   * set_up() and assemble() make everything anew; see also refine_mesh(). All
   * functions are collective where the mesh is distributed.
   */
  template <int dim>
  class Discretization
  {
  public:
    /** Nothing is set up yet: the mesh may still be empty. */
    Discretization(const Scene<dim> &scene, const Triangulation<dim> &mesh);

    /** Distributes degrees of freedom on the present mesh, and finds
     * constraints and the contact boundary. */
    void set_up();

    /** Assembles stiffness and loads, once after each set_up().
     * @param bilinear_form  whose matrix has to be symmetric and positive
     *                       definite on the displacements that are prescribed
     *                       to be zero where something is prescribed. */
    void assemble(const CellForm<dim> &bilinear_form);

    /** Prescribed displacements are asked of the scene anew, which has moved a
     * platen. What was a solution is none any more. Collective. */
    void update_prescribed_values();

    /**
     * Has friction count slip from a displacement on, that of the end of an
     * earlier load step: until the next set_up() the law of friction is about
     * $u_T-s$, s being the tangential part of @p displacement at a contact
     * node. Normal contact, and all forces, remain those of u. Collective.
     * @param displacement  on this mesh; hanging nodes are interpolated.
     */
    void set_slip_origin(const VectorType &displacement);

    /** That displacement, with ghosts and hanging nodes; null in a first load
     * step. */
    const VectorType *
    slip_origin() const
    {
      return previous_displacement.get();
    }

    const Scene<dim> &
    scene() const
    {
      return the_scene;
    }

    const DoFHandler<dim> &
    dof_handler() const
    {
      return dofs;
    }

    /** Vertices are where the mesh has them, cells are (bi-, tri-)linear. */
    const Mapping<dim> &
    mapping() const
    {
      return the_mapping;
    }

    /** Interpolation at hanging nodes, and nothing else. */
    const AffineConstraints<double> &
    hanging_nodes() const
    {
      return hanging;
    }

    const NodalConstraints<dim> &
    constraints() const
    {
      return *nodal_constraints;
    }

    const ContactBoundary<dim> &
    contact() const
    {
      return *contact_boundary;
    }

    const LeafOperator<dim> &
    stiffness() const
    {
      return leaf_operator;
    }

    /** Nodal forces of body forces and given tractions. */
    const VectorType &
    loads() const
    {
      return forces;
    }

    /** What solvers take: references to this object, and the law of friction.
     * With Tresca's law the coefficient is 1, since what the scene gives is the
     * bound itself. Valid until the next set_up(). */
    const DiscreteProblem<dim> &
    problem() const
    {
      return *discrete_problem;
    }

    /** The diagonal of a box around the body. Collective. */
    double body_size() const;

    /** The largest trace of a diagonal block of the stiffness, a force per
     * length: with a displacement of the body it says what rounding leaves of
     * forces between nodes. Collective. */
    double largest_stiffness() const;

    /** A vector of zeros on the leaf mesh. */
    VectorType
    vector() const
    {
      return VectorType(nodal_constraints->partitioner());
    }

    /** Wall time of the last set_up() and the last assemble(). */
    double
    setup_seconds() const
    {
      return seconds_of_set_up + seconds_of_assembly;
    }

    /** Gives hanging nodes of @p v their values, and brings all ghosts that
     * deal.II knows up to date. */
    void interpolate_hanging_nodes(VectorType &v) const;

  private:
    const Scene<dim>         &the_scene;
    const Triangulation<dim> &mesh;
    const MappingQ<dim>       the_mapping;
    const FESystem<dim>       fe;
    DoFHandler<dim>           dofs;
    AffineConstraints<double> hanging;
    LeafOperator<dim>         leaf_operator;
    VectorType                forces;

    // From set_up() to assemble().
    std::unique_ptr<LeafAssembler<dim>> assembler;

    std::unique_ptr<NodalConstraints<dim>> nodal_constraints;
    std::unique_ptr<ContactBoundary<dim>>  contact_boundary;
    std::unique_ptr<DiscreteProblem<dim>>  discrete_problem;
    std::unique_ptr<VectorType>            previous_displacement;
    std::vector<double>                    face_measures;

    double seconds_of_set_up = 0, seconds_of_assembly = 0;

    void find_constraints();

    AffineConstraints<double> find_prescribed_values() const;

    void measure_faces();
  };
} // namespace Friction

#endif

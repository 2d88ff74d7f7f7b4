// @sect3{Include files}

// The first block is what any parallel adaptive program of the tutorial needs,
// step-40 for example; the only newcomer is the header of the Trilinos matrix
// that the stiffness matrix is gathered in.
#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <deal.II/numerics/vector_tools.h>

// The second block is the library that comes with this program. Each header is
// named after the one subject it has: what is modelled (<code>scene</code>),
// the contact boundary (<code>contact</code>), the levels and what is done on
// them (<code>multigrid</code>), the nonlinear iterations
// (<code>solvers</code>), where to refine (<code>estimate</code>), and what is
// written (<code>output</code>).
#include <common/compatibility.h>
#include <common/discretization/contact_boundary.h>
#include <common/nodes/nodal_constraints.h>
#include <common/discretization/volumetric_strain.h>
#include <common/estimate/contact_estimate.h>
#include <common/estimate/exact_error.h>
#include <common/estimate/marking.h>
#include <common/discretization/leaf_matrix.h>
#include <common/levels/level_hierarchy.h>
#include <common/discretization/node_numbering.h>
#include <common/output/checkpoint.h>
#include <common/output/level_records.h>
#include <common/output/run_output.h>
#include <common/program/command_line.h>
#include <common/program/version.h>
#include <common/parameters/parameters.h>
#include <common/scene/scene.h>
#include <common/algorithms/discretization_stop.h>
#include <common/algorithms/initial_guess.h>
#include <common/algorithms/safeguarded_solver.h>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace StepFriction2d
{
  using namespace dealii;
  using namespace Friction;

  // @sect3{The <code>ContactProblem</code> class}

  // The main class looks like that of step-40, with the same cycle of setting
  // up, assembling, solving, estimating and refining. Two things are different.
  //
  // First, the stiffness matrix is assembled by Trilinos, which knows how to
  // gather contributions from several processes, but then copied to a
  // <code>NodeBlockMatrix</code>: contact is a matter of nodes, not of single
  // degrees of freedom, and the solver below works with the $d\times d$ blocks
  // that couple two nodes.
  //
  // Second, there are two kinds of constraints, and they are kept apart.
  // Hanging nodes are condensed, as always. Prescribed displacements are not:
  // the rows of prescribed degrees of freedom stay in the matrix, so that
  // $Au-f$ is the nodal force at any node of the body, and the solver simply
  // leaves these components alone. The nodal forces on the contact boundary are
  // the unknowns we care about most.
  //
  // What you will not find in this class are the three things that the method
  // is about, and it is good to know from the start where they are. The
  // friction cone $|R_T(p)|\le\mathcal F\tau(p)$ is enforced node by node, in
  // the local problems (6.15) of the leading relaxation. Truncation happens
  // once per cycle, right after this relaxation, in the residual and the
  // matrices that the levels below the leaf mesh get to see. And a cycle costs
  // a fixed number of sweeps over the nodes, with no factorisation but that of
  // the coarsest mesh. All of it is behind the one call of
  // <code>SafeguardedSolver::solve()</code> in the function
  // <code>solve()</code>, and this is where we explain it.
  template <int dim>
  class ContactProblem
  {
  public:
    explicit ContactProblem(const Parameters &parameters);

    bool run(const Start start);

  private:
    // The functions in the order in which they are called. Everything up to
    // <code>solve()</code> is linear elasticity, plus knowledge of the
    // obstacle. <code>run()</code> says whether all levels could be solved.
    unsigned int make_first_mesh(const Start start);

    void setup_system();

    void assemble_system();

    void solve(const unsigned int level);

    ErrorEstimate estimate_error() const;

    bool mark_cells(const ErrorEstimate &estimate);

    void refine_mesh();

    void record_level(const unsigned int level, const ErrorEstimate &estimate);

    // What is modelled: the scene file as the user wrote it, and the functions,
    // boundary ids and obstacle it has been turned into.
    const Parameters parameters;
    const Scene<dim> scene;

    // The finite element space. The element is fixed to $Q_1$, and this is not
    // for convenience: the argument that a correction stays admissible on finer
    // levels needs interpolation weights between zero and one, which higher
    // degrees do not have.
    parallel::distributed::Triangulation<dim> triangulation;
    const MappingQ<dim>                       mapping;
    const FESystem<dim>                       fe;
    DoFHandler<dim>                           dof_handler;

    // The discrete problem, made anew for each mesh. The two kinds of
    // constraints are in the first two members: hanging nodes as an object of
    // deal.II, because they are condensed; all that is known about single nodes
    // before any contact, prescribed components among it, as an object of our
    // own.
    AffineConstraints<double>              hanging_node_constraints;
    DynamicSparsityPattern                 pattern;
    std::unique_ptr<NodalConstraints<dim>> nodal_constraints;
    std::unique_ptr<ContactBoundary<dim>>  contact_boundary;
    NodeBlockMatrix<dim>                   stiffness;
    VectorType                             forces;

    // The solution on the present mesh. Besides $u$ it includes the contact
    // state: flags that say which nodes touch and which of these stick, and the
    // nodal normal forces $\tau(p)$. They are not derived from $u$ but set by
    // the local problems, for after a rotation to the frame of a node and back
    // $u_n=g$ holds only up to rounding. The tractions, $R(p)/m_p$ at the nodes
    // in contact, are what the next mesh, the estimator and ParaView get to see
    // of the forces.
    VectorType                    displacement;
    VectorType                    tractions;
    std::unique_ptr<ContactState> state;
    SolverReport                  report;
    DiscretizationStop<dim>       stop;

    // Where results go: the console, <code>history.h5</code>, files for
    // ParaView, and checkpoints. The constructor creates the directory for
    // them, so that a run which cannot write anything fails in its first second
    // and not after its last level.
    RunOutput<dim> output;

    // Wall times of the present level. What is done once per mesh and what the
    // iteration takes are counted separately.
    double setup_seconds = 0.;
    double solve_seconds = 0.;
  };



  // @sect4{ContactProblem::ContactProblem}

  // Multigrid on locally refined meshes wants the levels of the triangulation
  // to have degrees of freedom of their own, hence
  // <code>construct_multigrid_hierarchy</code>. The other flag keeps cells that
  // share but a vertex within one level of each other. Our level matrices rely
  // on it: it makes each hanging node belong to exactly one level.
  template <int dim>
  ContactProblem<dim>::ContactProblem(const Parameters &parameters)
    : parameters(parameters)
    , scene(parameters)
    , triangulation(MPI_COMM_WORLD,
                    Triangulation<dim>::limit_level_difference_at_vertices,
                    parallel::distributed::Triangulation<
                      dim>::construct_multigrid_hierarchy)
    , mapping(1)
    , fe(FE_Q<dim>(1), dim)
    , dof_handler(triangulation)
    , stop(parameters.solver)
    , output(parameters, scene, std::cout, version(), MPI_COMM_WORLD)
  {}



  // @sect4{ContactProblem::make_first_mesh}

  // The mesh is a matter of the scene. The coarsest level is solved directly as
  // long as it is small, so it should be as coarse as the geometry allows; for
  // a large mesh from a file there is algebraic multigrid. Whatever else is
  // refined globally at the start only has the first level begin on a finer
  // mesh.
  //
  // A checkpoint holds refinements, not vertices. So the coarse mesh has to be
  // made in either case, and p4est then refines it as it was, and distributes
  // it over as many processes as there are now.
  template <int dim>
  unsigned int
  ContactProblem<dim>::make_first_mesh(const Start start)
  {
    scene.make_coarse_mesh(triangulation);
    if (start == Start::from_checkpoint)
      {
        const unsigned int level = output.load_checkpoint(triangulation);
        stop.add_estimate(output.last_level().estimated_error,
                          output.last_level().dofs);
        return level;
      }

    triangulation.refine_global(parameters.refinement.initial_refinements);
    return 0;
  }



  // @sect4{ContactProblem::setup_system}

  // <code>distribute_dofs</code> numbers the degrees of freedom of the leaf
  // mesh, <code>distribute_mg_dofs</code> those of each level. With
  // <code>FESystem(FE_Q(1), dim)</code> the $d$ degrees of freedom of a vertex
  // get consecutive numbers in either case, and that is all we need to speak of
  // nodes. <code>renumber_nodes</code> then makes nodes that are neighbours
  // neighbours in memory, too: it does not change the method, but lets its
  // relaxation sweeps run at the speed of the cache.
  template <int dim>
  void
  ContactProblem<dim>::setup_system()
  {
    dof_handler.distribute_dofs(fe);
    dof_handler.distribute_mg_dofs();
    renumber_nodes(dof_handler);

    const IndexSet &owned = dof_handler.locally_owned_dofs();
    const IndexSet  relevant =
      DoFTools::extract_locally_relevant_dofs(dof_handler);

    // The first kind of constraints: hanging nodes, and nothing else. They go
    // to the assembly below, where the rows and columns of these nodes are
    // distributed to their masters. In two dimensions none of them lies on
    // $\Gamma_S$; in three, one that does has no law of its own.
    hanging_node_constraints = Compatibility::make_constraints(owned, relevant);
    DoFTools::make_hanging_node_constraints(dof_handler,
                                            hanging_node_constraints);
    hanging_node_constraints.close();

    // The second kind: prescribed displacements. An object of the same class is
    // used to collect them, because <code>interpolate_boundary_values</code>
    // wants one, but it is never used for eliminating anything and does not
    // outlive this function.
    AffineConstraints<double> prescribed =
      Compatibility::make_constraints(owned, relevant);
    for (const auto &condition : scene.dirichlet_conditions())
      VectorTools::interpolate_boundary_values(mapping,
                                               dof_handler,
                                               condition.boundary_id,
                                               *condition.displacement,
                                               prescribed,
                                               condition.components);

    // A scene may pin single vertices, to keep a body that is only pushed from
    // drifting away: contact can hold it from one side only, and friction does
    // so only where it sticks, which nobody knows yet. The matrix has to be
    // positive definite without their help. Where a boundary condition
    // prescribes the same component already, it takes precedence.
    for (const auto &pinned : scene.pinned_points())
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int v : cell->vertex_indices())
            if (cell->vertex(v).distance(pinned.point) <
                1e-8 * cell->diameter())
              {
                const auto dof = cell->vertex_dof_index(v, pinned.component);
                if (!prescribed.is_constrained(dof))
                  {
                    prescribed.add_line(dof);
                    prescribed.set_inhomogeneity(dof, pinned.value);
                  }
              }
    prescribed.close();

    // The sparsity pattern of the stiffness matrix knows about hanging nodes
    // but not about prescribed displacements, whose rows and columns we keep.
    // We make it here, before there is a matrix, because with several processes
    // it says whose displacements a process needs to know: all that the rows of
    // its nodes couple to. Usually these are the nodes of its own cells and of
    // their neighbours, the locally relevant ones of step-40. But a row to
    // which a hanging node has been condensed reaches all cells around that
    // node, and one of them may be farther away.
    make_stiffness_pattern(dof_handler, hanging_node_constraints, pattern);

    // From here on we think in nodes. <code>NodalConstraints</code> keeps, for
    // each node, whether it hangs and which of its components are prescribed,
    // and it owns the layout of all vectors on the leaf mesh: node $i$ has the
    // local indices $di,\dots,di+d-1$, those of the process first and then
    // those that it only has copies of.
    nodal_constraints = std::make_unique<NodalConstraints<dim>>(
      dof_handler,
      hanging_node_constraints,
      prescribed,
      coupled_dofs(dof_handler, pattern));

    // Now for contact. The obstacle is rigid and known, so that all there is to
    // know about it are the nodes of the body that may touch it, the direction
    // in which each of them would do so, and how far it is away: the gap.
    // Displacements are supposed to be small: normals and gaps are those of the
    // undeformed body.
    //
    // Each contact node also gets the boundary measure that it stands for,
    // $m_p=\int_{\Gamma_S}\lambda_p$. This is where the dual multipliers are,
    // as far as a program has to know about them. Because of biorthogonality
    // (6.9) the coefficients of the boundary stress are nodal forces, and
    // friction is a sum over nodes (6.17); there is no mass matrix on the
    // boundary to assemble, and no multiplier among the unknowns. The solver
    // itself does not even need $m_p$. It is what turns forces into stresses,
    // for whoever wants those.
    contact_boundary = std::make_unique<ContactBoundary<dim>>(
      mapping,
      dof_handler,
      hanging_node_constraints,
      *nodal_constraints,
      scene.contact_boundary_id(),
      scene.obstacle(),
      scene.contact_normal(),
      scene.ignores_prescribed_penetration());
  }



  // @sect4{ContactProblem::assemble_system}

  // Assembly is that of linear elasticity, for friction and contact do not
  // appear in the stiffness matrix: they only restrict what the solution may do
  // at the nodes of the contact boundary. The bilinear form is
  // $a(u,v)=\int \lambda\, \mathrm{div}\,u\,\mathrm{div}\,v +
  // 2\mu\,\varepsilon(u):\varepsilon(v)$; written with the gradients $g_i$ of
  // the scalar shape functions of components $c_i$ its entries are
  // $\lambda\, \theta_i\theta_j + \mu\, g_{i,c_j} g_{j,c_i} +
  // \mu\,\delta_{c_ic_j} g_i\cdot g_j$, where
  // $\theta_i=\mathrm{div}\,\varphi_i=g_{i,c_i}$. Only if a scene says
  // <code>Material/Volumetric strain = mean</code>, because its material is
  // nearly incompressible, $\theta_i$ is the mean of the divergence over the
  // cell; see the introduction.
  template <int dim>
  void
  ContactProblem<dim>::assemble_system()
  {
    TrilinosWrappers::SparseMatrix matrix;
    matrix.reinit(dof_handler.locally_owned_dofs(),
                  dof_handler.locally_owned_dofs(),
                  pattern,
                  Compatibility::mpi_communicator(dof_handler));
    forces.reinit(nodal_constraints->partitioner());

    // For the stiffness, two quadrature points per direction are enough. Given
    // tractions are arbitrary expressions from a scene file and get some more.
    const QGauss<dim>     quadrature(fe.degree + 1);
    const QGauss<dim - 1> face_quadrature(fe.degree + 3);
    FEValues<dim>         fe_values(mapping,
                            fe,
                            quadrature,
                            update_values | update_gradients |
                              update_quadrature_points | update_JxW_values);
    FEFaceValues<dim>     face_values(mapping,
                                  fe,
                                  face_quadrature,
                                  update_values | update_quadrature_points |
                                    update_JxW_values);

    const unsigned int dofs_per_cell = fe.n_dofs_per_cell();
    const double       lambda        = scene.material().lambda();
    const double       mu            = scene.material().mu();

    Table<2, double>   theta;
    FullMatrix<double> cell_matrix(dofs_per_cell, dofs_per_cell);
    Vector<double>     cell_forces(dofs_per_cell);
    Vector<double>     load(dim);
    std::vector<types::global_dof_index> dof_indices(dofs_per_cell);
    std::vector<unsigned int>            component(dofs_per_cell);
    for (unsigned int i = 0; i < dofs_per_cell; ++i)
      component[i] = fe.system_to_component_index(i).first;

    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell_matrix = 0.;
          cell_forces = 0.;
          fe_values.reinit(cell);
          shape_volumetric_strains(fe_values, scene.material(), theta);
          for (const unsigned int q : fe_values.quadrature_point_indices())
            {
              const double JxW = fe_values.JxW(q);
              for (unsigned int i = 0; i < dofs_per_cell; ++i)
                {
                  const Tensor<1, dim> &g_i = fe_values.shape_grad(i, q);
                  for (unsigned int j = 0; j < dofs_per_cell; ++j)
                    {
                      const Tensor<1, dim> &g_j = fe_values.shape_grad(j, q);
                      double entry = lambda * theta(i, q) * theta(j, q) +
                        mu * g_i[component[j]] * g_j[component[i]];
                      if (component[i] == component[j])
                        entry += mu * (g_i * g_j);
                      cell_matrix(i, j) += entry * JxW;
                    }
                }
              if (scene.body_force() != nullptr)
                {
                  scene.body_force()->vector_value(
                    fe_values.quadrature_point(q), load);
                  for (unsigned int i = 0; i < dofs_per_cell; ++i)
                    cell_forces(i) +=
                      load[component[i]] * fe_values.shape_value(i, q) * JxW;
                }
            }

          // What the obstacle exerts is not among the loads. It is a reaction,
          // and will be found in $Au-f$.
          for (const unsigned int f : cell->face_indices())
            for (const auto &condition : scene.traction_conditions())
              if (cell->face(f)->at_boundary() &&
                  cell->face(f)->boundary_id() == condition.boundary_id)
                {
                  face_values.reinit(cell, f);
                  for (const unsigned int q :
                       face_values.quadrature_point_indices())
                    {
                      condition.traction->vector_value(
                        face_values.quadrature_point(q), load);
                      for (unsigned int i = 0; i < dofs_per_cell; ++i)
                        cell_forces(i) += load[component[i]] *
                          face_values.shape_value(i, q) * face_values.JxW(q);
                    }
                }

          // Hanging nodes are condensed in the matrix and in the loads alike.
          // If we had passed on prescribed displacements as well, as step-40
          // does, their rows would now be gone, and with them the reactions at
          // the nodes that are held.
          cell->get_dof_indices(dof_indices);
          hanging_node_constraints.distribute_local_to_global(
            cell_matrix, cell_forces, dof_indices, matrix, forces);
        }
    matrix.compress(VectorOperation::add);
    forces.compress(VectorOperation::add);

    // Trilinos has done its part; its matrix ends with this function. The copy
    // in $d\times d$ blocks has all that relaxing a node needs in one place.
    stiffness =
      make_node_block_matrix<dim>(matrix, pattern, *nodal_constraints);
    pattern.reinit(0, 0);
  }



  // @sect4{ContactProblem::solve}

  // Here the five parts of the method come together. What the solver is given
  // is the discrete problem, which is no more than references to what we have
  // set up, and the hierarchy of levels; from these it builds
  // 1. the energy that all others agree on (<code>TrescaFunctional</code>);
  // 2. the leading relaxation on the leaf mesh, which enforces contact and
  //    friction node by node (<code>MonotoneSmoother</code>);
  // 3. phases, truncation and derivatives of friction
  //    (<code>Linearization</code>, <code>Truncation</code>);
  // 4. one linear multigrid cycle for a correction (<code>CoarseCycle</code>,
  //    on the Galerkin products in <code>LevelMatrices</code>);
  // 5. recombination with the last step (<code>Recombination</code>), and
  //    projection to the admissible displacements that reverse the slip of no
  //    node and line search (<code>TrescaFunctional</code> again).
  //
  // <i>Where is the friction cone?</i> In part 2, and nowhere else.
  // When its turn comes, a contact node gets the displacement that minimises
  // the energy with all other nodes held, (6.15); this is
  // <code>MonotoneSmoother::relax_contact_node()</code>, and at its heart
  // <code>LocalProblem::solve()</code>. Unless the node can leave the obstacle
  // it has $u_n=g$, and the tangential force that would hold it at $u_T=0$ is
  // compared with $\mathcal F\tau(p)$. Below the bound the node sticks.
  // Otherwise it slides, with the force equal to the bound, (6.18). So right
  // after its turn a node satisfies its law, with this $\tau(p)$, exactly, and
  // violates it again as soon as a neighbour moves. With Algorithm 3 the bound
  // is taken from the intermediate iterate just before the node is relaxed,
  // (6.19). With Algorithm 2 it is fixed, and the whole iteration is repeated
  // until the forces it finds agree with those it was given, (6.11).
  //
  // <i>Where is truncation?</i> Between relaxation and coarse correction, at
  // the smoothed iterate, in <code>MonotoneMultigrid::correct()</code>. The
  // phase of a node decides which directions $T_p$ are left to coarse functions
  // (<code>Linearization::update()</code>): all at an open node, the tangent at
  // a sliding one, none at a sticking one. On these the energy is smooth, and
  // coarse levels solve the linear problem with the matrix $TAT$ (in two
  // dimensions friction adds nothing to it, for $|u_T|$ is piecewise linear).
  // Residuals are multiplied by $T$ before they go down
  // (<code>linearize_residual()</code>), corrections when they have come up,
  // and blocks of $A$ on their way to the levels
  // (<code>LevelMatrices::update()</code>). $A$ itself and the interpolation
  // between levels are not changed. The bounds (6.12) are used by the
  // <code>monotone</code> variant only; by default a correction may be as large
  // as it likes, and the line search deals with it.
  //
  // <i>What does a cycle cost?</i> By default
  // - three forward and three backward sweeps over the leaf mesh, contact nodes
  //   included, whose local problems are two scalar equations at most;
  // - one residual and one product with the matrix, for the line search; a
  //   second product if the obstacle cuts the correction off;
  // - six and six sweeps on the levels below, at nodes that touch a refined
  //   cell. Of these cells there are less than a third as many as active ones,
  //   in two dimensions, so that twelve sweeps are worth about four on the leaf
  //   mesh;
  // - rows of level matrices near nodes whose phase has changed, which after a
  //   few cycles is nowhere, and a solution on the coarsest mesh.
  //
  // Together this is the work of about a dozen sweeps over the leaf matrix,
  // whatever the number of unknowns, provided the coarsest mesh is small and
  // the cycle a V-cycle. (Memory sees fewer passes, since sweeps follow each
  // other through the cache.) A linear problem would save the local problems,
  // the line search and the updates: 13 percent of the solution of the Hertz
  // scene with 1.3 million unknowns, see <code>doc/benchmark.md</code>. For the
  // number of cycles we have measurements, see the results, but no theorem. For
  // Algorithm 3 not even convergence is proved.
  //
  // The coefficient of friction of Tresca's law is absorbed in the given
  // bounds, hence the 1 in the problem's last entry.
  template <int dim>
  void
  ContactProblem<dim>::solve(const unsigned int level)
  {
    Timer                     timer;
    const LevelHierarchy<dim> hierarchy(
      dof_handler, *nodal_constraints, stiffness);
    const bool tresca = scene.friction_law() == FrictionLaw::tresca;
    const DiscreteProblem<dim> problem = {
      stiffness,
      forces,
      *nodal_constraints,
      *contact_boundary,
      scene.friction_law(),
      tresca ? 1. : scene.friction_coefficient()};

    // The initial guess: what the coarser mesh has found, made admissible on
    // this one. Prescribed values are set, nodes that are inside the obstacle
    // are moved back along their normals, and the normal part of each traction
    // times $m_p$ becomes the force $\tau(p)$ that friction starts with. On the
    // first mesh everything is zero, and there is no friction before the first
    // normal force.
    state = std::make_unique<ContactState>(
      make_initial_guess(displacement,
                         tractions,
                         *nodal_constraints,
                         *contact_boundary,
                         problem.has_friction()));
    // With Tresca's law there is nothing to be guessed. The scene gives the
    // largest tangential stress, which times $m_p$ is the bound in (6.17). It
    // acts at all nodes of $\Gamma_S$, at open ones, too.
    if (tresca)
      for (unsigned int p = 0; p < contact_boundary->size(); ++p)
        state->set_normal_force(
          p,
          (*contact_boundary)[p].measure *
            scene.friction_bound()->value((*contact_boundary)[p].point));

    // What the constructor does is done once per mesh, so that we count it as
    // setup. The iteration stops when the increment over a cycle, in the energy
    // norm and relative to $u$, is at most the inner tolerance; the outer
    // tolerance is for $\varepsilon^k$ of Algorithm 2. Increments prove little,
    // for a method that stalls has small ones as well. So the solver then
    // computes $f-Au$ from scratch and with it the <i>certificate</i>: by how
    // much any node violates equilibrium, non-penetration, the sign of the
    // normal force, complementarity, the friction cone, or the direction of
    // slip, forces relative to the largest nodal force and lengths to the
    // largest displacement or gap. Without a small certificate
    // <code>report.converged</code> is false.
    //
    // All of this is done by <code>CoulombSolver</code>. The class used here is
    // its careful owner: when an iteration is getting nowhere, which much
    // friction or very long cells can bring about, it takes shorter steps, then
    // corrections that do without coarse levels, then Algorithm 2 with mixed
    // normal forces, and at last approaches the coefficient of friction from
    // below. What it had to do, the console says; in most scenes it is nothing.
    SafeguardedSolver<dim> solver(
      hierarchy, problem, stop.settings_for(dof_handler.n_dofs()));
    setup_seconds += timer.wall_time();

    timer.restart();
    report =
      solver.solve(displacement,
                   *state,
                   [&](const unsigned int cycle, const double increment) {
                     output.console().progress(level, cycle, increment);
                   });
    solve_seconds = timer.wall_time();

    // The iteration has not touched the values at hanging nodes, which we now
    // interpolate. The contact tractions are $R(p)/m_p=-r(p)/m_p$ with $r=f-Au$
    // the residual, at nodes where the state says that something is
    // transferred, and exactly zero elsewhere; what rounding leaves of $r$ at
    // open nodes must not look like a stress. Note that this is not
    // $\sigma(u_h)n$, which jumps from cell to cell and is less accurate.
    hanging_node_constraints.distribute(displacement);
    displacement.update_ghost_values();
    tractions = contact_tractions(
      report.residual, *nodal_constraints, *contact_boundary, *state);
    hanging_node_constraints.distribute(tractions);
    tractions.update_ghost_values();
  }



  // @sect4{ContactProblem::estimate_error}

  // On the contact boundary the estimator compares the stress of the finite
  // element solution with the contact tractions, which are known much better;
  // elsewhere it is the usual residual estimator of elasticity, with residuals
  // in the cells, jumps of the stress across faces, and the mismatch to given
  // tractions. For Coulomb friction this is a guide and not a theorem: the
  // proofs that we rely on are for contact without friction. Between the nodes
  // the laws of contact hold only approximately; what is missing there is
  // estimated as well.
  template <int dim>
  ErrorEstimate
  ContactProblem<dim>::estimate_error() const
  {
    return estimate_contact_error(scene,
                                  mapping,
                                  dof_handler,
                                  hanging_node_constraints,
                                  *nodal_constraints,
                                  *contact_boundary,
                                  displacement,
                                  tractions);
  }



  // @sect4{ContactProblem::mark_cells}

  // The estimator knows where the error in the energy norm comes from. Whoever
  // is after the contact stresses themselves may want more: a contact zone that
  // is resolved equally well all over, which is what the table of the thesis
  // has.
  template <int dim>
  bool
  ContactProblem<dim>::mark_cells(const ErrorEstimate &estimate)
  {
    if (parameters.refinement.strategy == RefinementStrategy::uniform)
      {
        triangulation.set_all_refine_flags();
        return true;
      }
    // All cells are marked whose indicator is at least a given fraction of the
    // largest. There is no coarsening, so that interpolation to the next mesh
    // loses nothing. If there is no error at all, nothing is marked and the run
    // is complete.
    bool any_marked = mark_by_maximum(triangulation,
                                      estimate.cell_errors,
                                      parameters.refinement.marking) > 0;
    // Optionally, every cell at the boundary with a vertex in contact is
    // refined besides. The zone of contact then has the same mesh width all
    // over, at a price: this is not optimal for the energy, and the mesh gets
    // coarse so quickly with depth that the pressure carries a slight ripple.
    if (parameters.refinement.contact_zone)
      any_marked |= mark_contact_zone(
        dof_handler, *nodal_constraints, *contact_boundary, *state);
    if (!any_marked)
      output.console().note(
        Utilities::MPI::sum(state->n_contact(), MPI_COMM_WORLD) > 0
          ? "Nothing is left to refine: there is no error."
          : "Nothing is left to refine: there is no error, and no node "
            "in contact. If there should be, start with a finer mesh.");
    return any_marked;
  }



  // @sect4{ContactProblem::refine_mesh}

  // Nested iteration: the displacement and the contact tractions are
  // interpolated to the refined mesh as they are. Tractions rather than nodal
  // forces, because a force belongs to a mesh, and halves when the mesh is
  // refined. The flags of contact and stick are not transferred: a node that
  // has come to lie at the obstacle or inside starts in contact, and the first
  // sweep decides anew.
  //
  // The guess is worth having: with it Algorithm 2 starts with a small first
  // change of the forces, and the number of cycles does not grow with the
  // level.
  template <int dim>
  void
  ContactProblem<dim>::refine_mesh()
  {
    Compatibility::SolutionTransfer<dim, VectorType> transfer(dof_handler);
    const double lift_of_displacement = lift_above_rounding(displacement);
    const double lift_of_tractions    = lift_above_rounding(tractions);
    triangulation.prepare_coarsening_and_refinement();
    const std::vector<const VectorType *> old_vectors = {&displacement,
                                                         &tractions};
    transfer.prepare_for_coarsening_and_refinement(old_vectors);
    triangulation.execute_coarsening_and_refinement();

    Timer timer;
    setup_system();
    setup_seconds = timer.wall_time();

    // Everything about the old mesh has been replaced; only the two vectors
    // arrive. They are not admissible yet, since new nodes on $\Gamma_S$ have
    // gaps of their own, and prescribed values need not be linear between old
    // nodes. <code>solve()</code> takes care of that.
    displacement.reinit(nodal_constraints->partitioner());
    tractions.reinit(nodal_constraints->partitioner());
    std::vector<VectorType *> new_vectors = {&displacement, &tractions};
    transfer.interpolate(new_vectors);
    displacement.add(-lift_of_displacement);
    tractions.add(-lift_of_tractions);
  }



  // @sect4{ContactProblem::record_level}

  // What is known at the end of a level: for the table on the console, for
  // <code>history.h5</code> which scripts can read, and for ParaView. A level
  // that has not converged is recorded as well, for one wants to see what it
  // looks like.
  //
  // <code>make_level_records()</code> turns nodal forces into pressures, sums
  // of forces and half-widths of zones. Some of what it finds deserves a word.
  // - The numbers of contact and sticky nodes count flags of the state, and are
  //   what table 6.1 of the thesis lists.
  // - The energy is $\hat J(u)$ of (6.8) at the final $\tau$. As $\tau$ and the
  //   shape of the body differ from mesh to mesh, it need not fall with the
  //   level. Within one Tresca problem it must never rise from cycle to cycle.
  //   With Algorithm 3 it may, as $\tau$ and with it the functional changes.
  // - Of each cycle we keep the relative increment, the energy of the smoothed
  //   iterate, the step length of the coarse correction (which may exceed one),
  //   the number of components that truncation has taken from coarse functions,
  //   and the norm of the truncated residual. Once phases have settled, the
  //   number of truncated components is constant, and the iteration is linear.
  // - <code>rho_tau</code> exists in the two versions that the introduction
  //   mentions, and is zero for Algorithm 3; <code>certificate</code> is the
  //   largest of its six violations.
  //
  // All of this is about the nodes of all processes. The history is rewritten
  // as a whole after each level and put in place by renaming. A run that is
  // killed leaves all levels that were complete.
  template <int dim>
  void
  ContactProblem<dim>::record_level(const unsigned int   level,
                                    const ErrorEstimate &estimate)
  {
    LevelRecords<dim> records     = make_level_records(level,
                                                   dof_handler,
                                                   *nodal_constraints,
                                                   *contact_boundary,
                                                   displacement,
                                                   *state,
                                                   report);
    records.level.estimated_error = estimate.total;
    records.level.setup_seconds   = setup_seconds;
    records.level.solve_seconds   = solve_seconds;

    output.add_level(records,
                     mapping,
                     dof_handler,
                     hanging_node_constraints,
                     displacement,
                     estimate.cell_errors);

    // Some scenes know their solution. Orders of convergence make sense if the
    // width of the mesh is halved everywhere; a patch test, whose solution is
    // linear, has none, for there a method without penalty is exact up to
    // rounding and the tolerance of the solver.
    if (scene.exact_displacement() != nullptr)
      output.add_exact_error(compute_exact_error(mapping,
                                                 dof_handler,
                                                 scene.material(),
                                                 *scene.exact_displacement(),
                                                 displacement),
                             parameters.refinement.strategy ==
                               RefinementStrategy::uniform);
  }



  // @sect4{ContactProblem::run}

  // The loop over levels. It ends when the mesh is fine enough, or when a level
  // could not be solved: then the certificate says by how much its last iterate
  // violates which law, and the program must not pretend otherwise.
  //
  // Before it starts, we compare the coefficient of friction with Eck's bound.
  // Above it we do not give up, since in practice many scenes have a solution
  // there. But this is not known, and if there are several, another algorithm
  // or another initial guess may legitimately lead elsewhere.
  //
  // Between two levels is the moment for a checkpoint, if the scene wants any:
  // a mesh and two vectors on it are all that the next level needs of those
  // before. <code>state</code> is not among it, for it will be made from the
  // tractions, and neither is anything of the multigrid method. What has been
  // recorded so far is added, so that a run continued with
  // <code>--restart</code> ends with the same table and the same files as if it
  // had never been interrupted. There is none after the last level, because
  // there is no mesh to go on with; whoever asks for more levels then starts
  // from the checkpoint before it and solves the last level once more.
  template <int dim>
  bool
  ContactProblem<dim>::run(const Start start)
  {
    if (!scene.warning().empty())
      output.console().warning(scene.warning());

    // The first guess is the undeformed body without any forces; on a coarse
    // mesh that is good enough. A run that is restarted has a better one: what
    // it had interpolated to this mesh when it was interrupted.
    const unsigned int first_level = make_first_mesh(start);
    Timer              timer;
    setup_system();
    setup_seconds = timer.wall_time();
    displacement.reinit(nodal_constraints->partitioner());
    tractions.reinit(nodal_constraints->partitioner());
    if (start == Start::from_checkpoint)
      Checkpoints::load_vectors(
        dof_handler, std::vector<VectorType *>{&displacement, &tractions});

    for (unsigned int level = first_level;; ++level)
      {
        timer.restart();
        assemble_system();
        setup_seconds += timer.wall_time();
        solve(level);

        // The estimate is needed for adaptive refinement, except on the last
        // level. By default it is computed there, too, because one wants to
        // know the error of what one has got.
        const bool last = level >= parameters.refinement.levels ||
          dof_handler.n_dofs() >= parameters.refinement.maximum_dofs;
        const bool adaptive =
          parameters.refinement.strategy == RefinementStrategy::adaptive;
        ErrorEstimate estimate;
        if (parameters.refinement.estimate_error || (adaptive && !last))
          estimate = estimate_error();
        // A solution that is better than its mesh is a waste of time. With
        // <code>Inner tolerance = discretisation</code> the next one will be
        // stopped when its own error is small compared with the error of the
        // mesh, and this is where we learn about the latter.
        stop.add_estimate(estimate.total, dof_handler.n_dofs());

        record_level(level, estimate);

        // A level without a certified solution is the end: what is wrong on
        // this mesh would only be interpolated to the next one. The certificate
        // tells which law is violated. By then everything has been tried that
        // the solver knows. If the first mesh is the one that fails, a coarser
        // one may give it a better guess to start from.
        if (!report.converged)
          {
            output.add_failure(level, report);
            return false;
          }
        if (last || !mark_cells(estimate))
          return true;
        refine_mesh();
        output.save_checkpoint(
          level + 1, triangulation, dof_handler, {&displacement, &tractions});
      }
  }
} // namespace StepFriction2d



// @sect3{The <code>main</code> function}

// A scene file, then entries of it that are to be different this time.
// Whatever is wrong with them is said in one sentence, and the exit status is
// part of the result; see <code>run_program()</code>.
int
main(int argc, char *argv[])
{
  return Friction::run_program(
    argc,
    argv,
    "step-friction-2d",
    "two",
    "hertz.prm 'Contact/Friction coefficient=0.05'",
    [](const Friction::Parameters &parameters, const Friction::Start start) {
      return StepFriction2d::ContactProblem<2>(parameters).run(start);
    });
}

// @sect3{Include files}

// What any parallel adaptive program of the tutorial needs, step-40 for
// example, has become little: degrees of freedom, constraints and matrices of a
// contact problem are the same in two and three dimensions, and belong to the
// library that comes with this program.
#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/table.h>
#include <deal.II/base/timer.h>

#include <deal.II/grid/tria.h>

#include <deal.II/fe/fe_values.h>

// The library's headers are named after the one subject each of them has, and
// its folders build on one another.
#include <common/algorithms/contact_solver.h>
#include <common/algorithms/discretization_stop.h>
#include <common/algorithms/force_control.h>
#include <common/algorithms/initial_guess.h>
#include <common/algorithms/load_steps.h>
#include <common/contact/contact_forces.h>
#include <common/contact/force_balance.h>
#include <common/discretization/discretization.h>
#include <common/discretization/mesh_refinement.h>
#include <common/discretization/volumetric_strain.h>
#include <common/estimate/contact_estimate.h>
#include <common/estimate/exact_error.h>
#include <common/estimate/marking.h>
#include <common/output/checkpoint.h>
#include <common/output/level_records.h>
#include <common/output/run_output.h>
#include <common/program/command_line.h>
#include <common/program/version.h>

#include <iostream>

namespace StepFriction2d
{
  using namespace dealii;
  using namespace Friction;

  // @sect3{The <code>ContactProblem</code> class}

  // The main class has the cycle of step-40, of setting up, assembling,
  // solving, estimating and refining. What is on one mesh, from degrees of
  // freedom to the assembled matrix, is an object of its own, the
  // <code>Discretization</code>. Two things about it are different from
  // step-40.
  //
  // First, contact is a matter of nodes, not of single degrees of freedom. With
  // <code>FESystem(FE_Q(1), dim)</code> the $d$ degrees of freedom of a vertex
  // have consecutive numbers, on the leaf mesh and on all levels, and the
  // stiffness matrix consists of the $d\times d$ blocks that couple two nodes.
  //
  // Second, there are two kinds of constraints, and they are kept apart.
  // Hanging nodes are condensed, as always. Prescribed displacements are not:
  // the rows of prescribed degrees of freedom stay in the matrix, so that
  // $Au-f$ is the nodal force at any node that does not hang, and the solver
  // leaves these components alone. The nodal forces on the contact boundary are
  // the unknowns we care about most.
  template <int dim>
  class ContactProblem
  {
  public:
    ContactProblem(const Parameters &parameters, const Start start);

    bool run();

  private:
    // The functions in the order in which they are called; <code>run()</code>
    // says whether all levels could be solved.
    unsigned int make_first_mesh();

    void assemble();

    void solve(const unsigned int level);

    bool mark_cells(const ErrorEstimate &estimate);

    void record_level(const unsigned int level, const ErrorEstimate &estimate);

    // What is modelled: the scene file as the user wrote it, and the functions,
    // boundary ids and obstacle it has been turned into. And whether this run
    // begins anew or goes on from a checkpoint.
    const Parameters parameters;
    Scene<dim>       scene;
    const Start      start;

    // A mesh with a hierarchy of levels, and the discrete problem on it, which
    // is made anew whenever the mesh is refined.
    const std::unique_ptr<Triangulation<dim>> triangulation;
    Discretization<dim>                       discretization;

    // The solution on the present mesh. Besides $u$ it includes the contact
    // state: flags that say which nodes touch and which of these stick, and the
    // nodal normal forces $\tau(p)$. The flags are set by the local problems
    // and not read off $u$, for after a rotation to the frame of a node and
    // back $u_n=g$ holds only up to rounding; $\tau(p)$ is the normal component
    // of the residual there. The tractions, $R(p)/m_p$ at the nodes in contact,
    // are what the next mesh, the estimator and ParaView get to see of the
    // forces.
    VectorType   displacement;
    VectorType   tractions;
    ContactState state;
    SolverReport report;

    // When the iteration may end, and where results go: the console,
    // <code>history.h5</code>, files for ParaView, and checkpoints.
    DiscretizationStop<dim> stop;
    RunOutput<dim>          output;

    // For scenes with given forces: a <i>platen</i> is a part of the boundary
    // that is moved as a whole until its reaction is the given force. And for
    // scenes with several load steps (<code>Load steps/Times</code>).
    ForceControl<dim> force_control;
    LoadSteps<dim>    load_steps;

    // Wall times of the present level. What is done once per mesh and what the
    // iteration takes are counted separately.
    double setup_seconds = 0.;
    double solve_seconds = 0.;
  };



  // @sect4{ContactProblem::ContactProblem}

  // To several processes <code>make_triangulation</code> gives a
  // <code>parallel::distributed::Triangulation</code> with two flags set.
  // Multigrid on locally refined meshes wants the levels to have degrees of
  // freedom of their own, hence <code>construct_multigrid_hierarchy</code>. The
  // other one, <code>limit_level_difference_at_vertices</code>, keeps cells
  // that share but a vertex within one level of each other. Otherwise a cell of
  // level 2 could meet one of level 4 there, and no level would have both nodes
  // of a block of the matrix. A run of one process that neither reads nor
  // writes checkpoints gets a plain <code>Triangulation</code>. It is refined
  // in the same way; in less than half of the time, unless new vertices on
  // curved surfaces take most of it.
  template <int dim>
  ContactProblem<dim>::ContactProblem(const Parameters &parameters,
                                      const Start       start)
    : parameters(parameters)
    , scene(parameters)
    , start(start)
    , triangulation(make_triangulation<dim>(MPI_COMM_WORLD,
                                            start == Start::from_checkpoint ||
                                              parameters.output.checkpoint))
    , discretization(scene, *triangulation)
    , state(0, false)
    , stop(parameters.solver)
    , output(parameters, scene, std::cout, version(), MPI_COMM_WORLD)
    , force_control(scene)
  {}



  // @sect4{ContactProblem::make_first_mesh}

  // The mesh is a matter of the scene. The coarsest level is solved directly
  // as long as it is small, so it should be as coarse as the geometry allows;
  // for a large mesh from a file there is algebraic multigrid.
  //
  // A checkpoint holds refinements, not vertices. So the coarse mesh has to be
  // made in either case, and p4est then refines it as it was, and distributes
  // it over as many processes as there are now. The initial guess is the
  // undeformed body without any forces, which on a coarse mesh is good enough,
  // or what had been interpolated to this mesh when the run was interrupted.
  // With several load steps <code>LoadSteps</code> says which vectors there are
  // besides, and has friction count slip from the end of the load step before;
  // <code>ForceControl</code> gets back the stiffness that it has learnt.
  template <int dim>
  unsigned int
  ContactProblem<dim>::make_first_mesh()
  {
    unsigned int level = 0;
    scene.make_coarse_mesh(*triangulation);
    if (start == Start::from_checkpoint)
      {
        const auto resumption = output.load_checkpoint(*triangulation);
        level                 = resumption.level;
        scene.begin_load_step(resumption.load_step);
        force_control.restore(resumption.platens);
        for (const LevelRecord &record : output.levels())
          {
            stop.add_level(record.error_at_least, record.dofs, record.pace);
            report.next_method = Method(record.next_method);
          }
      }
    else
      refine_uniformly(*triangulation,
                       parameters.refinement.initial_refinements);

    discretization.set_up();
    displacement = discretization.vector();
    tractions    = discretization.vector();
    if (start == Start::from_checkpoint)
      {
        Checkpoints::load_vectors(discretization.dof_handler(),
                                  load_steps.checkpoint_vectors(
                                    discretization, displacement, tractions));
        load_steps.resume(discretization);
      }
    output.check_start(discretization);
    return level;
  }



  // @sect4{ContactProblem::assemble}

  // The discretisation has found everything that belongs to single nodes
  // already: which of them hang, which components are prescribed, and the
  // contact boundary. About the latter, all there is to know are the nodes of
  // the body that may touch the obstacle, the direction in which each of them
  // would do so, how far it is away, and the boundary measure
  // $m_p=\int_{\Gamma_S}\lambda_p$ that it stands for; displacements are
  // supposed to be small, so that these are those of the undeformed body. There
  // is no mass matrix on the boundary to assemble, and no multiplier among the
  // unknowns: by biorthogonality (6.9) the coefficients of the boundary stress
  // are nodal forces.
  //
  // What remains to be said is the bilinear form. It is that of step-8, linear
  // elasticity, for friction and contact do not appear in the stiffness matrix:
  // they only restrict what the solution may do at the nodes of the contact
  // boundary. It is $a(u,v)=\int \lambda\, \mathrm{div}\,u\,\mathrm{div}\,v +
  // 2\mu\,\varepsilon(u):\varepsilon(v)$. All components of a displacement have
  // the same shape functions, one per vertex of a cell, so that we ask for the
  // gradients $g_a$ of these only, and compute for each pair of vertices the
  // $d\times d$ block $\lambda\,\theta_a\theta_b^T + \mu\, g_b g_a^T +
  // \mu\,(g_a\cdot g_b)\, I$. Its entry $(i,j)$ is what
  // <code>FESystem</code> would have for the pair of component $i$ of the one
  // and component $j$ of the other vertex; component $i$ of $\theta_a$ is the
  // divergence of the former, which is that of the gradient, $\theta_a=g_a$.
  // Only if a scene says <code>Material/Volumetric strain = mean</code>,
  // because its material is nearly incompressible, $\theta_a$ is the mean of
  // the gradient over the cell. Lam&eacute;'s constants belong to the cell,
  // too. Blocks above the diagonal follow from those below.
  //
  // The loop over cells, loads and hanging nodes do what those of step-40 do,
  // by blocks and with one exception that has been mentioned: prescribed values
  // are not eliminated, or their rows would be gone, and with them the
  // reactions at the nodes that are held.
  template <int dim>
  void
  ContactProblem<dim>::assemble()
  {
    const Tensor<2, dim>     unit = unit_symmetric_tensor<dim>();
    Table<2, Tensor<1, dim>> theta;

    discretization.assemble(
      [&](const FEValues<dim> &fe_values, CellBlocks<dim> &cell_blocks) {
        const Material &material = scene.materials().of(fe_values.get_cell());
        const double    lambda = material.lambda(), mu = material.mu();
        shape_volumetric_strains(fe_values, material, theta);
        for (const unsigned int q : fe_values.quadrature_point_indices())
          for (const unsigned int a : fe_values.dof_indices())
            {
              const Tensor<1, dim> g_a = fe_values.shape_grad(a, q);
              for (const unsigned int b : fe_values.dof_indices_ending_at(a))
                {
                  const Tensor<1, dim> g_b = fe_values.shape_grad(b, q);
                  cell_blocks(a, b) +=
                    (lambda * outer_product(theta(a, q), theta(b, q)) +
                     mu * outer_product(g_b, g_a) + mu * (g_a * g_b) * unit) *
                    fe_values.JxW(q);
                }
            }
      });
  }



  // @sect4{ContactProblem::solve}

  // Here the five parts of the method are made and put together. Before we look
  // at them one by one, this is what they do, with $r=f-Au$ and sweeps over the
  // nodes $p$ of the leaf mesh:
  //
  // @code
  //   sweep three times, tau(p) with it                        (part 2)
  //   repeat
  //     T, omega''  from the phases of the contact nodes       (part 3)
  //     B_k         from T (A + omega'') T, where it changed   (part 4)
  //     v           by a V-cycle for T (A + omega'') T v
  //                                  = T (r - omega'(u))
  //     u += alpha v  projected, with the best alpha           (parts 5, 1)
  //     sweep three times, and three times for the next cycle  (part 2)
  //   until the energy norm of the increment is small
  // @endcode
  template <int dim>
  void
  ContactProblem<dim>::solve(const unsigned int level)
  {
    // The initial guess: what the coarser mesh has found, made admissible on
    // this one. Prescribed values are set, nodes that are inside the obstacle
    // are moved back along their normals, and the normal part of each traction
    // times $m_p$ becomes the force $\tau(p)$ that friction starts with. On the
    // first mesh everything is zero, and there is no friction before the first
    // normal force. With Tresca's law (<code>Contact/Friction law =
    // Tresca</code>) the stress <code>Contact/Friction bound</code> times $m_p$
    // takes the place of $F\tau(p)$.
    Timer timer;
    state = make_initial_guess(discretization, displacement, tractions);

    // What all parts refer to: stiffness, loads, constraints and contact nodes,
    // and the law of friction. It is a copy, since continuation, one of the
    // safeguards, solves with smaller coefficients first.
    DiscreteProblem<dim> problem = discretization.problem();
    const SolverSettings settings =
      stop.settings_for(discretization.dof_handler().n_dofs());

    // <i>Part 1: the energy</i> $\hat J$ of (6.8), which the other parts agree
    // on.
    const TrescaFunctional<dim> functional(problem);

    // <i>Part 2: the leading relaxation.</i> This is where the friction cone
    // is, and in this iteration nowhere else; Newton's method for Coulomb's
    // law, one of the safeguards, has <code>SemismoothLaw</code> in its place.
    // <code>MonotoneSmoother::relax_contact_node()</code> gives a node the
    // displacement that minimises the energy with all other nodes held, (6.15),
    // and at its heart is <code>LocalProblem::solve()</code>. Right after its
    // turn a node satisfies its law, with this $\tau(p)$, exactly, and violates
    // it again as soon as a neighbour moves. With Algorithm 3 $\tau(p)$ is that
    // of (6.19); with Algorithm 2 it is fixed.
    const MonotoneSmoother<dim> smoother(problem, settings.local_solver);

    // <i>Part 3: phases, truncation, linearisation.</i> The phase of a node
    // decides which directions are left to coarse functions: all at an open
    // node, the tangent at a sliding one, none at a sticking one.
    Linearization<dim> linearization(problem, settings.truncation);

    // <i>Part 4: the coarse correction.</i> <code>Levels</code> has all that is
    // made once per mesh and kept up to date: the matrices $B_k$, their
    // relaxation, the solver of the coarsest one, and deal.II's
    // <code>MGTransferMatrixFree</code>, by which residuals come down and
    // corrections go up. Truncation is in the matrices and, once on the way
    // down and once on the way up, in the vectors of the leaf mesh; the
    // interpolation is not changed.
    Levels<dim> levels(
      discretization.dof_handler(), problem, settings.coarsest_method);
    const auto correction = make_correction(levels, problem, settings);

    // <i>Part 5: projection and line search</i>, along the best combination of
    // the correction and the step before.
    const auto step_control = make_step_control(functional, settings);

    // Put together, they are one step from a smoothed iterate to the next.
    // Parts 4 and 5 are base classes with several kinds; the others are one
    // class each.
    MonotoneMultigrid<dim> iteration(functional,
                                     smoother,
                                     linearization,
                                     *correction,
                                     *step_control,
                                     settings.smoothing_steps);

    // Around it is a loop that ends when the increment over a cycle, in the
    // energy norm and relative to $u$, is at most the inner tolerance.
    // Increments prove little, for a method that stalls has small ones as well.
    // So the solver then computes $f-Au$ from scratch and with it the
    // <i>certificate</i>, by how much any node violates its laws. Without a
    // small certificate <code>report.converged</code> is false.
    //
    // Should the iteration get nowhere, which much friction or very long cells
    // can bring about, <code>SafeguardedSolver</code> exchanges parts 3 to
    // 5, and then Algorithm 3 for others; levels and their matrices stay. What
    // it had to do, the console says; in most scenes it is nothing. What one
    // mesh needed, the next one begins with. Meshes of a few hundred unknowns
    // it solves without levels, by factors of all nodes but those near the
    // contact zone, unless the scene says <code>Condensation = where cycles are
    // many</code>; for the others <code>prepare()</code> makes the levels now,
    // so that they count as set-up.
    SafeguardedSolver<dim> solver(
      problem, levels, iteration, settings, report.next_method);
    solver.prepare(displacement, state);
    setup_seconds = discretization.setup_seconds() + timer.wall_time();

    // A scene may give the total force on a part of the boundary instead of its
    // displacement. Then <code>ForceControl</code> moves this part, compares
    // its reaction with the force, and solves again, roughly as long as the
    // reaction is far from what it should be; without such a part it solves
    // once.
    timer.restart();
    report = force_control.solve(
      discretization,
      displacement,
      state,
      settings,
      [&](const double accuracy) {
        return solver.solve(
          displacement,
          state,
          [&](const unsigned int cycle, const double increment) {
            output.console().progress(level, cycle, increment);
          },
          accuracy);
      });
    solve_seconds = timer.wall_time();

    // The iteration has not touched the values at hanging nodes, which we now
    // interpolate. The contact tractions are $R(p)/m_p$ at nodes where the
    // state says that something is transferred, and exactly zero elsewhere;
    // what rounding leaves of $R$ at open nodes must not look like a stress.
    tractions =
      contact_tractions(discretization.contact(), report.residual, state);
    discretization.interpolate_hanging_nodes(displacement);
    discretization.interpolate_hanging_nodes(tractions);
  }



  // @sect4{ContactProblem::mark_cells}

  // On the contact boundary the estimator compares the stress of the finite
  // element solution with the contact tractions, which are known much better;
  // elsewhere it is the usual residual estimator of elasticity, with residuals
  // in the cells, jumps of the stress across faces, and the mismatch to given
  // tractions. For Coulomb friction this is a guide and not a theorem: the
  // proofs that we rely on are for contact without friction.
  //
  // All cells are marked whose indicator is at least a given fraction of the
  // largest. There is no coarsening, so that interpolation to the next mesh
  // loses nothing.
  //
  // The estimator knows where the error in the energy norm comes from. For the
  // contact stresses themselves a scene may want a contact zone that is
  // resolved equally well all over, as in table 6.1 of the thesis:
  // <code>Refinement/Contact zone</code>.
  template <int dim>
  bool
  ContactProblem<dim>::mark_cells(const ErrorEstimate &estimate)
  {
    if (parameters.refinement.strategy == RefinementStrategy::uniform)
      {
        triangulation->set_all_refine_flags();
        return true;
      }
    bool any_marked = mark_by_maximum(*triangulation,
                                      estimate.cell_errors,
                                      parameters.refinement.marking) > 0;
    if (parameters.refinement.contact_zone)
      any_marked |= mark_contact_zone(discretization, state);
    if (!any_marked)
      output.nothing_to_refine(state);
    return any_marked;
  }



  // @sect4{ContactProblem::record_level}

  // What is known at the end of a level: for the table on the console, for
  // <code>history.h5</code> which scripts can read, and for ParaView. A level
  // that has not converged is recorded as well, to show what it looks like.
  //
  // <code>make_level_records()</code> turns nodal forces into pressures, sums
  // of forces and half-widths of zones, and keeps of each cycle its increment,
  // its energy, its step length and the number of components that truncation
  // has taken from coarse functions. The results say how to read them.
  // <code>output.add_level()</code> estimates from the last levels what the
  // errors of pressure, half-widths and forces are.
  // With <code>Output/Forces</code> there are reactions as well: the rows of
  // prescribed degrees of freedom are still in the matrix, for $Au-f$.
  //
  // The history is rewritten as a whole after each level and put in place by
  // renaming. A run that is killed leaves all levels that were complete.
  //
  // Some scenes know their solution. Orders of convergence make sense if the
  // width of the mesh is halved everywhere.
  template <int dim>
  void
  ContactProblem<dim>::record_level(const unsigned int   level,
                                    const ErrorEstimate &estimate)
  {
    LevelRecords<dim> records =
      make_level_records(level, discretization, displacement, state, report);
    records.level.estimated_error = estimate.total;
    records.level.error_at_least  = estimate.lower_bound;
    records.level.setup_seconds   = setup_seconds;
    records.level.solve_seconds   = solve_seconds;
    if (output.wants_forces())
      records.forces.push_back(
        {level, force_balance(discretization, report.residual)});
    output.add_level(
      records, discretization, displacement, estimate.cell_errors);

    if (scene.exact_displacement() != nullptr)
      output.add_exact_error(compute_exact_error(discretization.mapping(),
                                                 discretization.dof_handler(),
                                                 scene.materials(),
                                                 *scene.exact_displacement(),
                                                 displacement),
                             parameters.refinement.strategy ==
                                 RefinementStrategy::uniform &&
                               scene.load_step() == 0);
  }



  // @sect4{ContactProblem::run}

  // The loop over levels. It ends after <code>Refinement/Levels</code>
  // refinements or with <code>Refinement/Maximum dofs</code>, or when a level
  // could not be solved; its certificate says which law is violated.
  template <int dim>
  bool
  ContactProblem<dim>::run()
  {
    for (unsigned int level = make_first_mesh();; ++level)
      {
        assemble();
        solve(level);

        // The estimate is needed for adaptive refinement. By default it is
        // computed on the last level, too, to know the error of what has been
        // found. With <code>Inner tolerance = discretisation</code> the next
        // solution will be stopped when its own error is small compared with
        // that of the mesh, and this is where we learn about the latter. (In
        // later load steps, see below, the mesh is that of the first.)
        const bool last = scene.load_step() > 0 ||
          level >= parameters.refinement.levels ||
          discretization.dof_handler().n_dofs() >=
            parameters.refinement.maximum_dofs;
        const bool adaptive =
          parameters.refinement.strategy == RefinementStrategy::adaptive;
        ErrorEstimate estimate;
        if (parameters.refinement.estimate_error || (adaptive && !last))
          estimate =
            estimate_contact_error(discretization, displacement, tractions);
        stop.add_level(estimate.lower_bound,
                       discretization.dof_handler().n_dofs(),
                       report.pace);
        record_level(level, estimate);

        // A level without a certified solution is the end: what is wrong on
        // this mesh would only be interpolated to the next one. If the first
        // mesh fails, <code>Refinement/Initial refinements</code> may be
        // lowered: a coarser mesh is easier, and a better guess for this one.
        if (!report.converged)
          {
            output.add_failure(level, scene, report);
            return false;
          }
        if (last || !mark_cells(estimate))
          {
            // The last question: do all forces on the body balance? Each node
            // may be in equilibrium, and the whole not, where stresses are
            // lost among rounding errors.
            if (!output.check_solution(discretization, displacement, state))
              return false;
            if (scene.load_step() + 1 == scene.n_load_steps())
              {
                output.check_end(discretization, displacement, state);
                return true;
              }

            // A scene with a history (<code>Load steps/Times</code>) goes on
            // with the loads of the next time, on the same mesh. There friction
            // counts slip from the present displacement, and nothing else of
            // the method changes: the contact nodes know where they have been,
            // and all five parts ask them.
            load_steps.begin_next(
              scene, discretization, force_control, displacement, tractions);
            output.begin_load_step(discretization);
          }
        else
          // Nested iteration: the displacement and the contact tractions are
          // interpolated to the refined mesh as they are. Tractions rather than
          // nodal forces, because a force belongs to a mesh, and halves when
          // the mesh is refined. The flags of contact and stick are not
          // transferred; the first sweep decides anew. The guess is worth
          // having: with it the number of cycles does not grow with the level.
          refine_mesh(
            *triangulation, discretization, {&displacement, &tractions});

        // This is the moment for a checkpoint, if the scene wants any: a mesh
        // and two vectors on it are all that the next level needs of those
        // before, and in a later load step what the one before has come to, and
        // where the platens are if there are any. With what has been recorded
        // so far, a run continued with <code>--restart</code> ends with the
        // same files as any other.
        output.save_checkpoint(level + 1,
                               discretization,
                               load_steps.checkpoint_vectors(
                                 discretization, displacement, tractions),
                               force_control);
      }
  }
} // namespace StepFriction2d



// @sect3{The <code>main</code> function}

// A scene file, then entries of it that are to be different this time. The exit
// status is part of the result; see <code>run_program()</code>.
int
main(int argc, char *argv[])
{
  return Friction::run_program(
    argc,
    argv,
    {"step-friction-2d",
     "two",
     "hertz.prm 'Contact/Friction coefficient=0.05'"},
    [](const Friction::Parameters &parameters, const Friction::Start start) {
      return StepFriction2d::ContactProblem<2>(parameters, start).run();
    });
}

// @sect3{Include files}

// step-friction-2d has shown what a contact problem is made of: the
// discretisation, the five parts of a step, and the iteration over meshes. All
// of it is the same in three dimensions, and the library has it ready.
#include <deal.II/base/mpi.h>

#include <common/algorithms/discretization_stop.h>
#include <common/algorithms/nested_iteration.h>
#include <common/estimate/exact_error.h>
#include <common/output/checkpoint.h>
#include <common/output/level_records.h>
#include <common/output/run_output.h>
#include <common/program/command_line.h>
#include <common/program/version.h>

#include <iostream>

namespace StepFriction3d
{
  using namespace dealii;
  using namespace Friction;

  // @sect3{The <code>ContactProblem</code> class}

  // <code>NestedIteration</code> is the loop that the main class of
  // step-friction-2d consists of, cut into single calls: make a mesh, solve on
  // it, estimate, refine. What is left to a program is when to stop, what to
  // put out, and how to go on with a run that was interrupted. What is new in
  // three dimensions happens inside the library; each function below says where.
  template <int dim>
  class ContactProblem
  {
  public:
    explicit ContactProblem(const Parameters &parameters);

    bool run(const Start start);

  private:
    void begin(const Start start);

    void solve();

    void record(const ErrorEstimate &estimate);

    const Parameters        parameters;
    NestedIteration<dim>    nest;
    DiscretizationStop<dim> stop;
    RunOutput<dim>          output;
  };



  // @sect4{ContactProblem::ContactProblem}

  // It is in three dimensions that the flag
  // <code>limit_level_difference_at_vertices</code>, which
  // <code>NestedIteration</code> gives its mesh, is really needed. Without it,
  // masters of a hanging node might hang as well, and a hanging node might
  // belong to several levels. With it, level matrices are sums of blocks of the
  // leaf matrix, as in two dimensions.
  template <int dim>
  ContactProblem<dim>::ContactProblem(const Parameters &parameters)
    : parameters(parameters)
    , nest(parameters)
    , stop(parameters.solver)
    , output(parameters, nest.scene(), std::cout, version(), MPI_COMM_WORLD)
  {}



  // @sect4{ContactProblem::begin}

  // On the first mesh the body is undeformed. A checkpoint holds the
  // refinements of a mesh, by any number of processes, and the two vectors that
  // had been interpolated to it.
  //
  // In either case the discretisation then finds the nodes that may touch
  // (<code>ContactBoundary</code>). Several bilinear faces meet in a node, whose
  // normals all differ, and none of them is the right one; but the manifold that
  // has put the vertex there knows it: on the mantle of a cylinder it is exactly
  // radial. The two tangents may be turned in their plane at will, since
  // $|u_T|$ is the same in any frame. Where one of them is prescribed it comes
  // last, and <code>n_free_tangents</code> counts the others. A node that hangs
  // on the contact boundary has no law of its own: it follows its masters, and
  // hands its measure and its force on to them.
  template <int dim>
  void
  ContactProblem<dim>::begin(const Start start)
  {
    if (start == Start::anew)
      {
        nest.begin();
        return;
      }
    nest.scene().make_coarse_mesh(nest.mesh());
    nest.begin_on_level(output.load_checkpoint(nest.mesh()));
    Checkpoints::load_vectors(nest.discretization().dof_handler(),
                              nest.guess());
    stop.add_estimate(output.last_level().estimated_error,
                      output.last_level().dofs);
  }



  // @sect4{ContactProblem::solve}

  // The five parts are those of two dimensions, and <code>ContactSolver</code>
  // puts them together in the same way. Three of them have more to do.
  // - In the leading relaxation, the direction of slip of a node is unknown, and
  //   its local problem nonlinear: a scalar equation for a direction, solved by
  //   <code>SlipProblem</code>.
  // - At a sliding node friction turns with the slip, and resists:
  //   <code>Linearization</code> adds $\omega''_p$, a matrix of rank one, to the
  //   diagonal blocks that the level matrices are made of.
  // - The line search meets hyperbolas instead of parabolas with kinks
  //   (<code>TrescaFunctional::minimize_along()</code>).
  //
  // Most of the time is spent in sweeps over the leaf mesh. On a regular mesh a
  // row couples to 27 nodes by blocks of nine, 243 numbers for three unknowns.
  // To relax a contact node is not much dearer than any other, and contact
  // nodes are few, a surface in a body.
  template <int dim>
  void
  ContactProblem<dim>::solve()
  {
    VectorType         displacement;
    ContactState       state(0, false);
    const SolverReport report = nest.solve_with(
      stop.settings_for(nest.discretization().dof_handler().n_dofs()),
      displacement,
      state,
      [&](const unsigned int cycle, const double increment) {
        output.console().progress(nest.level(), cycle, increment);
      });
    nest.accept(displacement, state, report);
  }



  // @sect4{ContactProblem::record}

  // The records are those of two dimensions, but have to be read with care. The
  // numbers of contact and sticky nodes, listed in table 6.2 of the thesis for
  // another mesh, count nodes of a mesh and not areas, and hanging nodes are not
  // among them. The half-widths of the zones are radii of circles of the same
  // area. The tangential force is the norm of a sum of vectors, which cancel
  // where the scene is symmetric.
  template <int dim>
  void
  ContactProblem<dim>::record(const ErrorEstimate &estimate)
  {
    const Discretization<dim> &discretization = nest.discretization();
    LevelRecords<dim>          records =
      make_level_records(nest.level(),
                         discretization,
                         nest.displacement(),
                         nest.state(),
                         nest.report());
    records.level.estimated_error = estimate.total;
    records.level.setup_seconds   = nest.setup_seconds();
    records.level.solve_seconds   = nest.solve_seconds();
    output.add_level(
      records, discretization, nest.displacement(), estimate.cell_errors);
    if (const auto exact = nest.scene().exact_displacement())
      output.add_exact_error(
        compute_exact_error(discretization.mapping(),
                            discretization.dof_handler(),
                            nest.scene().material(),
                            *exact,
                            nest.displacement()),
        parameters.refinement.strategy == RefinementStrategy::uniform);
  }



  // @sect4{ContactProblem::run}

  // In scenes like <code>cylinder</code> marking meets the singularities at the
  // ends of the contact zone, where prescribed displacements and obstacle
  // contradict each other. A singularity is no reason for concern as such;
  // local refinement is there for resolving them. This one is different. As the
  // solution has infinite energy there, each halving of the cells brings about
  // as much new energy as the one before, and the estimator is right to find the
  // largest errors always in the same place. <code>Refinement/Contact
  // zone</code> refines all cells in contact besides, which is a surface: every
  // level has about four times as many nodes in contact as the one before.
  //
  // That <code>refine()</code> carries over stresses and not forces is even more
  // important than in two dimensions, for a force falls to a quarter if the mesh
  // is refined, and local refinement changes measures abruptly, too: where a
  // hanging node appears, its masters get a share of it.
  template <int dim>
  bool
  ContactProblem<dim>::run(const Start start)
  {
    if (const std::string warning = nest.scene().warning(); !warning.empty())
      output.console().warning(warning);
    begin(start);
    while (true)
      {
        solve();
        const bool needed = !nest.is_last() &&
          parameters.refinement.strategy == RefinementStrategy::adaptive;
        const ErrorEstimate estimate =
          needed || parameters.refinement.estimate_error ? nest.estimate() :
                                                           ErrorEstimate();
        stop.add_estimate(estimate.total,
                          nest.discretization().dof_handler().n_dofs());
        record(estimate);
        if (!nest.report().converged)
          {
            output.add_failure(nest.level(), nest.report());
            return false;
          }
        if (nest.is_last())
          return true;
        if (!nest.mark(estimate))
          {
            output.nothing_to_refine(nest.state());
            return true;
          }
        nest.refine();
        const std::vector<VectorType *> guess = nest.guess();
        output.save_checkpoint(nest.level(),
                               nest.mesh(),
                               nest.discretization().dof_handler(),
                               {guess.begin(), guess.end()});
      }
  }
} // namespace StepFriction3d



// @sect3{The <code>main</code> function}

// A scene file, and entries of it that are to be different.
int
main(int argc, char *argv[])
{
  return Friction::run_program(
    argc,
    argv,
    "step-friction-3d",
    "three",
    "cylinder.prm 'Contact/Friction coefficient=0.05'",
    [](const Friction::Parameters &parameters, const Friction::Start start) {
      return StepFriction3d::ContactProblem<3>(parameters).run(start);
    });
}

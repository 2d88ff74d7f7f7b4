// @sect3{Include files}

// step-friction-2d has shown what a contact problem is made of: the
// discretisation, the five parts of a step, and the iteration over meshes. All
// of it is the same in three dimensions, and the library has it ready as one
// object, <code>NestedIteration</code>.
#include <common/algorithms/nested_iteration.h>
#include <common/output/checkpoint.h>
#include <common/output/run_output.h>
#include <common/program/command_line.h>
#include <common/program/version.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

namespace StepFriction3d
{
  using namespace dealii;
  using namespace Friction;

  // <code>NestedIteration</code> is the loop that the main class of
  // step-friction-2d consists of, cut into single calls: make a mesh, solve on
  // it, estimate, refine. So this program has no class of its own, but four
  // functions: one for the first mesh, one for each mesh, one that looks at the
  // forces in the end, and the loop. What is new in three dimensions happens
  // inside the library; the functions say where.

  // @sect3{The first mesh}

  // On the first mesh the body is undeformed. A checkpoint holds the
  // refinements of a mesh and the two vectors that had been interpolated to it,
  // in a later load step what the one before has come to, and where platens are
  // (boundaries that are moved until their force is a given one) if there are
  // any; any number of processes may have written it, and any
  // other may read it.
  //
  // The discretisation then finds the nodes that may touch
  // (<code>ContactBoundary</code>). Several bilinear faces meet in a node,
  // whose normals all differ, and none of them is the right one. Either it is
  // that of the obstacle, or, with <code>Contact/Contact normal = body</code>,
  // that of the manifold which has put the vertex there: on the mantle of a
  // cylinder it is exactly radial. The two tangents may be turned in their
  // plane at will, since $|u_T|$ is the same in any frame. Where one of them is
  // prescribed it comes last, and <code>n_free_tangents</code> counts the
  // others. A node that hangs on the contact boundary has no law of its own: it
  // follows its masters, and hands its measure and its force on to them.
  void
  begin(NestedIteration<3> &nest, RunOutput<3> &output, const Start start)
  {
    if (start == Start::anew)
      nest.begin();
    else
      {
        nest.scene().make_coarse_mesh(nest.mesh());
        const auto resumption = output.load_checkpoint(nest.mesh());
        nest.begin_on_level(
          resumption.level, resumption.load_step, resumption.platens);
        Checkpoints::load_vectors(nest.discretization().dof_handler(),
                                  nest.checkpoint_vectors());
        nest.resume();
        for (const LevelRecord &record : output.levels())
          {
            nest.add_level(record.error_at_least, record.dofs, record.pace);
            nest.begin_with(Method(record.next_method));
          }
      }
    output.check_start(nest.discretization());
  }



  // @sect3{One mesh}

  // The five parts are those of two dimensions, and <code>ContactSolver</code>
  // puts them together in the same way. Three of them have more to do.
  // - In the leading relaxation, the direction of slip of a node is unknown,
  //   and its local problem nonlinear: a scalar equation for a direction,
  //   solved by <code>SlipProblem</code>.
  // - At a sliding node friction turns with the slip, and resists.
  //   <code>Linearization</code> computes $\omega''_p$, a matrix of rank one,
  //   and <code>LevelMatrices</code> adds it to the diagonal blocks of the leaf
  //   matrix that the level matrices are made of.
  // - The line search meets hyperbolas instead of parabolas with kinks
  //   (<code>TrescaFunctional::minimize_along()</code>).
  //
  // Most of the time is spent in sweeps over the leaf mesh. On a regular mesh a
  // row couples to 27 nodes by blocks of nine, 243 numbers for three unknowns.
  // To relax a contact node is not much dearer than any other, and contact
  // nodes are few, a surface in a body.
  //
  // The records of a level are those of two dimensions, but have to be read
  // with care. The numbers of contact and sticky nodes, listed in table 6.2 of
  // the thesis for another mesh, count nodes of a mesh and not areas, and
  // hanging nodes are not among them. The half-widths of the zones are radii of
  // circles of the same area.
  ErrorEstimate
  solve(NestedIteration<3> &nest, RunOutput<3> &output)
  {
    nest.solve([&](const unsigned int cycle, const double increment) {
      output.console().progress(nest.level(), cycle, increment);
    });

    ErrorEstimate estimate;
    if (nest.wants_estimate())
      estimate = nest.estimate();
    nest.learn(estimate);
    output.add_level(nest, estimate);
    return estimate;
  }



  // @sect3{The forces of the obstacle}

  // In space, forces on a body amount to six numbers: a force, and its moment
  // about some point, here the origin. The tangential force in the last line of
  // a run is the norm of a sum of vectors, which cancel where the scene is
  // symmetric, and says nothing about how much friction there is. The work of
  // friction,
  // $\omega(u)$, does: where a node slides, friction is opposite to its slip,
  // so that each of them adds $-R_T\cdot u_T=\mathcal F\tau\,|u_T|$, and nodes
  // that stick add nothing. In a later load step slip counts from the end of
  // the one before, and this is the work of the step.
  //
  // This is also an example of how to evaluate a solution. A process has its
  // own contact nodes, and each node its normal and the measure $m_p$ by which
  // tractions are turned into forces again; all that processes have to do
  // together is to add up. Components that are zero but for the tolerance of
  // the solver, those which cancel by symmetry for example, are printed as
  // zero; for the moment, the tolerance is that of a force times the longest
  // lever arm.
  std::string
  describe_forces(const NestedIteration<3> &nest)
  {
    const ContactBoundary<3> &contact = nest.discretization().contact();
    Tensor<1, 3>              force, moment;
    double                    lever = 0, work = 0;
    for (const ContactNode<3> &p : contact)
      {
        Tensor<1, 3> R, u;
        for (unsigned int d = 0; d < 3; ++d)
          {
            R[d] = p.measure * nest.tractions().local_element(3 * p.node + d);
            u[d] = nest.displacement().local_element(3 * p.node + d) -
              p.slip_origin[d];
          }
        const Tensor<1, 3> R_T = R - (R * p.normal()) * p.normal();
        force += R;
        moment += cross_product_3d(p.point, R);
        work -= R_T * u;
        lever = std::max(lever, p.point.norm());
      }
    const MPI_Comm processes =
      nest.discretization().constraints().communicator();
    force  = Utilities::MPI::sum(force, processes);
    moment = Utilities::MPI::sum(moment, processes);
    work   = Utilities::MPI::sum(work, processes);
    lever  = Utilities::MPI::max(lever, processes);

    std::ostringstream text;
    text.precision(4);
    const auto print = [&](const Tensor<1, 3> &vector, const double scale) {
      for (unsigned int d = 0; d < 3; ++d)
        text << (d == 0 ? "(" : ", ")
             << (std::abs(vector[d]) < 1e-6 * scale ? 0. : vector[d]);
      text << ")";
    };
    text << (nest.scene().n_contact_boundaries() > 1
               ? "Force of all obstacles on the body "
               : "Force of the obstacle on the body ");
    print(force, force.norm());
    text << ", moment about the origin ";
    print(moment, lever * force.norm());
    if (nest.state().has_friction())
      text << ", work of friction "
           << (nest.scene().n_load_steps() > 1 ? "in this load step " : "")
           << work;
    text << ".";
    return text.str();
  }



  // @sect3{The loop}

  // Solve, and as long as that works and a finer mesh is wanted, mark, refine,
  // and solve again. What <code>refine()</code> carries over are stresses and
  // not forces. This is even more important than in two dimensions, for a force
  // falls to a quarter if the mesh is refined, and local refinement changes
  // measures abruptly, too: where a hanging node appears, its masters get a
  // share of it.
  //
  // In scenes like <code>cylinder</code>, <code>mark()</code> meets the
  // singularities at the ends of the contact zone, where prescribed
  // displacements and obstacle contradict each other: the energies of the
  // discrete solutions grow without bound, and the estimator is right to find
  // the largest errors always in the same place. <code>Refinement/Contact
  // zone</code> refines all cells in contact besides.
  //
  // If the scene has a history (<code>Load steps/Times</code>), the later steps
  // are solved on the last mesh, each from what the one before has found.
  bool
  run(const Parameters &parameters, const Start start)
  {
    NestedIteration<3> nest(
      parameters, {}, MPI_COMM_WORLD, start == Start::from_checkpoint);
    RunOutput<3> output(
      parameters, nest.scene(), std::cout, version(), MPI_COMM_WORLD);

    begin(nest, output, start);
    ErrorEstimate estimate = solve(nest, output);
    while (nest.report().converged && !nest.is_last() && nest.mark(estimate))
      {
        nest.refine();
        output.save_checkpoint(nest);
        estimate = solve(nest, output);
      }
    if (nest.report().converged && !nest.is_last())
      output.nothing_to_refine(nest.state());
    bool is_solved = output.check_solution(nest);
    while (is_solved && nest.begin_next_load_step())
      {
        output.begin_load_step(nest.discretization());
        output.save_checkpoint(nest);
        solve(nest, output);
        is_solved = output.check_solution(nest);
      }

    if (is_solved)
      {
        output.check_end(
          nest.discretization(), nest.displacement(), nest.state());
        output.console().note(describe_forces(nest));
      }
    return is_solved;
  }
} // namespace StepFriction3d



// @sect3{The <code>main</code> function}

// A scene file, and entries of it that are to be different.
int
main(int argc, char *argv[])
{
  const Friction::Program program{"step-friction-3d",
                                  "three",
                                  "cylinder.prm "
                                  "'Contact/Friction coefficient=0.05'"};
  return Friction::run_program(argc, argv, program, StepFriction3d::run);
}

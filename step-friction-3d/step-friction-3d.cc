// @sect3{Include files}

// All header files are those of step-friction-2d. What is new in three
// dimensions happens inside the library, most of it in
// <code>contact/slip_problem.h</code>, <code>iteration/linearization.h</code>
// and <code>iteration/tresca_functional.h</code>.
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

namespace StepFriction3d
{
  using namespace dealii;
  using namespace Friction;

  // @sect3{The <code>ContactProblem</code> class}

  // This is the class of step-friction-2d, and its members and most of its
  // functions are the same. That program explains nodal forces, the state of
  // contact nodes, the five parts of a multigrid step, truncation, the two
  // algorithms and the certificate. Here we explain what three dimensions add,
  // each at the place in the program where it happens:
  // - The coarse mesh decides about more than its number of cells
  //   (<code>make_first_mesh()</code>).
  // - Nodes hang <i>on</i> the contact boundary (<code>setup_system()</code>).
  //   There are two tangents at each contact node, one of which may be
  //   prescribed, and there are scenes whose prescribed displacements
  //   contradict the obstacle (<code>setup_contact_boundary()</code>).
  // - A row of the stiffness matrix has three times as many blocks, and each of
  //   them is more than twice as large (<code>assemble_system()</code>).
  // - The direction of slip is unknown. This makes the local problems
  //   nonlinear, and friction gets a second derivative, with consequences for
  //   coarse matrices, the line search, and the guarantees that each kind of
  //   coarse correction comes with (<code>solve()</code>).
  // - Where an edge of the body meets the obstacle, the estimator may find
  //   nothing else worth refining (<code>mark_cells()</code>).
  template <int dim>
  class ContactProblem
  {
  public:
    explicit ContactProblem(const Parameters &parameters);

    bool run(const Start start);

  private:
    // The functions in the order in which they are called, one more than in two
    // dimensions.
    unsigned int make_first_mesh(const Start start);

    void setup_system();

    void setup_contact_boundary();

    void assemble_system();

    void solve(const unsigned int level);

    ErrorEstimate estimate_error() const;

    bool mark_cells(const ErrorEstimate &estimate);

    void refine_mesh();

    void record_level(const unsigned int level, const ErrorEstimate &estimate);

    // The scene, and the finite element space. $Q_1$ elements are essential to
    // the method, for the reason given in step-friction-2d: interpolation
    // weights have to lie between zero and one. In three dimensions this
    // includes the weights of hanging nodes, which are 1/2 in the middle of an
    // edge and 1/4 in the middle of a face.
    const Parameters parameters;
    const Scene<dim> scene;

    parallel::distributed::Triangulation<dim> triangulation;
    const MappingQ<dim>                       mapping;
    const FESystem<dim>                       fe;
    DoFHandler<dim>                           dof_handler;

    // The discrete problem on the present mesh. As in two dimensions hanging
    // nodes are condensed and prescribed displacements are not.
    AffineConstraints<double>              hanging_node_constraints;
    DynamicSparsityPattern                 pattern;
    std::unique_ptr<NodalConstraints<dim>> nodal_constraints;
    std::unique_ptr<ContactBoundary<dim>>  contact_boundary;
    NodeBlockMatrix<dim>                   stiffness;
    VectorType                             forces;

    // The solution. That a node sticks is a flag of the state and cannot be
    // read off $u_T$: a slip of $10^{-12}$ still has a direction, and the force
    // follows it.
    VectorType                    displacement;
    VectorType                    tractions;
    std::unique_ptr<ContactState> state;
    SolverReport                  report;
    DiscretizationStop<dim>       stop;

    // Where results go, and wall times.
    RunOutput<dim> output;

    double setup_seconds = 0.;
    double solve_seconds = 0.;
  };



  // @sect4{ContactProblem::ContactProblem}

  // It is in three dimensions that
  // <code>limit_level_difference_at_vertices</code> is really needed. Without
  // it, masters of a hanging node might hang as well, and a hanging node might
  // belong to several levels. With it, level matrices are sums of blocks of the
  // leaf matrix, as in two dimensions.
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

  // A mesh of a round body is refined by putting new vertices of the mantle on
  // the mantle, which the manifold of the boundary takes care of. This is not
  // enough to get good cells, and the scene <code>cylinder</code> lets you see
  // why. With <code>Scene/Coarse grid = one cell</code> it starts as in the
  // thesis, with a single hexahedron that has four of its edges on the mantle.
  // On each of these edges two faces of the same cell meet, and both of them
  // lie on the mantle. They meet at a right angle at first, and at a flatter
  // one after each refinement, because the mantle has no edge there. The angle
  // tends to 180 degrees, and the determinant of the Jacobian in this corner to
  // zero. The thesis attributes the growing numbers of cycles in its table 6.2
  // to these elements.
  //
  // By default the cylinder has an O-grid, a core surrounded by a ring of
  // cells. Each cell has at most one face on the mantle, and the cells of the
  // ring pass from the shape of the core to the circle by transfinite
  // interpolation. Their angles do not depend on how fine the mesh is. The
  // coarsest problem, which is solved directly, is larger; that is the better
  // bargain.
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

  // Degrees of freedom for the leaf mesh and for all levels, numbered node by
  // node and front by front. A front is a surface now, and fewer of them fit
  // into the cache.
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

    // Hanging nodes. In two dimensions they are inside the body. Here they lie
    // on the contact boundary as well, wherever the mesh gets finer along it,
    // and the question is what law such a node has. It has none of its own:
    // - Its displacement is interpolated from its masters. There is nothing to
    //   minimise, so that it is no contact node and gets no phase.
    // - Its row of $Au-f$ is condensed into those of its masters, with the
    //   weights of the interpolation. The forces of the obstacle at the
    //   masters, $R(p)$, include what the hanging node would have had.
    // - Its boundary measure goes to the masters with the same weights (see
    //   below). Therefore $R(p)/m_p$ is still a stress: with a constant
    //   pressure it is that pressure at all nodes, and the patch test is passed
    //   on locally refined meshes, too.
    //
    // The price is that $u_n\le g$ is required at the masters only. On a plane
    // obstacle and a plane boundary this is no restriction, for what is
    // interpolated from admissible values is admissible. On a curved boundary
    // the hanging node has a normal and a gap of its own, and may be found
    // inside the obstacle by an amount of second order in the width of the
    // mesh. But this is true for any point between two nodes, hanging or not:
    // the discrete set of admissible displacements is no subset of $\mathcal
    // K$. The estimator looks at what remains between nodes; the certificate
    // does not, for it is about the discrete law.
    hanging_node_constraints = Compatibility::make_constraints(owned, relevant);
    DoFTools::make_hanging_node_constraints(dof_handler,
                                            hanging_node_constraints);
    hanging_node_constraints.close();

    // Prescribed displacements, which stay in the matrix, and pinned vertices,
    // as in two dimensions.
    AffineConstraints<double> prescribed =
      Compatibility::make_constraints(owned, relevant);
    for (const auto &condition : scene.dirichlet_conditions())
      VectorTools::interpolate_boundary_values(mapping,
                                               dof_handler,
                                               condition.boundary_id,
                                               *condition.displacement,
                                               prescribed,
                                               condition.components);

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

    // From here on we think in nodes, those of the contact boundary in
    // particular. The sparsity pattern comes before the matrix since it tells
    // whose displacements a process has to know.
    make_stiffness_pattern(dof_handler, hanging_node_constraints, pattern);
    nodal_constraints = std::make_unique<NodalConstraints<dim>>(
      dof_handler,
      hanging_node_constraints,
      prescribed,
      coupled_dofs(dof_handler, pattern));

    setup_contact_boundary();
  }



  // @sect4{ContactProblem::setup_contact_boundary}

  // The nodes that may touch, each with a frame, a gap and a measure.
  //
  // <i>Normals and gaps.</i> Several bilinear faces meet in a node, their
  // normals all differ, and none of them is the right one. Vertices lie on the
  // true boundary, though, and the manifold that has put them there knows its
  // normal: on the mantle of a cylinder it is exactly radial. Along this normal
  // $n$ the gap to a rod of radius $r$ with axis through $c$ is the smaller
  // root of a quadratic equation; for a node $p$ with $|p|=R$ of a cylinder
  // around the origin, in the plane across the axes,
  // @f[
  //   g = (c\cdot n-R)-\sqrt{r^2-|c|^2+(c\cdot n)^2}.
  // @f]
  // A node whose normal looks past all rods, or meets one too flatly, can be
  // left out.
  //
  // <i>Frames.</i> The first vector is the normal. In two dimensions there was
  // one tangent, up to its sign; here the two tangents may be turned in their
  // plane at will, since $|u_T|$ is the same in any frame. This freedom is
  // needed as soon as a tangential component is prescribed. Take
  // <code>extruded-hertz</code>, which is the Hertz scene of two dimensions
  // continued in the direction of $z$. Its ends are planes of symmetry,
  // $u_z=0$, also where they meet the contact boundary. The frames of these
  // nodes are chosen such that the tangents that cannot move come last, and
  // <code>n_free_tangents</code> counts the others. With one free tangent and a
  // prescribed value of zero, the node has the local problem of two dimensions.
  // A prescribed component that has a part in normal direction would compete
  // with contact and is rejected.
  //
  // <i>Data that do not fit together.</i> The scene <code>cylinder</code> is
  // that of the thesis. A cylinder lies on two rods, and is pushed down by
  // holding its end faces at $u=(0,-0.01,0)$. The rims of the end faces belong
  // to the mantle as well, and a few nodes of them, in four spots, are
  // prescribed to be inside a rod. Their neighbours along the mantle must not
  // be. So along a short arc $u_n$ jumps, and a function with a jump along a
  // curve in the boundary only just fails to be the trace of a displacement
  // with finite energy, which grows like $\log(1/h)$. We do not want to get
  // into this by mistake: such nodes are an error in the scene, unless it says
  // <code>Contact/Ignore prescribed penetration = true</code>. Then they are
  // held as prescribed and, like all nodes that cannot move, are no contact
  // nodes.
  template <int dim>
  void
  ContactProblem<dim>::setup_contact_boundary()
  {
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

  // The elastic stiffness matrix and the loads, literally as in two dimensions.
  //
  // A word on size. On a regular mesh a node is coupled to the $3^d$ nodes of
  // the cells around it. In two dimensions that is nine blocks of four numbers;
  // in three it is 27 blocks of nine, 243 numbers for three unknowns. Reading
  // them is what everything below spends its time with. At the end of this
  // function there are two copies of the matrix, that of Trilinos and ours:
  // this is where the program needs most memory.
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

    // Two quadrature points per direction, eight per cell.
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

          // Given tractions. The force of the obstacle is not among them; we
          // look for it in $Au-f$.
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

          // Here forces and stiffness of hanging nodes go to their masters,
          // also on the contact boundary.
          cell->get_dof_indices(dof_indices);
          hanging_node_constraints.distribute_local_to_global(
            cell_matrix, cell_forces, dof_indices, matrix, forces);
        }
    matrix.compress(VectorOperation::add);
    forces.compress(VectorOperation::add);

    // The matrix of Trilinos ends with this function. What remains are
    // $3\times3$ blocks.
    stiffness =
      make_node_block_matrix<dim>(matrix, pattern, *nodal_constraints);
    pattern.reinit(0, 0);
  }



  // @sect4{ContactProblem::solve}

  // The five parts of a multigrid step, how Algorithm 3 updates $\tau$, and
  // what the certificate says, are as in step-friction-2d. Let us go through
  // the parts once more and see what becomes of them in three dimensions.
  //
  // <i>The local problem</i>, which enforces the friction cone
  // (<code>LocalProblem</code>, which calls <code>SlipProblem</code>). At a
  // contact node of the leading relaxation the energy (6.15) is minimised over
  // the displacement of this node alone. Its normal component is $z_n=g$,
  // unless it can leave the obstacle. In both cases there remains a problem in
  // the tangential plane,
  // @f[
  //   \tfrac12 v^TAv-b^Tv+s|v| \to \min,\qquad s=\mathcal F\tau(p),
  // @f]
  // with a $2\times2$ matrix $A$. If $|b|\le s$, then $v=0$, and the node
  // sticks. Otherwise it slips, and (6.18) reads $b-Av=s\,v/|v|$. In two
  // dimensions $v/|v|$ is one of two signs, which the force gives away. Now it
  // is a point of a circle: the boundary of the friction cone is curved, the
  // direction of slip is not that of $b$ unless $A$ is a multiple of the
  // identity, and the equation is nonlinear.
  //
  // In the eigenbasis of $A$ a scalar equation for the direction remains, with
  // close bounds to start from; the amount of slip then follows from a
  // quadratic equation without cancellation. The introduction derives both.
  // Four steps of an iteration of third order suffice for all of the problems
  // in <code>tests/contact/local_problem_3d.cc</code>. Tiny slips, on which
  // Newton's method for $v$ fails (Remark 6.6), are nothing special, since the
  // direction does not vanish with the slip. Nor are they for the method of
  // Uzawa that the thesis uses, <code>Solver/Local solver = Uzawa</code>; but
  // its number of steps grows with the condition number of $A$.
  //
  // <i>Linearisation and truncation</i> (<code>Linearization::update()</code>).
  // At a node that slides friction was a constant force in two dimensions. Now
  // $|u_T|$ is the length of a vector, and
  // @f[
  //   \omega''_p=\frac{\mathcal F\tau(p)}{|u_T|}
  //      \Big(I-\frac{u_Tu_T^T}{|u_T|^2}\Big)
  // @f]
  // on the tangential plane. Along the slip this is zero: to slip farther is
  // against the same force as before. Across it, it is a stiffness, because the
  // force turns with the slip, and resists. The matrix is of rank one, and
  // grows without bound when slip goes to zero, as it does at the edge of every
  // zone of stick. There a node can hardly be turned at all; a little farther
  // it sticks, and is truncated completely.
  //
  // The coarse levels solve the problem linearised at the smoothed iterate,
  // with the matrix $T(A+\omega'')T$ (constrained Newton linearisation).
  // $\omega''$ gets there with the diagonal blocks of the leaf matrix, before
  // the Galerkin products are formed. Two things need care:
  // - It changes with each iterate and at each sliding node. Taken literally,
  //   all rows near the contact zone would be computed anew in each cycle, on
  //   all levels. The library keeps $\omega''_p$ for as long as it is right
  //   within 10 % of itself and of the stiffness that it is added to. That will
  //   do, since the gradient is always exact and the matrices only serve to
  //   find a direction. When the iterates settle, updates cease.
  // - Infinity is no number. $\omega''_p$ is cut off at $10^8$ times the
  //   stiffness of the node, the mean of the diagonal of its block of $A$.
  //   Nothing turns there any more; more would only cost digits.
  //
  // What happens without $\omega''$ (Remark 6.7), and without the tangential
  // displacements of sliding nodes, can be tried with <code>Solver/Truncation =
  // phases without second order</code> and <code>contact</code>, together with
  // <code>Solver/Coarse correction = monotone</code>.
  //
  // <i>Line search and recombination.</i> Along a correction $v$ the energy
  // $\hat J(u+\alpha v)$ was a parabola plus a piecewise linear function. Now
  // it is a parabola plus a sum of $s|u_T+\alpha v_T|$, hyperbolas that are
  // convex and smooth as long as no node comes to rest. The quadratic model
  // knows only their curvature at $\alpha=0$. The line search does not use the
  // model. It finds the root of the derivative of the true energy, which never
  // decreases; each evaluation takes a few operations per contact node and no
  // product with the matrix.
  //
  // The recombination with the last step, in contrast, is about the model,
  // $\omega''$ included. While phases stay and $\omega''$ hardly changes, the
  // iteration behaves like the method of conjugate gradients. If the model is
  // poor, the combination is still only a direction for the line search.
  //
  // Before the line search, nodes that the correction would take back beyond
  // where they came from, $(u+v)_T\cdot u_T<0$, are stopped on the way, for the
  // model knows nothing of the kink there. A single one of them would hold up
  // all others. (This is done in two dimensions, too.)
  //
  // <i>Which guarantees remain?</i> With given $\tau$ and <code>Solver/Coarse
  // correction = truncated</code> the energy never rises, as in two dimensions,
  // because the line search sees to it. The bounds of <code>monotone</code>
  // keep corrections admissible, and keep sliding nodes from reversing their
  // slip. In two dimensions the energy is <i>quadratic</i> within these bounds,
  // so that lowering the model lowers the energy. In three it is not: where a
  // correction shortens a slip and turns it at once, the model underestimates
  // the energy, as the introduction shows. So <code>monotone</code>, which has
  // no line search, has no guarantee even for given $\tau$. It relies on the
  // relaxation to repair what went wrong, and on the certificate to tell.
  template <int dim>
  void
  ContactProblem<dim>::solve(const unsigned int level)
  {
    // The levels, and the discrete problem: references to what we have set up.
    // With the law of Tresca the coefficient is absorbed in the given bounds.
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

    // The initial guess: displacement and contact stresses of the coarser mesh,
    // made admissible on this one. New nodes of a curved contact boundary lie
    // outside of the face that they were interpolated from. Those that are
    // inside the obstacle are moved back along their own normals, which leaves
    // $u_T$ as it is.
    state = std::make_unique<ContactState>(
      make_initial_guess(displacement,
                         tractions,
                         *nodal_constraints,
                         *contact_boundary,
                         problem.has_friction()));
    // Tresca's law gives the bounds, at open nodes, too.
    if (tresca)
      for (unsigned int p = 0; p < contact_boundary->size(); ++p)
        state->set_normal_force(
          p,
          (*contact_boundary)[p].measure *
            scene.friction_bound()->value((*contact_boundary)[p].point));

    // What is needed once per mesh is computed here, and nearly all memory is
    // in place then. It goes into one matrix of $3\times3$ blocks on the leaf
    // mesh; the inverses of its diagonal blocks, one block per node; the level
    // matrices, in the same format and usually with fewer rows in all;
    // projectors, $\omega''$ and local problems with their eigenbases, at
    // contact nodes only; and about a dozen vectors of three numbers per node,
    // four of which belong to the recombination. What is due to contact and
    // friction is a small part of all this.
    SafeguardedSolver<dim> solver(
      hierarchy, problem, stop.settings_for(dof_handler.n_dofs()));
    setup_seconds += timer.wall_time();

    // In this call the time is spent, most of it in sweeps over the leaf mesh,
    // which read 27 blocks per node. To relax a contact node is not much dearer
    // than to relax any other. For both, a row of the matrix is multiplied with
    // $u$, and that product gives the normal force $\tau(p)$ of the
    // intermediate iterate along with the force $b$. With Algorithm 3 the bound
    // is taken from there and kept during the local problem: there is no inner
    // iteration for the local law of Coulomb. The frame, the Schur complement
    // and both eigenbases, that with the obstacle and that without, depend on
    // the diagonal block only and are computed once per mesh. What is left are
    // at most two scalar equations and some rotations. And contact nodes are
    // few, a surface in a body.
    //
    // The levels below are cheaper than in two dimensions: there is less than
    // one refined cell for seven active ones. The coarsest matrix is factorised
    // anew only when it has changed. All in all a cycle is some ten passes over
    // the leaf matrix, and updates while directions of slip settle.
    //
    // The call returns with the certificate. Two of its six numbers are about
    // vectors now: the tangential force must be inside a cone with a circular
    // section, and where a node slips, must be exactly opposite to the slip, in
    // direction as well as in size.
    timer.restart();
    report =
      solver.solve(displacement,
                   *state,
                   [&](const unsigned int cycle, const double increment) {
                     output.console().progress(level, cycle, increment);
                   });
    solve_seconds = timer.wall_time();

    // Hanging nodes get their displacements, and those on the contact boundary
    // also their tractions: they have no force, but the stress is interpolated
    // like any other field.
    hanging_node_constraints.distribute(displacement);
    displacement.update_ghost_values();
    tractions = contact_tractions(
      report.residual, *nodal_constraints, *contact_boundary, *state);
    hanging_node_constraints.distribute(tractions);
    tractions.update_ghost_values();
  }



  // @sect4{ContactProblem::estimate_error}

  // The residual estimator of step-friction-2d. On the contact boundary it
  // works with normals and gaps as fields, interpolated from the contact nodes,
  // at hanging nodes from their masters. What it finds between the nodes, a
  // distance under pressure or a missing work of friction, is where the laws
  // that hold at nodes only leave their trace. That includes friction which is
  // not opposite to the slip: between nodes whose directions of slip differ, it
  // cannot be so everywhere.
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

  // Marking is the same, but in scenes like <code>cylinder</code> it meets the
  // singularities at the ends of the contact zone, where prescribed
  // displacements and obstacle contradict each other. A singularity is no
  // reason for concern as such; local refinement is there for resolving them.
  // This one is different. As the solution has infinite energy there, each
  // halving of the cells brings about as much new energy as the one before, and
  // the estimator is right to find the largest errors always in the same place.
  // By the rule of the maximum it marks the four spots and next to nothing
  // else, for ever. A lower threshold only delays this, since what is wrong is
  // in the data and not in the mesh.
  //
  // With <code>Refinement/Contact zone = true</code> all cells in contact are
  // refined besides. The zone keeps one width of the mesh all over and is
  // resolved, however fine the spots at its ends get. It is a surface, so that
  // every level has about four times as many nodes in contact as the one
  // before, and cells near the surface soon make up most of the mesh.
  template <int dim>
  bool
  ContactProblem<dim>::mark_cells(const ErrorEstimate &estimate)
  {
    if (parameters.refinement.strategy == RefinementStrategy::uniform)
      {
        // Eight times as many cells.
        triangulation.set_all_refine_flags();
        return true;
      }
    // There is no coarsening, and nothing is marked if there is no error.
    bool any_marked = mark_by_maximum(triangulation,
                                      estimate.cell_errors,
                                      parameters.refinement.marking) > 0;
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

  // Nested iteration: displacement and tractions are interpolated. That we
  // carry over tractions and not forces is even more important than in two
  // dimensions, for a force is a stress times an area and falls to a quarter if
  // the mesh is refined. Local refinement changes measures abruptly, too: where
  // a hanging node appears, its masters get a share of it, and where it becomes
  // a node of its own, they lose it. Stresses know nothing of this.
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

    // The two vectors arrive on the new mesh; <code>solve()</code> makes them
    // admissible.
    displacement.reinit(nodal_constraints->partitioner());
    tractions.reinit(nodal_constraints->partitioner());
    std::vector<VectorType *> new_vectors = {&displacement, &tractions};
    transfer.interpolate(new_vectors);
    displacement.add(-lift_of_displacement);
    tractions.add(-lift_of_tractions);
  }



  // @sect4{ContactProblem::record_level}

  // The records are those of two dimensions. Some of them have to be read with
  // care:
  // - The counts of contact and sticky nodes, listed in table 6.2 of the thesis
  //   for another mesh, count nodes of a mesh and not areas. Hanging nodes are
  //   not counted. If the mesh is refined in part of the zone, ratios mean
  //   little.
  // - The half-widths of the zones of contact and stick are radii of circles of
  //   the same area. For two strips along two rods they are not more than a
  //   number that should converge.
  // - The tangential force is the norm of a sum of vectors. In symmetric scenes
  //   they cancel.
  // - When the number of truncated components is constant, phases have settled.
  //   In two dimensions the iteration is linear from there on; here $\omega''$
  //   goes on changing, less and less.
  // - In scenes with contradictory data the energy grows with the level.
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

    // The patch test <code>stick-slip</code> knows its solution. It is linear,
    // for a shear in any direction, and so the error is that of rounding and of
    // the solver's tolerance, whatever the mesh.
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

  // The loop over levels. Eck's bound is another one in three dimensions,
  // $\sqrt{1-\frac1{4(1-\nu)}}$, and smaller for positive Poisson ratios.
  template <int dim>
  bool
  ContactProblem<dim>::run(const Start start)
  {
    if (!scene.warning().empty())
      output.console().warning(scene.warning());

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

        // A level more may mean eight times the unknowns.
        const bool last = level >= parameters.refinement.levels ||
          dof_handler.n_dofs() >= parameters.refinement.maximum_dofs;
        const bool adaptive =
          parameters.refinement.strategy == RefinementStrategy::adaptive;
        ErrorEstimate estimate;
        if (parameters.refinement.estimate_error || (adaptive && !last))
          estimate = estimate_error();
        stop.add_estimate(estimate.total, dof_handler.n_dofs());

        record_level(level, estimate);

        // A level without a certificate ends the run.
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

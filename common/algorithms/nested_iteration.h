#ifndef friction_algorithms_nested_iteration_h
#define friction_algorithms_nested_iteration_h

#include <common/algorithms/contact_solver.h>
#include <common/algorithms/discretization_stop.h>
#include <common/algorithms/force_control.h>
#include <common/algorithms/load_steps.h>
#include <common/discretization/discretization.h>
#include <common/estimate/residual_estimator.h>

#include <deal.II/grid/tria.h>

#include <memory>

namespace Friction
{
  /**
   * A scene solved on one mesh after the other, each with the solution of the
   * one before as its initial guess: mesh, discretisation, solution, estimate
   * and refinement, one call at a time; and then, on the last mesh, for one
   * load step after the other. step-friction-2d does the same in view.
   *
   * All functions are collective.
   */
  template <int dim>
  class NestedIteration
  {
  public:
    /** No mesh is made yet.
     * @param bilinear_form    if it is not that of the scene's material.
     * @param from_checkpoint  whether the mesh is to be loaded. */
    explicit NestedIteration(const Parameters    &parameters,
                             const CellForm<dim> &bilinear_form = {},
                             const MPI_Comm       communicator = MPI_COMM_WORLD,
                             const bool           from_checkpoint = false);

    /** Makes the first mesh and discretises. The initial guess is zero. */
    void begin();

    /** Discretises on the mesh as it is, which the caller has made; it is
     * that of level @p level. The initial guess is zero; see guess().
     * @param load_step, platens  of a run that is continued: the load step to
     *   be solved, and ForceControl::checkpoint_numbers(). The caller then
     *   reads checkpoint_vectors(), guess included, and calls resume(). */
    void begin_on_level(const unsigned int         level,
                        const unsigned int         load_step = 0,
                        const std::vector<double> &platens   = {});

    /** What a checkpoint of this level has to hold, see
     * LoadSteps::checkpoint_vectors(). */
    std::vector<VectorType *>
    checkpoint_vectors()
    {
      return load_steps.checkpoint_vectors(
        the_discretization, guessed_displacement, guessed_tractions);
    }

    /** What has been read into checkpoint_vectors() is what the level begins
     * with. */
    void
    resume()
    {
      load_steps.resume(the_discretization);
    }

    const ForceControl<dim> &
    platens() const
    {
      return force_control;
    }

    /** Solves on this mesh with the settings of the parameters, not better than
     * the estimate of the mesh before makes sensible if they say so, and
     * accepts the solution. */
    const SolverReport &solve(const Progress &progress = {});

    /** The same with other settings, and leaves the iteration over the meshes
     * alone, but for the positions of platens with given forces: @p u and @p
     * state are set to the initial guess and then to the solution, hanging
     * nodes included. */
    SolverReport solve_with(const SolverSettings &settings,
                            VectorType           &u,
                            ContactState         &state,
                            const Progress       &progress = {});

    /** The initial guess of this mesh, made admissible. */
    ContactState make_guess(VectorType &u) const;

    /** Takes something as the solution on this mesh. */
    void accept(const VectorType   &u,
                const ContactState &state,
                const SolverReport &report);

    /** Whether the parameters want this mesh to have an estimate. */
    bool wants_estimate() const;

    /** Of the accepted solution. */
    ErrorEstimate estimate() const;

    /** For the next solution, if it is to be as good as the mesh makes
     * sensible: the estimate of this one, or an empty one, which makes the next
     * as good as the parameters say. */
    void learn(const ErrorEstimate &estimate);

    /** The same of all solutions before, in a run that is continued; see
     * DiscretizationStop::add_level(). */
    void add_level(const double                          error_at_least,
                   const dealii::types::global_dof_index n_dofs,
                   const double                          pace);

    /** What the next solution begins with, in a run that is continued;
     * otherwise that is SolverReport::next_method of the last one. */
    void
    begin_with(const Method method)
    {
      last_report.next_method = method;
    }

    /** Whether the parameters do not want a finer mesh than this; in later load
     * steps they never do. */
    bool is_last() const;

    /**
     * Flags cells for refinement as the parameters say.
     * @param estimate  of this mesh; only needed if refinement is adaptive.
     * @return whether there is anything to refine.
     */
    bool mark(const ErrorEstimate &estimate);

    /** Flags all cells. */
    void mark_all();

    /** Refines what is flagged, discretises anew, and interpolates the solution
     * to be the next guess. Until the next one is accepted there is no
     * displacement(), there are no tractions(), and report() has no residual:
     * those of the mesh before are gone. */
    void refine();

    /** All of that: goes on to the next mesh, unless this is the last one or
     * there is nothing to refine. */
    bool advance();

    /** Goes on to the next load step on this mesh, unless there is none, and
     * discretises anew; see LoadSteps. Its solutions continue the count of
     * levels. */
    bool begin_next_load_step();

    const Parameters &
    parameters() const
    {
      return the_parameters;
    }

    const Scene<dim> &
    scene() const
    {
      return the_scene;
    }

    Triangulation<dim> &
    mesh()
    {
      return *triangulation;
    }

    const Triangulation<dim> &
    mesh() const
    {
      return *triangulation;
    }

    const Discretization<dim> &
    discretization() const
    {
      return the_discretization;
    }

    /** The number of refinements of the first mesh and of load steps since
     * then. */
    unsigned int
    level() const
    {
      return the_level;
    }

    /** What has been interpolated to this mesh: displacement and contact
     * tractions. */
    std::vector<VectorType *>
    guess()
    {
      return {&guessed_displacement, &guessed_tractions};
    }

    /** The accepted solution, with ghosts of deal.II and hanging nodes. */
    const VectorType &
    displacement() const
    {
      return u;
    }

    /** Stresses on the contact boundary, likewise. */
    const VectorType &
    tractions() const
    {
      return contact_stresses;
    }

    const ContactState &
    state() const
    {
      return contact_state;
    }

    const SolverReport &
    report() const
    {
      return last_report;
    }

    /** Wall time: of the discretisation of this mesh and the last solver's
     * set-up on it, and of that solution. */
    double
    setup_seconds() const
    {
      return the_discretization.setup_seconds() + solver_setup_seconds;
    }

    double
    solve_seconds() const
    {
      return solution_seconds;
    }

  private:
    /** Whether the next mesh, or its solution, depends on an estimate. */
    bool needs_estimate() const;

    const Parameters    the_parameters;
    Scene<dim>          the_scene;
    const CellForm<dim> bilinear_form;

    std::unique_ptr<Triangulation<dim>> triangulation;
    Discretization<dim>                 the_discretization;
    DiscretizationStop<dim>             stop;
    ForceControl<dim>                   force_control;
    LoadSteps<dim>                      load_steps;
    unsigned int                        the_level = 0;

    VectorType   guessed_displacement, guessed_tractions;
    VectorType   u, contact_stresses;
    ContactState contact_state;
    SolverReport last_report;
    double       solver_setup_seconds = 0, solution_seconds = 0;
  };
} // namespace Friction

#endif

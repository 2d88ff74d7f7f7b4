#ifndef friction_output_run_output_h
#define friction_output_run_output_h

#include <common/algorithms/nested_iteration.h>
#include <common/estimate/exact_error.h>
#include <common/output/checkpoint.h>
#include <common/output/console.h>
#include <common/output/directory_lock.h>
#include <common/output/fields.h>
#include <common/output/history.h>
#include <common/output/left_overs.h>
#include <common/output/level_records.h>
#include <common/output/run_directory.h>
#include <common/output/verification_data.h>
#include <common/scene/scene.h>

#include <functional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

namespace Friction
{
  /**
   * All that a run puts out: the table on the console, `history.h5`, the fields
   * for ParaView, what friction-verify reads, and checkpoints. Which of these
   * are wanted, the parameters say.
   *
   * Unless stated otherwise, functions are collective operations, and an error
   * of one process is that of all.
   */
  template <int dim>
  class RunOutput
  {
  public:
    /**
     * Creates the output directory, so that a run which cannot write anything
     * fails in its first second and not after its last level, and locks it.
     *
     * @param out      where the console of the first process prints.
     * @param version  of the program.
     */
    RunOutput(const Parameters  &parameters,
              const Scene<dim>  &scene,
              std::ostream      &out,
              const std::string &version,
              const MPI_Comm     communicator);

    /** Whether the records of levels should have the forces on the body, see
     * force_balance(). */
    bool
    wants_forces() const
    {
      return parameters.output.forces ||
        !parameters.boundary_conditions.force.empty();
    }

    /** What should be known before the first solution: prints the warnings of
     * warnings_at_start(). */
    void check_start(const Discretization<dim> &discretization);

    /** Whether this is a solution, although each node obeys its law, see
     * check_solution(). If not, or if it is a poor one, says so. */
    bool check_solution(const Discretization<dim> &discretization,
                        const VectorType          &displacement,
                        const ContactState        &state);

    /** The same, or if a level could not be solved, what add_failure() says. */
    bool check_solution(const NestedIteration<dim> &nest);

    /** What should be known about the last solution: its quantities with their
     * errors, see set_errors(), its forces on the body if they have been
     * recorded, and the warnings of warnings_at_end(). */
    void check_end(const Discretization<dim> &discretization,
                   const VectorType          &displacement,
                   const ContactState        &state);

    /** Says that the next load step of a scene begins, after the quantities of
     * the one before, and prints those of warnings_about_loads() that have not
     * been true before. */
    void begin_load_step(const Discretization<dim> &discretization);

    /// For remarks and progress, by any process; only those of the first count.
    Console &console();

    /**
     * Put out what is known at the end of a level. The first level that a run
     * completes takes the place of what is there: files and checkpoints that
     * earlier runs have left in the directory are removed then. A run that has
     * been started from a checkpoint removes those of levels after its first.
     *
     * @param cell_errors  estimated errors of the active cells, or empty.
     */
    void add_level(const LevelRecords<dim>   &records,
                   const Discretization<dim> &discretization,
                   const VectorType          &displacement,
                   const Vector<float>       &cell_errors);

    /** The same of the solution that has been accepted on the mesh, with its
     * exact error if the scene knows its solution. */
    void add_level(const NestedIteration<dim> &nest,
                   const ErrorEstimate        &estimate);

    /**
     * A remark on the error of a solution that is known.
     *
     * @param with_order  compare it with that of the level before.
     */
    void add_exact_error(const ExactError &error, const bool with_order);

    /** Says why there is no finer mesh: no cell has any error. */
    void nothing_to_refine(const ContactState &state);

    /** Says why the run ends, also on a silent console: this level could not be
     * solved, in a history at the present time of the scene. */
    void add_failure(const unsigned int  level,
                     const Scene<dim>   &scene,
                     const SolverReport &report);

    /**
     * Write a checkpoint, if the parameters want any.
     *
     * @param next_level      the level that the mesh has been refined for, or
     *                        that the load step begins with.
     * @param discretization  on that mesh, in that load step.
     * @param vectors         see LoadSteps::checkpoint_vectors().
     * @param platens         of the scene.
     */
    void save_checkpoint(const unsigned int               next_level,
                         const Discretization<dim>       &discretization,
                         const std::vector<VectorType *> &vectors,
                         const ForceControl<dim>         &platens) const;

    /** The same for the mesh that has just been refined, or the load step that
     * has just begun. */
    void save_checkpoint(NestedIteration<dim> &nest) const;

    /** Where a run goes on. */
    struct Resumption
    {
      unsigned int        level     = 0;
      unsigned int        load_step = 0;
      std::vector<double> platens   = {}; ///< see ForceControl::restore()
    };

    /**
     * Start from the last checkpoint: refines the coarse mesh as it was,
     * and prints again what the run has printed until then. Throws an
     * InputError if there is none, if it belongs to another problem, or if the
     * run has already gone as far as the parameters want it to. The vectors are
     * read with Checkpoints::load_vectors().
     */
    Resumption load_checkpoint(Triangulation<dim> &triangulation);

    /// What has been recorded of each level, by this run and by the one that it
    /// continues.
    const std::vector<LevelRecord> &levels() const;

  private:
    void announce_load_step(const Scene<dim> &scene);

    /// Numbers that change if the coarse mesh does.
    static std::pair<double, unsigned int>
    fingerprint(const Triangulation<dim> &triangulation);

    /// What an earlier run has left, if this one began with the coarse mesh.
    void remove_other_run();

    /// What this run has left before it was continued with a level.
    void remove_levels_after(const unsigned int level);

    void remove_files(const std::function<bool(const RunFile &)> &is_left_over);

    const Parameters parameters;
    const MPI_Comm   communicator;

    RunDirectory          directory;
    DirectoryLock         lock;
    Console               the_console;
    History<dim>          history;
    FieldWriter<dim>      fields;
    VerificationData<dim> verification;
    Checkpoints           checkpoints;
    const unsigned int    groups; ///< a number for what sections speak of

    std::string           last_forces;        ///< as a sentence
    std::set<std::string> warned_about_loads; ///< LoadWarning::kind

    double last_exact_error = 0.;
    bool   restarted        = false;
    bool   any_level        = false; ///< since this run was started
  };
} // namespace Friction

#endif

#ifndef friction_output_history_h
#define friction_output_history_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/base/types.h>

#include <boost/serialization/vector.hpp>

#include <common/contact/force_balance.h>
#include <common/parameters/parameters.h>

#include <iosfwd>
#include <string>
#include <vector>

namespace Friction
{
  /**
   * What is kept of one level of the nested iteration: one value in each
   * dataset under `/levels`. Forces are those of the whole contact boundary, of
   * all its parts if there are several, in the units of the scene (2D: per unit
   * of thickness); and so are zones.
   */
  struct LevelRecord
  {
    unsigned int level = 0;

    /// The load step, from 1 on, and its time; see RunDescription.
    unsigned int load_step = 1;
    double       time      = 0.;

    unsigned int cells            = 0;
    unsigned int dofs             = 0;
    unsigned int contact_nodes    = 0;
    unsigned int sticky_nodes     = 0;
    unsigned int outer_iterations = 0;
    unsigned int cycles           = 0;

    /// How many methods the safeguards had to try; one if all was well.
    unsigned int attempts = 1;

    /// SolverReport::next_method, for a run that is continued.
    unsigned int next_method = 0;

    /// Mean contraction of the increments per cycle; zero if there was but one
    /// cycle. Where forces are given, that of the last solution for them.
    double contraction = 0.;

    /// SolverReport::pace, for a run that is continued.
    double pace = 0.;

    /// Algorithm 2: contraction of the relative changes of the normal forces,
    /// as the thesis prints it (their geometric mean), and per outer iteration.
    /// Zero for Algorithm 3.
    double rho_tau             = 0.;
    double rho_tau_contraction = 0.;

    /// The functional at the solution.
    double energy = 0.;

    /// Energy norm of the error of the iteration, extrapolated; without that
    /// of what is missing of given forces.
    double algebraic_error = 0.;

    /// Sum of the nodal normal forces, positive in compression.
    double normal_force = 0.;

    /// Norm of the sum of the nodal tangential force vectors.
    double tangential_force = 0.;

    /// Largest nodal contact pressure: nodal normal force over nodal measure.
    double max_pressure = 0.;

    /// Of the zones of contact and of stick. 2D: half of their measure. 3D: the
    /// radius of the circle of their area.
    double contact_half_width = 0.;
    double stick_half_width   = 0.;

    /// Estimated errors of these five, of the same units; negative if unknown.
    /// See set_errors().
    double normal_force_error       = -1.;
    double tangential_force_error   = -1.;
    double max_pressure_error       = -1.;
    double contact_half_width_error = -1.;
    double stick_half_width_error   = -1.;

    /// By how much the last three may be wrong because nodes are a distance
    /// apart. Pressure: the difference of the largest one and the mean of its
    /// neighbours. Widths: half of the measure of those nodes of the zone that
    /// have a neighbour outside.
    double pressure_resolution = 0.;
    double contact_resolution  = 0.;
    double stick_resolution    = 0.;

    /// Estimated error in the energy norm, and what it is at least: see
    /// ErrorEstimate.
    double estimated_error = 0.;
    double error_at_least  = 0.;

    /// Largest scaled residual of the discrete contact and friction laws.
    double certificate = 0.;

    double setup_seconds = 0.;
    double solve_seconds = 0.;

    /// For checkpoints, as in the structures below.
    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &level &load_step &time &cells                   &dofs;
      archive &contact_nodes                                   &sticky_nodes;
      archive &outer_iterations &cycles &attempts &next_method &contraction;
      archive &pace                                            &rho_tau;
      archive &rho_tau_contraction &energy &algebraic_error    &normal_force;
      archive                                   &tangential_force;
      archive &max_pressure &contact_half_width &stick_half_width;
      archive &normal_force_error               &tangential_force_error;
      archive &max_pressure_error               &contact_half_width_error;
      archive &stick_half_width_error           &pressure_resolution;
      archive &contact_resolution               &stick_resolution;
      archive &estimated_error &error_at_least  &certificate;
      archive &setup_seconds                    &solve_seconds;
    }
  };

  /**
   * What is kept of one multigrid cycle: one value in each dataset under
   * `/cycles`.
   */
  struct CycleRecord
  {
    unsigned int level       = 0;
    double       increment   = 0.;
    double       energy      = 0.;
    double       step_length = 0.;

    /// Number of degrees of freedom the coarse correction leaves out.
    unsigned int truncated = 0;
    double       residual  = 0.;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &level &increment &energy &step_length &truncated &residual;
    }
  };

  /**
   * What is kept of one outer iteration of Algorithm 2: one value in each
   * dataset under `/outer`.
   */
  struct OuterRecord
  {
    unsigned int level = 0;

    /// Relative change of the nodal normal forces.
    double change = 0.;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &level &change;
    }
  };

  /**
   * What is kept of one contact node: one row in each dataset under
   * `/contact/level_NN`, and one point of the boundary fields.
   */
  template <int dim>
  struct ContactRecord
  {
    /// First of the dim consecutive degrees of freedom of the node, not written
    /// to the file: with it the fields find the node on the mesh.
    dealii::types::global_dof_index dof = dealii::numbers::invalid_dof_index;

    dealii::Point<dim>     point;
    dealii::Tensor<1, dim> normal;
    double                 gap = 0.;
    dealii::Tensor<1, dim> displacement;

    /// Force of the obstacle on the body, $Au-f$: its product with the normal
    /// is negative in contact.
    dealii::Tensor<1, dim> force;

    /// Lumped measure of the boundary around the node.
    double measure = 0.;

    /// The largest tangential stress that friction allows here: the
    /// coefficient of friction times the pressure, or Tresca's bound.
    double friction_bound = 0.;

    /// 0 open, 1 sliding, 2 sticking.
    unsigned int state = 0;

    /// Of the section that is about it: 1 for 'Contact', 2 for 'Contact 2'.
    unsigned int section = 1;

    /// The tangential displacement that slip counts from, zero but in later
    /// load steps; not written to the file.
    dealii::Tensor<1, dim> slip_origin;

    /// By how much the node has slid along the obstacle: its tangential
    /// displacement if it is in contact, and zero if it is not. In a later load
    /// step, by how much it has done so in this step.
    dealii::Tensor<1, dim>
    slip() const
    {
      return state == 0
        ? dealii::Tensor<1, dim>()
        : displacement - (displacement * normal) * normal - slip_origin;
    }

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &dof &point &normal &gap &displacement &force &measure;
      archive &friction_bound &state &section               &slip_origin;
    }
  };

  /**
   * What is kept of one level if the scene wants to know the forces on the
   * body: one row in each dataset under `/forces`.
   */
  template <int dim>
  struct ForceRecord
  {
    unsigned int      level = 0;
    ForceBalance<dim> balance;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &level &balance;
    }
  };

  /** What a history says about its run besides the records. */
  struct RunDescription
  {
    std::string           scene;      ///< its name
    std::string           parameters; ///< the full text
    std::string           version;    ///< of the program
    Parameters::UnitNames units = {};

    unsigned int n_contact_boundaries = 1;

    /// Whether there are several load steps.
    bool has_load_steps = false;
  };

  /**
   * The protocol of a run, `history.h5`. After each level the file is written
   * completely anew and put in place by renaming, so a run that is killed
   * leaves everything up to its last complete level, and no run leaves a
   * damaged file.
   *
   * Root attributes: `scene`, `parameters` (the full text), `version`,
   * `dimension`. Datasets: the members of LevelRecord under `/levels` and those
   * of CycleRecord under `/cycles`, each one-dimensional; likewise those of
   * OuterRecord under `/outer` if Algorithm 2 was used; in `/contact/level_NN`
   * the datasets `point`, `normal`, `displacement`, `slip`, `force`
   * (nodes $\times$ dim) and `gap`, `measure`, `friction_bound`, `state`
   * (one-dimensional), and `section` if there are several contact boundaries, 2
   * for nodes of 'Contact 2'. A level without contact nodes has no group there,
   * since HDF5 through deal.II has no empty datasets; for the same reason
   * `/cycles` exists only once there was a cycle.
   *
   * With `Output/Forces` there are under `/forces` `level`, a dataset for each
   * of the forces on the body under its name (levels $\times$ dim), those of
   * obstacles with `_normal` (one-dimensional) and `_tangential` besides, see
   * ForceOnBody; and of all of them `sum` and `imbalance`.
   *
   * With several load steps `/levels` has `load_step` and `time` as well, the
   * number and the time of the step. The solutions of later steps, on the last
   * mesh of the first one, continue the count of levels. `/steps` then has the
   * same datasets as `/levels`, but only the values of the last solution of
   * each step.
   *
   * Each dataset has the attribute `label`, what it is in a few words, and
   * `units` if it has a unit with a name, see unit_of(). Those of
   * contact nodes have them on the last level, since each attribute takes as
   * long to write as a small dataset.
   *
   * Beside the file stands `levels.csv`, the table of `/levels` as text, a line
   * per level. Its first line has the names of the columns, with their units in
   * brackets.
   *
   * With several processes the first one keeps the records and writes the file;
   * what the others know has to be gathered by the caller.
   */
  template <int dim>
  class History
  {
  public:
    /**
     * @param file_name  where the file goes, say
     *                   `run_directory.file("history.h5")`.
     * @param description  what else is in it.
     * @param communicator  of all processes that call add_level().
     */
    History(const std::string    &file_name,
            const RunDescription &description,
            const MPI_Comm        communicator = MPI_COMM_SELF);

    /**
     * Take over the records of a level that is complete, and write the file.
     * The levels are expected in the order in which they are computed; the
     * cycles carry their own level. Of the forces there is one record, or none.
     * A collective operation, an error of the first process is that of all; its
     * records are the ones that count.
     */
    void add_level(const LevelRecord                     &level,
                   const std::vector<CycleRecord>        &cycles,
                   const std::vector<ContactRecord<dim>> &contact,
                   const std::vector<OuterRecord>        &outer  = {},
                   const std::vector<ForceRecord<dim>>   &forces = {});

    const std::vector<LevelRecord> &levels() const;

    /// All records, without what the constructor was given.
    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &level_records &cycle_records &outer_records &contact_levels;
      archive                                              &force_records;
    }

  private:
    struct ContactLevel
    {
      unsigned int                    level = 0;
      std::vector<ContactRecord<dim>> nodes;

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &level &nodes;
      }
    };

    void write_file() const;

    void write_hdf5(const std::string &name) const;

    void write_csv(std::ostream &out) const;

    /// A lower bound for the size of the file in bytes: that of its numbers.
    std::size_t payload() const;

    std::string    file_name;
    RunDescription description;
    MPI_Comm       communicator;

    std::vector<LevelRecord>  level_records;
    std::vector<CycleRecord>  cycle_records;
    std::vector<OuterRecord>  outer_records;
    std::vector<ContactLevel> contact_levels;

    std::vector<ForceRecord<dim>> force_records;
  };
} // namespace Friction

#endif

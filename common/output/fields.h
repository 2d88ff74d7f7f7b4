#ifndef friction_output_fields_h
#define friction_output_fields_h

#include <deal.II/base/data_out_base.h>
#include <deal.II/base/types.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/mapping.h>

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>

#include <boost/serialization/map.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <common/output/history.h>
#include <common/output/run_directory.h>
#include <common/output/vtu_file.h>
#include <common/parallel/vector_type.h>
#include <common/parameters/parameters.h>
#include <common/scene/materials.h>

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace Friction
{
  /** What there is to see on a level: references. */
  template <int dim>
  struct LevelFields
  {
    /// Of degree 1.
    const dealii::Mapping<dim>              &mapping;
    const dealii::DoFHandler<dim>           &dof_handler;
    const dealii::AffineConstraints<double> &hanging_nodes;

    /// Of that DoFHandler (FESystem of dim FE_Q(1)), with ghost values and
    /// hanging nodes interpolated.
    const VectorType &displacement;

    /// Estimated errors, one value per active cell; or nothing.
    const dealii::Vector<float> *cell_errors = nullptr;

    /// Likewise the displacement that slip counts from, or nothing.
    const VectorType *slip_origin = nullptr;

    /// What the level counts as in lists, which of two levels with the same
    /// time have the later one only; if not given, its number.
    std::optional<double> time = {};
  };



  /**
   * Writes what is to be looked at with ParaView: for every level the body with
   * its displacement and stress, and the possible contact boundary with the
   * contact stresses.
   *
   * Files, NN being the level: `body-NN.pvtu` and `contact-NN.pvtu` with one
   * `.vtu` piece per process, and `body.pvd`, `contact.pvd` over the levels,
   * which count as times; with several load steps, over these, each with the
   * fields of its last level and its own time. All files are written beside and
   * renamed. The mesh is written undeformed; ParaView's filter Warp By Vector
   * deforms it. Each vertex of a process's cells is one point, those that hang
   * included. Data have single, points double precision; nothing is compressed,
   * see write_vtu().
   *
   * Body: the vector `displacement` in the points, and in the cells the tensor
   * `stress`, which is symmetric and has the components XX, YY, ZZ, XY, YZ, XZ,
   * the numbers `von_Mises_stress`, and `principal_stress_1` to
   * `principal_stress_3` if they are wanted, the largest first, and
   * `estimated_error` if it is given. Stresses are those in the middle of the
   * cell: of the stresses of bilinear and trilinear elements, which jump
   * between cells, these are the most accurate. With VolumetricStrain::mean
   * their trace has that mean in it. ParaView's filter Cell Data to Point Data
   * averages them in the points. In 2D plane strain is assumed, from which the
   * third normal stress follows.
   *
   * Contact boundary: the vectors `displacement`, `traction` (of the obstacle
   * on the body), `tangential_traction`, `normal`, and `slip`, the tangential
   * displacement where there is contact, in a later load step what it has
   * changed by in this step; the numbers `pressure` (positive in
   * compression), `friction_bound` (what friction allows of
   * `tangential_traction`), `gap`, `distance` (gap minus normal displacement, 0
   * in contact) and `state` (0 open, 1 sliding, 2 sticking). Nodal tractions
   * are nodal forces over nodal measures. In 2D vectors get a third component
   * 0, as the format demands.
   *
   * With FieldFormat::hdf5 the body is written by all processes together, one
   * `body-NN.h5` per level, and ParaView opens `body.xdmf`, which describes all
   * of them. The numbers are the same, but that format of deal.II has points
   * for each cell of its own and no data of cells: those are repeated in the
   * cell's corners. In 2D the points have two coordinates, and all numbers take
   * the room of double precision. The components of `stress` are fields of
   * their own there, `stress_xx` and so on, those that are zero in 2D left out.
   * The contact boundary remains as above.
   */
  template <int dim>
  class FieldWriter
  {
  public:
    /**
     * @param directory        where the files go.
     * @param materials        from which stresses follow.
     * @param contact_boundary boundary ids of $\Gamma_S$.
     * @param format           of the files of the body.
     * @param principal_stresses  whether the body has these.
     */
    FieldWriter(const RunDirectory                         &directory,
                const Materials<dim>                       &materials,
                const std::set<dealii::types::boundary_id> &contact_boundary,
                const FieldFormat format             = FieldFormat::vtu,
                const bool        principal_stresses = false);

    /**
     * Write the fields of a level. A collective operation; an error of one
     * process is that of all.
     *
     * @param contact  the contact nodes that this process owns;
     *                 ContactRecord::dof must be set. If no process has any, no
     *                 boundary is written.
     */
    void write_level(const unsigned int                     level,
                     const LevelFields<dim>                &fields,
                     const std::vector<ContactRecord<dim>> &contact);

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &body_files &contact_files &body_entries &last_entry_time;
    }

  private:
    void write_body(const unsigned int level, const LevelFields<dim> &fields);

    void write_body_hdf5(const unsigned int      level,
                         const LevelFields<dim> &fields,
                         const VtuPiece         &piece);

    void write_contact_boundary(const unsigned int                     level,
                                const LevelFields<dim>                &fields,
                                const std::vector<ContactRecord<dim>> &contact);

    using TimesAndNames = std::vector<std::pair<double, std::string>>;

    static void add_to_list(TimesAndNames     &files,
                            const double       time,
                            const std::string &name);

    void write_piece(const std::string      &what,
                     const unsigned int      level,
                     const VtuPiece         &piece,
                     const LevelFields<dim> &fields,
                     TimesAndNames          &files);

    void remove_old_pieces(const std::string   &what,
                           const unsigned int   level,
                           const TimesAndNames &files,
                           const MPI_Comm       communicator) const;

    const RunDirectory                         directory;
    const Materials<dim>                       materials;
    const std::set<dealii::types::boundary_id> contact_boundary;
    const FieldFormat                          format;
    const bool                                 principal_stresses;

    TimesAndNames                  body_files;
    TimesAndNames                  contact_files;
    std::vector<dealii::XDMFEntry> body_entries;
    double last_entry_time = std::numeric_limits<double>::quiet_NaN();
  };
} // namespace Friction

#endif

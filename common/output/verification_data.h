#ifndef friction_output_verification_data_h
#define friction_output_verification_data_h

#include <common/discretization/discretization.h>
#include <common/output/history.h>
#include <common/output/run_directory.h>

#include <vector>

namespace Friction
{
  /**
   * Writes what a program that shares no code with this one needs to recompute
   * the discrete problem of a level, and to say whether its certificate is
   * true: `verify-NN.h5`, NN being the level, in double precision. Such a
   * program is `tests/verify/friction_verify.py`.
   *
   * What can be recomputed is not there: no stiffness, no nodal forces, no
   * gaps, no measures. Of loads, which may be arbitrary expressions, there are
   * values at points.
   *
   * Attributes of the file: `dimension`, `level`; `youngs_modulus` (stress),
   * `poisson_ratio`, `volumetric_strain` (`pointwise` or `mean`);
   * `contact_boundary` (boundary id, -1 for none), `contact_normal` (`body` or
   * `obstacle`), `friction_law` (`none`, `Tresca` or `Coulomb`),
   * `friction_coefficient` (zero where it varies). If there is a section
   * 'Contact 2', the same four with `_2` behind their names, and so on. With
   * several load steps `load_step` (from 1 on) and its `time`.
   *
   * Datasets, each node of the leaf mesh having the number of its row in
   * `vertices`. Those that would be empty are not there.
   *
   * - `vertices`: dim coordinates per node (length);
   * - `displacement`: dim components per node (length);
   * - `cells`: $2^{dim}$ nodes per cell; bit d of a node's place says at which
   *   end in direction d it is;
   * - `boundary_faces`: $2^{dim-1}$ nodes per face, in the same order;
   * - `boundary_ids`: one per boundary face;
   * - `hanging_nodes`: hanging node and master, a row per master;
   * - `hanging_weights`: the weight of that master;
   * - `prescribed`: node and component that are prescribed;
   * - `prescribed_values`: their displacements (length);
   * - `body_force`: dim components (stress/length) at the $2^{dim}$ Gauss
   *   points of order two of each cell;
   * - `traction_faces`: faces with a given traction, as in `boundary_faces`;
   * - `tractions`: dim components (stress) at the $4^{dim-1}$ Gauss points of
   *   order four of each of these faces;
   * - `contact_nodes`: the nodes that may touch;
   * - `contact_normals`: dim components of their unit normals;
   * - `contact_states`: 0 open, 1 sliding, 2 sticking;
   * - `contact_sections`: where there are several, the sections that they
   *   belong to, 1 for 'Contact', 2 for 'Contact 2', ...;
   * - `slip_origins`: in later load steps, the dim components of the tangential
   *   displacement that friction counts slip from (length);
   * - `friction_coefficients`: with Coulomb's law, their coefficients, where
   *   these vary;
   * - `friction_bounds`: with Tresca's law, their largest tangential stress;
   * - `plane_points`, `plane_normals`: a point of each plane, and the normal
   *   into the obstacle;
   * - `rod_centers`, `rod_axes`: a point of each rod, and the direction of its
   *   axis (zero in two dimensions);
   * - `rod_radii`, `rod_lengths`: lengths; one that is not positive is
   *   infinite. The same with `_2` is what 'Contact 2' may touch.
   *
   * Gauss points are numbered with the first coordinate of the cell or the face
   * running fastest. A scene that is turned is written as it has been turned.
   */
  template <int dim>
  class VerificationData
  {
  public:
    /** Nothing is written yet. */
    explicit VerificationData(const RunDirectory &directory);

    /**
     * Removes the file of a level: results that take the place of others must
     * not be compared with what these have left. To be called by one process.
     */
    void remove(const unsigned int level) const;

    /**
     * Gathers the discrete problem and its solution on the first process, which
     * writes the file beside its place and renames it. Collective; an error of
     * the first process is that of all.
     *
     * @param displacement  with ghosts and hanging nodes.
     * @param own_contact   records of the contact nodes that the calling
     *                      process owns.
     */
    void write_level(const unsigned int                     level,
                     const Discretization<dim>             &discretization,
                     const VectorType                      &displacement,
                     const std::vector<ContactRecord<dim>> &own_contact) const;

  private:
    const RunDirectory directory;
  };
} // namespace Friction

#endif

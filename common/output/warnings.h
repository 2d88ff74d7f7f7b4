#ifndef friction_output_warnings_h
#define friction_output_warnings_h

#include <common/contact/contact_state.h>
#include <common/discretization/discretization.h>
#include <common/parameters/parameters.h>

#include <string>
#include <vector>

namespace Friction
{
  /*
   * What is no error, but should be known before a solution is believed. All
   * functions are collective, and return the same sentences on all processes.
   */

  /** A warning about what may be otherwise in each load step. */
  struct LoadWarning
  {
    /// The same for sentences that differ in numbers only: one of them is
    /// enough.
    std::string kind;
    std::string sentence;
  };

  /** Those that depend on the time of the scene:
   * Scene::warning(), tractions where displacements are prescribed, and
   * displacements that contradict each other. */
  template <int dim>
  std::vector<LoadWarning>
  warnings_about_loads(const Discretization<dim> &discretization);

  /**
   * About the scene, the mesh and the contact boundary, before anything is
   * solved: what Parameters::warnings say, @p about_loads, which are those of
   * warnings_about_loads(), and
   * - where the coarse mesh is cut, see Seam, and parts that it consists of;
   * - materials for which elements lock, or which are so far apart that
   *   rounding errors of one are the stiffness of the other;
   * - edges of cells so short, or a body so far from the origin, that
   *   coordinates have lost digits;
   * - a contact boundary from a mesh file that is a polygon and stays one,
   *   however fine the mesh;
   * - a contact boundary of which no node faces the obstacle;
   * - nodes that lie inside the obstacle, on the contact boundary and on
   *   others.
   */
  template <int dim>
  std::vector<std::string>
  warnings_at_start(const Discretization<dim>      &discretization,
                    const Parameters               &parameters,
                    const std::vector<LoadWarning> &about_loads);

  /**
   * Regions of 'Material/Regions' whose material no cell of the mesh has.
   * @param which_mesh  as sentences call it, "first" or "last": cells of a
   * finer mesh may have it.
   */
  template <int dim>
  std::vector<std::string>
  warnings_about_regions(const Discretization<dim> &discretization,
                         const std::string         &which_mesh);

  /** How well what small displacements suppose is true of a solution. */
  struct ContactGeometry
  {
    /** Of one of the contact boundaries, over all processes. */
    struct OfBoundary
    {
      /// Nodes in contact.
      unsigned int n_contact = 0;

      /// Where gaps are measured along the normals of the body: the largest
      /// angle between that of a node in contact and the direction straight to
      /// the obstacle; degrees.
      double angle = 0;

      /// How far a node in contact is from the obstacle when it is displaced,
      /// outside or inside; a length. Nodes that no longer face it do not
      /// count.
      double distance = 0;

      /// How far another node of the body has moved, at most, relative to that
      /// node and along its normal; a length.
      double indentation = 0;
    };

    /// In the order of Scene::contact_conditions().
    std::vector<OfBoundary> boundaries;

    /// The largest displacement of all nodes, a length.
    double displacement = 0;

    /// The diameter of a box around the body, a length.
    double size = 0;
  };

  /**
   * @param displacement  with the numbering of the discretisation.
   */
  template <int dim>
  ContactGeometry contact_geometry(const Discretization<dim> &discretization,
                                   const VectorType          &displacement,
                                   const ContactState        &state);

  /**
   * About a solution:
   * - no cell has the material of a region, see warnings_about_regions();
   * - displacements or strains are not small;
   * - a boundary that is no contact boundary has gone into the obstacle;
   * - a pinned point bears a load;
   * and, for each of the contact boundaries,
   * - no node is in contact;
   * - normals of the body are used where they are not those of the obstacle, so
   *   that forces do not obey the law of friction;
   * - the body goes through the obstacle between nodes of which none touches
   *   it, by more than a tenth of the largest displacement;
   * - nodes in contact are not where the obstacle is.
   */
  template <int dim>
  std::vector<std::string>
  warnings_at_end(const Discretization<dim> &discretization,
                  const VectorType          &displacement,
                  const ContactState        &state);
} // namespace Friction

#endif

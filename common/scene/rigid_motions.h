#ifndef friction_scene_rigid_motions_h
#define friction_scene_rigid_motions_h

#include <common/scene/scene.h>

#include <deal.II/grid/tria.h>

#include <Eigen/Core>

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace Friction
{
  /**
   * The parts of a body: for each coarse cell of a mesh the number of its part.
   * Cells belong together if they share a face; a common vertex or edge is a
   * hinge, around which elasticity does not keep parts from turning.
   * @return the number of parts.
   */
  template <int dim>
  unsigned int find_parts(const Triangulation<dim>  &mesh,
                          std::vector<unsigned int> &part_of_cell);

  /**
   * Says whether a problem in unknown rigid motions is well posed, that is,
   * whether contact pressures can hold a body against its loads.
   *
   * A body that is not held otherwise has a motion m of some components m_i.
   * Its loads do the work L.m on it. The obstacle leaves it the motions with
   * B_p.m <= 0 at all nodes p, the columns of a matrix B being normal
   * displacements of a node by the components. The body stays where it is if
   * pressures lambda_p >= 0 balance the loads, L = B lambda; and if they do
   * not, the remainder m = L - B lambda of the best approximation is a motion
   * along which the load pushes, m.L > 0, and which no node stops, B_p.m <= 0
   * (Farkas' lemma). This is Fichera's condition for the existence of a
   * solution of Signorini's problem.
   *
   * A body that could be moved without any work, as a block on a plane can be
   * without friction, has more than one solution. There is none of these
   * motions if pressures can balance all loads in a neighbourhood of L.
   */
  struct Holding
  {
    /// A motion that nothing stops, empty if contact holds the body.
    Eigen::VectorXd motion;

    /// Whether the loads push the body along it.
    bool is_driven = false;
  };

  /**
   * @param loads    L, one value per component of the motion
   * @param contact  B, a column per node; may have none
   */
  Holding held_by_contact(const Eigen::VectorXd &loads,
                          const Eigen::MatrixXd &contact);

  /**
   * The vector in the cone of @p rays, a column for each, that is nearest to
   * @p v: their combination with coefficients that are not negative. It is zero
   * if all of them point away from v.
   */
  Eigen::VectorXd nearest_in_cone(const Eigen::VectorXd &v,
                                  const Eigen::MatrixXd &rays);

  /** A part of the body that prescribed displacements do not hold. */
  template <int dim>
  struct FreePart
  {
    /// Its number, as find_parts() gives them.
    unsigned int number;

    /// A basis of the rigid motions that are left, as columns; see motion_at().
    Eigen::MatrixXd motions;

    /// For sentences: a box around it, its coarse cells and those of the body,
    /// its physical ids and those of its boundary.
    Point<dim>                   lower, upper;
    unsigned int                 n_cells = 0, n_all_cells = 0;
    std::set<types::material_id> materials;
    std::set<types::boundary_id> boundary_ids;

    /// How many of its vertices cells of other parts have as well, and one of
    /// them.
    unsigned int n_joints = 0;
    Point<dim>   joint;

    /** What the motions do at a point: dim rows, a column for each. */
    Eigen::MatrixXd displacements_at(const Point<dim> &p) const;
  };

  /**
   * The parts of a body that boundary conditions leave a rigid motion; usually
   * none. What a platen controls holds a part only if an obstacle can resist.
   * @param mesh          whose coarse cells all processes know.
   * @param part_of_cell  on return as that of find_parts().
   */
  template <int dim>
  std::vector<FreePart<dim>>
  free_parts(const Scene<dim>          &scene,
             const Triangulation<dim>  &mesh,
             std::vector<unsigned int> &part_of_cell);

  /**
   * That a part is not held, as a sentence: the part, the motions, and what
   * would hold it.
   * @param is_stopped  whether the motion with such coefficients, of the basis
   *                    in the part, is stopped in both directions by contact.
   */
  template <int dim>
  std::string
  not_held(const Scene<dim>                                   &scene,
           const FreePart<dim>                                &part,
           const Holding                                      &holding,
           const std::function<bool(const Eigen::VectorXd &)> &is_stopped);

  /**
   * Throws InputError if a part of the body can be moved as a rigid one, and no
   * contact boundary could ever stop it. Where one could, loads and contact of
   * the discrete problem decide, see check_that_body_is_held().
   *
   * @param mesh  whose coarse cells all processes know.
   */
  template <int dim>
  void check_that_body_can_be_held(const Scene<dim>         &scene,
                                   const Triangulation<dim> &mesh,
                                   const std::string        &where);
} // namespace Friction

#endif

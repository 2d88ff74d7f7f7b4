#ifndef friction_scene_rigid_motions_h
#define friction_scene_rigid_motions_h

#include <common/scene/scene.h>

#include <deal.II/grid/tria.h>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace Friction
{
  /**
   * The parts of a body: for each cell of a mesh the number of its part. Cells
   * belong together if they share a face; a common vertex or edge is a hinge,
   * around which elasticity does not keep parts from turning.
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
   * Throws InputError if a part of the body can be moved as a rigid one, and
   * neither what is prescribed nor contact stops it: names the part, the motion
   * and what would hold it. Contact is judged with the normals, gaps and loads
   * of the coarse mesh, without friction.
   *
   * @param scene  with its boundary conditions and obstacle.
   * @param mesh   the whole coarse mesh, on this process.
   */
  template <int dim>
  void check_that_body_is_held(const Scene<dim>         &scene,
                               const Triangulation<dim> &mesh,
                               const std::string        &where);
} // namespace Friction

#endif

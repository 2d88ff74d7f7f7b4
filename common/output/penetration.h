#ifndef friction_output_penetration_h
#define friction_output_penetration_h

#include <common/contact/contact_state.h>
#include <common/discretization/discretization.h>
#include <common/scene/obstacle.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/point.h>

#include <array>
#include <utility>

namespace Friction
{
  /*
   * Where the body is inside the obstacle although the contact conditions of
   * its nodes are met: these are conditions at contact nodes, and say nothing
   * of other nodes or of what is between them. The functions that take
   * a discretisation, and largest(), are collective.
   */

  /** How deep, a length, and where in the undeformed body; nowhere if it is
   * zero. */
  template <int dim>
  using Depth = std::pair<double, Point<dim>>;

  /** The largest value of all processes, and its place. */
  template <int dim>
  std::pair<double, Point<dim>>
  largest(const MPI_Comm    communicator,
          const double      value,
          const Point<dim> &point)
  {
    std::array<double, dim + 1> own;
    own[0] = value;
    for (unsigned int d = 0; d < dim; ++d)
      own[d + 1] = point[d];
    std::pair<double, Point<dim>> result(value, point);
    for (const auto &other : Utilities::MPI::all_gather(communicator, own))
      if (other[0] > result.first)
        {
          result.first = other[0];
          for (unsigned int d = 0; d < dim; ++d)
            result.second[d] = other[d + 1];
        }
    return result;
  }



  /** Whether there is an obstacle and a boundary to touch it. */
  template <int dim>
  inline bool
  can_touch(const ContactCondition<dim> &condition)
  {
    return condition.has_boundary() && !condition.obstacle.empty();
  }



  /**
   * How far a point is inside the obstacle, straight from its surface; negative
   * outside, and zero where there is no such distance, or where the function of
   * the surface is no number: displaced points may be where it has not been
   * written for, which is no error of a solution.
   * @param outward  see Obstacle::normal().
   */
  template <int dim>
  double depth_in(const Obstacle<dim>  &obstacle,
                  const Point<dim>     &p,
                  const Tensor<1, dim> &outward = Tensor<1, dim>());

  /**
   * The deepest of the nodes that are no contact nodes and yet inside an
   * obstacle: undeformed, of those on the contact boundary, which have been
   * left out, in the obstacle that this part of it faces; displaced, of those
   * on all of the boundary that have been outside before. (A body may well hang
   * over the edge of what is a half space here.) Nodes with
   * prescribed components are left out, except for those of the contact
   * boundary of which all are prescribed, unless the scene says 'Ignore
   * prescribed penetration': a platen may have moved them since the mesh was
   * set up.
   */
  template <int dim>
  Depth<dim> depth_of_other_nodes(const Discretization<dim> &discretization,
                                  const VectorType *displacement = nullptr);

  /**
   * How much deeper than their nodes the faces of one contact boundary,
   * displaced, are in its obstacle, where none of their nodes is in contact: an
   * obstacle that is narrower than a cell is not felt there. Faces with a node
   * in contact, which a curved obstacle enters between nodes by what the mesh
   * leaves of it, do not count.
   * @param condition     which of Scene::contact_conditions().
   * @param displacement  with the values of hanging nodes.
   */
  template <int dim>
  Depth<dim> depth_between_nodes(const Discretization<dim> &discretization,
                                 const unsigned int         condition,
                                 const VectorType          &displacement,
                                 const ContactState        &state);
} // namespace Friction

#endif

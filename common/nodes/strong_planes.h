#ifndef friction_nodes_strong_planes_h
#define friction_nodes_strong_planes_h

#include <common/nodes/node_block_matrix.h>
#include <common/nodes/places.h>

#include <vector>

namespace Friction
{
  /**
   * Planes of strongly coupled nodes in three dimensions: where cells are long
   * in one direction, a node is coupled to its neighbours in the other two
   * several times more than to others.
   *
   * With the negative traces of blocks as strengths, as in LineRelaxation, a
   * coupling is strong if it has 0.35 of the strongest one of either node. A
   * node may be in a plane if
   * - at most half of its couplings are strong: with cubes all are but those
   *   that vanish;
   * - the strong ones lie in a plane, but for a twentieth of them by strength,
   *   which a plane that is fitted to them leaves out;
   * - all couplings along this plane, up to some 20 degrees, have 0.85 of the
   *   diagonal of the node together.
   *
   * Nodes are in the same plane if their coupling is strong and goes along the
   * planes of both. So planes may be curved, as those of a body that was swept
   * along an arc; but they do not hang together where hanging nodes tie the
   * nodes of a fine plane to those of coarse ones.
   *
   * With cells that are r times as long as wide, w times as wide as high, and
   * of a material that is the same everywhere, strengths are those of Laplace's
   * operator. If w = 1, couplings along the plane have 0.85 of the diagonal
   * from r = 2.7 on. Those out of the plane have at most $(r^2+2)/(4r^2-1)$ of
   * the strongest, a third then and a quarter in the end. From w = 1.8 on nodes
   * are in lines; until w = 2 the diagonal couplings have 0.36 of the
   * strongest, and the plane hangs together. A mean volumetric strain in place
   * of pointwise ones changes these numbers: cells of a nearly incompressible
   * material may have to be longer, or are in no plane at all.
   *
   * @param is_relaxed  of each row: others are in no plane.
   * @param positions   of the nodes of the rows; in two dimensions the third
   *                    coordinate is zero.
   * @return the nodes of each plane, in ascending order, however few they are.
   */
  template <int dim>
  std::vector<std::vector<unsigned int>>
  strong_planes(const NodeBlockMatrix<dim> &A,
                const std::vector<char>    &is_relaxed,
                const Places               &positions);

  /** A quick look at a single row, without positions: a node in a plane says
   * yes if it is not at an end of the body, and so do nodes of flat cells. With
   * cubes all say no. */
  template <int dim>
  bool may_be_in_plane(const NodeBlockMatrix<dim> &A, const unsigned int row);

  /** A closer look at a single row: what strong_planes() asks of a node, but
   * for what its neighbours have to say of couplings; and a plane has more
   * nodes than this one. A node whose neighbours find fewer of its couplings
   * strong than itself, as where cells get smaller, may be in a plane though it
   * says no: this is for samples. */
  template <int dim>
  bool may_be_in_plane(const NodeBlockMatrix<dim> &A,
                       const unsigned int          row,
                       const Places               &positions);
} // namespace Friction

#endif

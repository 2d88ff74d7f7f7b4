#ifndef tests_reference_solutions_both_dimensions_h
#define tests_reference_solutions_both_dimensions_h

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <stdexcept>

/**
 * What is the same for the truths in two and in three dimensions. The laws at a
 * node are not among it: they are written down once for each, on purpose, so
 * that an error in one is not an error in both.
 */
namespace Reference
{
  /**
   * Number of the node of a mesh at a point, for tests whose nodes are ordered
   * differently. Throws if there is none within 1e-9 of the mesh's extent.
   */
  template <class AnyMesh>
  unsigned int
  node_at(const AnyMesh                                       &mesh,
          const typename decltype(AnyMesh::nodes)::value_type &point)
  {
    double extent = 0.;
    for (const auto &x : mesh.nodes)
      extent = std::max(extent, (x - mesh.nodes[0]).norm());
    for (unsigned int p = 0; p < mesh.nodes.size(); ++p)
      if ((mesh.nodes[p] - point).norm() <= 1e-9 * extent)
        return p;
    throw std::runtime_error("Reference: no node at this point.");
  }



  /**
   * What forces and lengths are compared with, never zero.
   */
  struct Scales
  {
    /// The largest contact force of a node, or component of a reaction.
    double force = 0.;

    /// The largest component of the displacement.
    double length = 0.;

    /**
     * @param problem a ContactProblem or a ContactProblem3D
     * @param u       displacements, in the problem's unit of length
     * @param R       forces A u - f, in any unit
     */
    template <class Problem>
    Scales(const Problem         &problem,
           const Eigen::VectorXd &u,
           const Eigen::VectorXd &R)
    {
      constexpr unsigned int dim =
        decltype(problem.mesh.nodes)::value_type::RowsAtCompileTime;
      for (const auto &node : problem.contact)
        force = std::max(force, R.segment<dim>(dim * node.node).norm());
      for (const auto &d : problem.dirichlet)
        force = std::max(force, std::abs(R[dim * d.node + d.component]));
      if (force == 0.)
        force = 1.;
      if (u.size() > 0)
        length = u.cwiseAbs().maxCoeff();
      if (length == 0.)
        length = 1.;
    }
  };
} // namespace Reference

#endif

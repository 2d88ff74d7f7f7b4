#ifndef friction_contact_force_balance_h
#define friction_contact_force_balance_h

#include <common/discretization/discretization.h>

#include <deal.II/base/tensor.h>

#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <set>
#include <string>
#include <vector>

namespace Friction
{
  /**
   * One of the forces on a body, in the units of the scene (2D: per unit of
   * thickness).
   */
  template <int dim>
  struct ForceOnBody
  {
    /// As part of a file: `contact`, and where there are several contact
    /// boundaries `contact_2` for that of 'Contact 2', `held_3` where
    /// displacements are prescribed on the boundary with id 3, `pinned` where
    /// they are in single vertices, `traction_3`, `body_force`.
    std::string name;

    /// As part of a sentence: `of the obstacle`, `of what holds boundary 3`.
    std::string description;

    Tensor<1, dim> total;

    /// Where displacements are those of a platen: how far it is from where
    /// 'Displacement' has it, a length.
    bool           is_platen = false;
    Tensor<1, dim> moved;

    /// Where the body may touch an obstacle: the sum of the nodal normal
    /// forces, positive in compression, and that of the vectors of the
    /// tangential ones. They are parts of the total where the boundary is
    /// plane.
    bool           is_contact = false;
    double         normal     = 0.;
    Tensor<1, dim> tangential;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &name &description &total &is_contact &normal &tangential;
      archive &is_platen                                    &moved;
    }
  };



  /** All forces on a body, which together should be zero. */
  template <int dim>
  struct ForceBalance
  {
    std::vector<ForceOnBody<dim>> forces;

    Tensor<1, dim> sum() const;

    /** The norm of the sum, relative to that of the largest force; zero if
     * there are no forces. */
    double imbalance() const;

    /** In one line. Components below a millionth of the largest force are
     * printed as zero. */
    std::string describe() const;

    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &forces;
    }
  };



  /**
   * For each Dirichlet condition the nodes of its boundary that the process
   * owns, in increasing order; hanging ones among them.
   */
  template <int dim>
  std::vector<std::set<unsigned int>>
  nodes_of_conditions(const Discretization<dim> &discretization);



  /**
   * For each component of each node that the process owns the number of the
   * Dirichlet condition that prescribes it, the first one if there are several;
   * or the number of conditions: then it is pinned, or free.
   */
  template <int dim>
  std::vector<unsigned int>
  find_holders(const Discretization<dim> &discretization);



  /**
   * The forces on the body at a solution.
   *
   * With the residual r = f - A u, -r is at each node the force of whatever
   * holds it there: of the obstacle at a contact node, see contact_force(), and
   * of what prescribes a component where one is prescribed. Rows of prescribed
   * components are kept in the matrix, and give the reactions with the accuracy
   * of the solution; an integral of stresses over the boundary would have that
   * of stresses. Where several conditions prescribe the same component of a
   * node, its reaction is that of the first one. What a hanging node exerts is
   * that of its masters.
   *
   * Tractions and body forces are integrated anew. A rigid translation costs no
   * elastic energy, so that A u has no resultant, and the sum of all forces is
   * that of the residuals at the nodes that nothing holds: zero but for the
   * tolerance of the solver. This holds on any mesh, and does not say how good
   * the mesh is.
   *
   * Collective; all processes get the same.
   *
   * @param residual  f - A u, at all nodes, as SolverReport has it.
   */
  template <int dim>
  ForceBalance<dim> force_balance(const Discretization<dim> &discretization,
                                  const VectorType          &residual);
} // namespace Friction

#endif

#ifndef friction_discretization_discrete_problem_h
#define friction_discretization_discrete_problem_h

#include <common/discretization/contact_boundary.h>
#include <common/nodes/leaf_operator.h>
#include <common/nodes/nodal_constraints.h>
#include <common/parameters/solver_settings.h>

#include <vector>

namespace Friction
{
  /**
   * The discrete contact problem on the leaf mesh, as the parts of a solver see
   * it: references to what a Discretization has set up, and the law of
   * friction. Parts keep a reference to it in turn, so that all of them follow
   * when the coefficient of friction is changed.
   */
  template <int dim>
  struct DiscreteProblem
  {
    /// Hanging nodes are condensed, rows of prescribed components included:
    /// A u - f is then the nodal force of any kind, at any node.
    const LeafOperator<dim> &stiffness;

    /// Nodal forces of body forces and tractions, condensed likewise.
    const VectorType &forces;

    const NodalConstraints<dim> &constraints;
    const ContactBoundary<dim>  &contact;

    /// Of a face through each owned node, $h^{d-1}$ with the size h of the
    /// largest cell around it: a stress times this is a force at the node.
    const std::vector<double> &face_measures;

    FrictionLaw friction_law;

    /// $F$, the largest one where it varies. With the law of Tresca the bound
    /// at a node is F times the given normal force of the state, with that of
    /// Coulomb the node's share of F times the one found. Where there are both,
    /// this is Coulomb's law, and nodes know better.
    double friction_coefficient;

    /// That of the end of the load step before, from which friction counts
    /// slip, see ContactNode::slip_origin; null in a first step.
    const VectorType *previous_displacement = nullptr;

    MPI_Comm
    communicator() const
    {
      return constraints.communicator();
    }

    /// Without a coefficient there is no friction, whatever the law is called.
    bool
    has_friction() const
    {
      return friction_law != FrictionLaw::none && friction_coefficient > 0.;
    }

    /// Whether normal forces in the friction bounds are those of the solution.
    bool
    has_coulomb_friction() const
    {
      return has_friction() && friction_law == FrictionLaw::coulomb;
    }

    /// The same at a node.
    bool
    has_coulomb_friction(const ContactNode<dim> &node) const
    {
      return has_coulomb_friction() && !node.bound_is_given;
    }

    /// The largest coefficient that the parts of the solver reckon with.
    double
    effective_coefficient() const
    {
      return has_friction() ? friction_coefficient : 0.;
    }

    /// The one at a node.
    double
    effective_coefficient(const ContactNode<dim> &node) const
    {
      return effective_coefficient() * node.friction_share;
    }
  };
} // namespace Friction

#endif

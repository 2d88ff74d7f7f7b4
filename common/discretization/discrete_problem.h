#ifndef friction_discretization_discrete_problem_h
#define friction_discretization_discrete_problem_h

#include <common/discretization/contact_boundary.h>
#include <common/nodes/nodal_constraints.h>
#include <common/nodes/node_block_matrix.h>
#include <common/parameters/solver_settings.h>

namespace Friction
{
  /**
   * The discrete contact problem on the leaf mesh, as every part of a solver
   * sees it: references only, to objects that must outlive it.
   */
  template <int dim>
  struct DiscreteProblem
  {
    /// Stiffness, hanging nodes condensed, rows of prescribed components
    /// included: A u - f is then the nodal force of any kind, at any node.
    const NodeBlockMatrix<dim> &matrix;

    /// Nodal forces of body forces and tractions, condensed likewise.
    const VectorType &forces;

    const NodalConstraints<dim> &constraints;
    const ContactBoundary<dim>  &contact;

    FrictionLaw friction_law;

    /// $F$. With the law of Tresca the bound at a node is F times the given
    /// normal force of the state, with that of Coulomb F times the one found.
    double friction_coefficient;

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

    /// The coefficient that the parts of the solver reckon with.
    double
    effective_coefficient() const
    {
      return has_friction() ? friction_coefficient : 0.;
    }
  };
} // namespace Friction

#endif

#include <common/contact/nodal_constraints.h>

#include <common/compatibility.h>

#include <deal.II/dofs/dof_tools.h>

namespace Friction
{
  template <int dim>
  NodalConstraints<dim>::NodalConstraints(
    const DoFHandler<dim>           &dof_handler,
    const AffineConstraints<double> &hanging,
    const AffineConstraints<double> &dirichlet)
  {
    const IndexSet relevant =
      DoFTools::extract_locally_relevant_dofs(dof_handler);
    leaf_partitioner = std::make_shared<Utilities::MPI::Partitioner>(
      dof_handler.locally_owned_dofs(),
      relevant,
      Compatibility::mpi_communicator(dof_handler));

    const unsigned int n_dofs = leaf_partitioner->locally_owned_size() +
      leaf_partitioner->n_ghost_indices();
    AssertThrow(n_dofs % dim == 0, ExcInternalError());
    flags.resize(n_dofs / dim, 0);
    values.reinit(leaf_partitioner);
    for (unsigned int local = 0; local < n_dofs; ++local)
      {
        const auto dof = leaf_partitioner->local_to_global(local);
        if (hanging.is_constrained(dof))
          flags[local / dim] |= hanging_bit;
        else if (dirichlet.is_constrained(dof))
          {
            flags[local / dim] |= (1u << (local % dim));
            values.local_element(local) = dirichlet.get_inhomogeneity(dof);
          }
      }
  }



  template <int dim>
  void
  NodalConstraints<dim>::impose(VectorType &u) const
  {
    for (unsigned int node = 0; node < n_owned_nodes(); ++node)
      for (unsigned int c = 0; c < dim; ++c)
        if (is_prescribed(node, c))
          u.local_element(dim * node + c) =
            values.local_element(dim * node + c);
  }



  template <int dim>
  void
  NodalConstraints<dim>::prescribe(const unsigned int node,
                                   const unsigned int component,
                                   const double       value)
  {
    flags[node] |= (1u << component);
    values.local_element(dim * node + component) = value;
  }



  template class NodalConstraints<2>;
  template class NodalConstraints<3>;
} // namespace Friction

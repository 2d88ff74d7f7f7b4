#include <common/nodes/nodal_constraints.h>

#include <common/compatibility.h>

#include <deal.II/dofs/dof_tools.h>

namespace Friction
{
  template <int dim>
  NodalConstraints<dim>::NodalConstraints(
    const DoFHandler<dim>           &dof_handler,
    const AffineConstraints<double> &hanging,
    const AffineConstraints<double> &dirichlet,
    const IndexSet                  &coupled)
  {
    IndexSet relevant    = DoFTools::extract_locally_relevant_dofs(dof_handler);
    const IndexSet known = relevant;
    if (coupled.size() > 0)
      relevant.add_indices(coupled);
    relevant.compress();
    leaf_partitioner = std::make_shared<Utilities::MPI::Partitioner>(
      dof_handler.locally_owned_dofs(),
      relevant,
      Compatibility::mpi_communicator(dof_handler));

    const unsigned int n_dofs = leaf_partitioner->locally_owned_size() +
      leaf_partitioner->n_ghost_indices();
    AssertThrow(n_dofs % dim == 0, ExcInternalError());
    flags.resize(n_dofs / dim, 0);
    values.reinit(leaf_partitioner);
    node_numbering = NodeNumbering(
      NodeDistribution(leaf_partitioner->locally_owned_size() / dim,
                       std::make_shared<SolverCommunicator>(
                         Compatibility::mpi_communicator(dof_handler))));
    for (unsigned int local = leaf_partitioner->locally_owned_size();
         local < n_dofs;
         local += dim)
      node_numbering.add(leaf_partitioner->local_to_global(local) / dim);

    for (unsigned int local = 0; local < n_dofs; ++local)
      {
        const auto dof = leaf_partitioner->local_to_global(local);
        if (!known.is_element(dof))
          continue;
        if (hanging.is_constrained(dof))
          flags[local / dim] |= hanging_bit;
        else if (dirichlet.is_constrained(dof))
          {
            flags[local / dim] |= (1u << (local % dim));
            values.local_element(local) = dirichlet.get_inhomogeneity(dof);
          }
      }

    update_ghosts();
  }



  template <int dim>
  NodalConstraints<dim>::NodalConstraints(
    const std::vector<char> &is_prescribed, const std::vector<double> &u)
    : leaf_partitioner(
        std::make_shared<Utilities::MPI::Partitioner>(is_prescribed.size()))
    , node_numbering(
        NodeDistribution(is_prescribed.size() / dim,
                         std::make_shared<SolverCommunicator>(MPI_COMM_SELF)))
    , flags(is_prescribed.size() / dim, 0)
    , values(leaf_partitioner)
  {
    for (unsigned int i = 0; i < is_prescribed.size(); ++i)
      if (is_prescribed[i])
        {
          flags[i / dim] |= (1u << (i % dim));
          values.local_element(i) = u[i];
        }
  }



  // The owner of a node knows all about it; processes that have it as a
  // ghost may not.
  template <int dim>
  void
  NodalConstraints<dim>::update_ghosts()
  {
    if (node_numbering.distribution().n_processes() == 1)
      return;
    values.update_ghost_values();
    VectorType owners_flags(leaf_partitioner);
    for (unsigned int node = 0; node < n_owned_nodes(); ++node)
      owners_flags.local_element(dim * node) = flags[node];
    owners_flags.update_ghost_values();
    for (unsigned int node = n_owned_nodes(); node < n_nodes(); ++node)
      flags[node] =
        static_cast<unsigned char>(owners_flags.local_element(dim * node));
  }



  template <int dim>
  void
  NodalConstraints<dim>::update_values(
    const AffineConstraints<double> &dirichlet)
  {
    for (unsigned int node = 0; node < n_owned_nodes(); ++node)
      for (unsigned int c = 0; c < dim; ++c)
        {
          const auto dof = leaf_partitioner->local_to_global(dim * node + c);
          if (is_prescribed(node, c) && dirichlet.is_constrained(dof))
            values.local_element(dim * node + c) =
              dirichlet.get_inhomogeneity(dof);
        }
    values.update_ghost_values();
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
  NodalConstraints<dim>::prescribe(const std::vector<unsigned int> &nodes,
                                   const VectorType                &u)
  {
    for (const unsigned int node : nodes)
      {
        Assert(node < n_owned_nodes() && !is_hanging(node),
               ExcMessage("Only owned nodes that do not hang."));
        flags[node] |= all_components;
        for (unsigned int c = 0; c < dim; ++c)
          values.local_element(dim * node + c) =
            u.local_element(dim * node + c);
      }
    update_ghosts();
  }



  template class NodalConstraints<2>;
  template class NodalConstraints<3>;
} // namespace Friction

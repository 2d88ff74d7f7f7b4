#ifndef friction_nodes_nodal_constraints_h
#define friction_nodes_nodal_constraints_h

#include <common/parallel/node_distribution.h>
#include <common/parallel/vector_type.h>

#include <deal.II/base/partitioner.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/lac/affine_constraints.h>

#include <memory>
#include <vector>

namespace Friction
{
  using namespace dealii;

  /**
   * What is known about each node of the leaf mesh before any contact: is it
   * hanging, and which of its components are prescribed?
   *
   * A node is a vertex with its dim degrees of freedom, numbered one after the
   * other by FESystem(FE_Q(1),dim); node i has the local degrees of freedom
   * dim*i,...,dim*i+dim-1, locally owned nodes first, then ghosts.
   *
   * Ghosts are the nodes of all cells that a process knows, and those that the
   * rows of its own nodes in the stiffness matrix couple to. The latter are not
   * always among the former: where a node is master of a hanging node, its row
   * reaches all cells around that node, and a process that owns the master may
   * know only some of them.
   */
  template <int dim>
  class NodalConstraints
  {
  public:
    /**
     * @param hanging    hanging node constraints only.
     * @param dirichlet  Dirichlet values only (lines without entries).
     * Both must know the locally relevant degrees of freedom.
     * @param coupled    degrees of freedom that owned rows of the stiffness
     *                   matrix couple to, see LeafAssembler. With one process
     *                   it may be left out.
     *
     * Collective.
     */
    NodalConstraints(const DoFHandler<dim>           &dof_handler,
                     const AffineConstraints<double> &hanging,
                     const AffineConstraints<double> &dirichlet,
                     const IndexSet                  &coupled = IndexSet());

    /**
     * Nodes that are all on this process, and do not hang.
     * @param is_prescribed  of each degree of freedom, whether it is given.
     * @param u              has the values of those that are.
     */
    NodalConstraints(const std::vector<char>   &is_prescribed,
                     const std::vector<double> &u);

    /** The distribution of degrees of freedom over processes, with ghosts. */
    const std::shared_ptr<const Utilities::MPI::Partitioner> &
    partitioner() const
    {
      return leaf_partitioner;
    }

    /** The same for nodes; local numbers agree. */
    const NodeNumbering &
    numbering() const
    {
      return node_numbering;
    }

    MPI_Comm
    communicator() const
    {
      return node_numbering.distribution().communicator();
    }

    unsigned int
    n_owned_nodes() const
    {
      return leaf_partitioner->locally_owned_size() / dim;
    }

    /** Owned nodes and ghosts. */
    unsigned int
    n_nodes() const
    {
      return flags.size();
    }

    /** The local number of the node that a global degree of freedom is at. */
    unsigned int
    node_of_dof(const types::global_dof_index dof) const
    {
      return leaf_partitioner->global_to_local(dof) / dim;
    }

    bool
    is_hanging(const unsigned int node) const
    {
      return flags[node] & hanging_bit;
    }

    bool
    is_prescribed(const unsigned int node, const unsigned int component) const
    {
      return flags[node] & (1u << component);
    }

    /** No component is prescribed, and the node does not hang. */
    bool
    is_free(const unsigned int node) const
    {
      return flags[node] == 0;
    }

    /** Hanging, or every component prescribed: nothing to solve for. */
    bool
    is_fixed(const unsigned int node) const
    {
      return is_hanging(node) || flags[node] == all_components;
    }

    /** The prescribed values; zero where nothing is prescribed. */
    const VectorType &
    prescribed_values() const
    {
      return values;
    }

    /** Sets the prescribed components of @p u to their values. */
    void impose(VectorType &u) const;

    /**
     * Other values of the components that are prescribed.
     * @param dirichlet  as in the constructor, with the same lines. Collective.
     */
    void update_values(const AffineConstraints<double> &dirichlet);

    /**
     * Prescribes all components of some more nodes, to have the values that
     * they have in @p u: this is how the bonded comparison problem is made out
     * of a contact problem. Collective.
     * @param nodes  owned nodes that do not hang.
     */
    void prescribe(const std::vector<unsigned int> &nodes, const VectorType &u);

  private:
    // Has all processes that know a node know what its owner knows of it.
    void update_ghosts();

    static constexpr unsigned char hanging_bit    = 0x80;
    static constexpr unsigned char all_components = (1u << dim) - 1;

    std::shared_ptr<const Utilities::MPI::Partitioner> leaf_partitioner;
    NodeNumbering                                      node_numbering;
    std::vector<unsigned char>                         flags;
    VectorType                                         values;
  };
} // namespace Friction

#endif

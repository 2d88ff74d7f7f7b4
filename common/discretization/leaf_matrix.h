#ifndef friction_discretization_leaf_matrix_h
#define friction_discretization_leaf_matrix_h

#include <common/discretization/cell_form.h>
#include <common/nodes/nodal_constraints.h>
#include <common/nodes/node_block_matrix.h>
#include <common/nodes/node_weights.h>

#include <deal.II/base/index_set.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/lac/affine_constraints.h>

#include <map>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace Friction
{
  /**
   * Assembles the stiffness matrix of the leaf mesh, and vectors of nodal
   * forces, by node blocks; hanging nodes are condensed on the way.
   *
   * It does what a sparsity pattern, AffineConstraints and a matrix of Trilinos
   * do in step-40, with one number per node where they have dim numbers of
   * degrees of freedom, and dim*dim pairs of them. The life of an object has
   * three parts, since the matrix says which ghosts a process needs, and these
   * have no local numbers before that is known:
   * @code
   *   LeafAssembler<dim>    assembler(dof_handler, hanging);
   *   NodalConstraints<dim> constraints(dof_handler, hanging, dirichlet,
   *                                     assembler.coupled_dofs());
   *   assembler.begin(constraints);
   *   for (all locally owned active cells, in the order of the iterator)
   *     assembler.add(blocks, cell_forces, forces);
   *   assembler.finish(forces);       // then take matrix()
   * @endcode
   *
   * With several processes each integrates over its own cells. What it finds
   * for rows of nodes of others, those at the interfaces, it keeps beside its
   * own rows and sends to their owners in the end, who add it in the order of
   * the processes. Which columns these rows have is told when the object is
   * made.
   */
  template <int dim>
  class LeafAssembler
  {
  public:
    static constexpr unsigned int n_vertices = CellBlocks<dim>::n_vertices;

    using CellForces = std::array<Tensor<1, dim>, n_vertices>;

    /** Finds the couplings. Collective.
     * @param hanging  hanging node constraints only, known for the locally
     *                 relevant degrees of freedom. */
    LeafAssembler(const DoFHandler<dim>           &dof_handler,
                  const AffineConstraints<double> &hanging);

    /**
     * Degrees of freedom of other processes that owned rows couple to: all of
     * them that are not locally relevant, and some that are. Usually rows
     * couple to the nodes of the process' own cells and of their neighbours.
     * But a row to which a hanging node has been condensed reaches all cells
     * around that node, and one of them may be farther away.
     */
    const IndexSet &
    coupled_dofs() const
    {
      return coupled;
    }

    /** Begins with a matrix of zeros. Call it once.
     * @param constraints  the local numbers of nodes; kept by reference until
     *                     finish(). */
    void begin(const NodalConstraints<dim> &constraints);

    /** Adds the contributions of the next cell. Of @p blocks only those of
     * pairs of vertices (a,b) with b <= a are used, and completed.
     * @param cell_forces  of each vertex. */
    void add(CellBlocks<dim>  &blocks,
             const CellForces &cell_forces,
             VectorType       &forces);

    /** Gathers what other processes have found. Collective, and an error unless
     * all cells have been added. */
    void finish(VectorType &forces);

    /** The matrix: rows of owned nodes, columns in local numbers. Rows and
     * columns of hanging nodes are empty. */
    NodeBlockMatrix<dim> &
    matrix()
    {
      return owned_rows;
    }

  private:
    // A node that has a share in the value at a vertex of the present cell.
    struct Share
    {
      GlobalNode   node; // or its local number, from begin() on
      unsigned int vertex;
      double       weight;
    };

    // Columns of a row of another process, or of a part that another process
    // has found of one of ours.
    struct Row
    {
      GlobalNode              row;
      std::vector<GlobalNode> columns;
    };

    // A node that a hanging one gets a part of its value from.
    using Master = typename NodeWeights<GlobalNode>::Entry;

    const MPI_Comm communicator;
    IndexSet       coupled;

    // The nodes at the vertices of the process' own cells: global numbers
    // first, local ones from begin() on; and where hanging nodes get their
    // values from, by global numbers and, from begin() on, by local ones.
    std::vector<GlobalNode>                             vertex_nodes;
    std::unordered_map<GlobalNode, std::vector<Master>> masters;
    NodeWeights<GlobalNode>                             local_masters;

    // By process: the rows that it gets from us, and we get from it.
    std::map<unsigned int, std::vector<Row>> outgoing, incoming;

    const NodalConstraints<dim>       *constraints = nullptr;
    std::shared_ptr<const NodePattern> owned_pattern, outgoing_pattern;
    NodeBlockMatrix<dim>               owned_rows, outgoing_rows;
    std::vector<unsigned int>          outgoing_row_of_ghost;
    std::size_t                        n_cells_done = 0;
    std::vector<Share>                 shares;

    std::pair<const Master *, const Master *>
    masters_of(const GlobalNode node) const;

    void collect_shares(const std::size_t cell);

    void exchange_patterns(const IndexSet &owned_dofs);

    void make_numbers_local();

    void make_patterns();
  };
} // namespace Friction

#endif

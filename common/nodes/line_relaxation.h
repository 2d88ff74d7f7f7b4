#ifndef friction_nodes_line_relaxation_h
#define friction_nodes_line_relaxation_h

#include <common/nodes/node_block_matrix.h>
#include <common/nodes/sweep_schedule.h>
#include <common/nodes/truncation.h>
#include <common/parallel/ghost_exchange.h>

#include <mpi.h>

#include <vector>

namespace Friction
{
  /**
   * Block Gauss-Seidel whose blocks are lines of strongly coupled nodes.
   *
   * Where cells are much longer than wide, a node is coupled to its neighbours
   * in the short direction many times more than to all others. Relaxing one
   * node after the other then changes next to nothing: what a node would like
   * to do its neighbours forbid. Relaxing them together is as cheap, since the
   * problem of a line is block tridiagonal, and what is left after it is smooth
   * in the short direction, so that a coarser mesh can go on.
   *
   * Lines are found from the matrix. With the negative traces of blocks as
   * strengths, which are the weights of Laplace's operator for a material that
   * is the same everywhere, a node is in a line if at most two of its
   * couplings are at least three times as strong as the third strongest; lines
   * connect nodes of which each is such a partner of the other, and those of
   * less than three nodes are dropped. On
   * meshes of squares or cubes there are none. The bilinear elements of cells
   * that are infinitely long reach a ratio of four, with an aspect ratio of
   * three it is 3.3.
   *
   * With several processes, lines end at the interfaces, and nodes there get
   * the damping of relaxation by nodes (interface_damping()); the argument for
   * it holds for any blocks within a process.
   */
  template <int dim>
  class LineRelaxation
  {
  public:
    /**
     * Finds the lines. Collective.
     * @param A             kept by reference.
     * @param nodes         those to be relaxed.
     * @param communicator  of all processes that have rows of the matrix.
     */
    LineRelaxation(const NodeBlockMatrix<dim> &A,
                   const NodeRanges           &nodes,
                   const MPI_Comm              communicator);

    /** Whether more than one in fifty nodes is in a line, over all processes.
     * If not, relaxation by nodes is what one wants. */
    bool
    has_lines() const
    {
      return worthwhile;
    }

    /** The lines, each from an end to the other. */
    std::vector<std::vector<unsigned int>> lines() const;

    /**
     * Factorises the problems of the lines. To be called before the first sweep
     * and whenever the matrix or the truncation has changed.
     * @param truncation  if not null, the matrix is $T(A+\omega'')T$.
     */
    void factorise(const Truncation<dim> *truncation = nullptr);

    /**
     * Sweeps over lines and the nodes in between, and then, if @p residual is
     * not null, the (truncated) residual of all rows.
     * @param b       one value per component of each owned node; truncated.
     * @param x       the same and the ghosts, which must be valid, and are on
     *                return; truncated.
     */
    void run(const Sweeps  &sweeps,
             const double  *b,
             double        *x,
             GhostExchange &ghosts,
             double        *residual = nullptr) const;

    std::size_t memory_consumption() const;

  private:
    const NodeBlockMatrix<dim> *A;
    bool                        worthwhile = false;

    // Line l has the nodes with indices starts[l],...,starts[l+1]-1 in @p
    // nodes; a node that is in none is a line by itself.
    std::vector<unsigned int> starts, nodes;

    // By the same index: eigenvalues of pivots that count as zero; pseudo
    // inverses of the pivots; coupling to the node before.
    std::vector<double>         cuts;
    std::vector<NodeBlock<dim>> inverse_pivots, couplings;

    const Truncation<dim> *truncation = nullptr;

    mutable std::vector<NodeValue<dim>> values;

    void find_lines(const std::vector<char> &is_relaxed,
                    const MPI_Comm           communicator);

    NodeValue<dim> residual_of(const unsigned int node,
                               const double      *b,
                               const double      *x) const;

    void relax_line(const unsigned int line, const double *b, double *x) const;
  };
} // namespace Friction

#endif

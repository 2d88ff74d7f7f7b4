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
   * is the same everywhere, a node may be in a line if its two strongest
   * couplings have four fifths of its diagonal together. With squares they have
   * a quarter, with rectangles 4/5 from an aspect ratio of 2.6 on, and all of
   * it if cells are infinitely long. Lines connect nodes of which each is one
   * of the two strongest partners of the other, and those of less than three
   * nodes are dropped.
   *
   * With several processes, lines end at the interfaces, and their nodes there
   * get half of interface_majorant() as damping, with which the energy falls.
   * An interface that cuts lines costs cycles, many if it cuts all of them.
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

#ifndef friction_nodes_line_relaxation_h
#define friction_nodes_line_relaxation_h

#include <common/nodes/node_block_matrix.h>
#include <common/nodes/sweep_schedule.h>
#include <common/nodes/truncation.h>
#include <common/parallel/ghost_exchange.h>

#include <mpi.h>

#include <functional>
#include <vector>

namespace Friction
{
  /**
   * Gauss-Seidel for lines of strongly coupled nodes, each of them a block.
   *
   * Where cells are longer than wide, a node is coupled to its neighbours
   * in the short direction many times more than to all others. Relaxing one
   * node after the other then changes next to nothing: what a node would like
   * to do its neighbours forbid. Relaxing them together takes hardly more
   * operations, since the problem of a line is block tridiagonal, and what is
   * left after it is smooth in the short direction, so that a coarser mesh can
   * go on. Nodes that belong to no line are left alone; they are relaxed one by
   * one, by the caller.
   *
   * Lines are found from the matrix. With the negative traces of blocks as
   * strengths, which for a material that is the same everywhere are those of
   * Laplace's operator, if each component is weighted alike, a node may be in a
   * line if its two strongest couplings have 0.65 of its diagonal together.
   * With squares they have a quarter, with rectangles 0.65 from an aspect ratio
   * of 1.8 on (with cuboids short in one direction, from 2.6 on), and all of it
   * if cells are infinitely long. Lines connect nodes of which each is one of
   * the two strongest partners of the other. Inside of a line no node couples
   * to others than the one before and the one after: where it would, in a bend
   * or a ring, the line is cut. Those of less than three nodes are dropped.
   *
   * With several processes, lines end at the interfaces, and their nodes there
   * get half of interface_majorant() as damping, with which the energy falls;
   * see doc/parallel.md. An interface that cuts lines costs cycles, many if it
   * cuts all of them.
   */
  template <int dim>
  class LineRelaxation
  {
  public:
    /** Whether a component of a node has to keep its value. */
    using IsHeld = std::function<bool(const unsigned int node,
                                      const unsigned int component)>;

    /**
     * Finds the lines. Collective.
     * @param A             kept by reference.
     * @param nodes         those to be relaxed.
     * @param is_held       components that keep their values.
     * @param communicator  of all processes that have rows of the matrix.
     */
    LineRelaxation(const NodeBlockMatrix<dim> &A,
                   const NodeRanges           &nodes,
                   const IsHeld               &is_held,
                   const MPI_Comm              communicator);

    /** The share of the nodes to be relaxed that are in lines, over all
     * processes. If there are very few, none are. */
    double
    share_of_nodes() const
    {
      return share;
    }

    bool
    has_lines() const
    {
      return share > 0;
    }

    /** The lines, each from an end to the other. */
    std::vector<std::vector<unsigned int>> lines() const;

    /** Those of @p all that are in no line. */
    NodeRanges other_nodes(const NodeRanges &all) const;

    /**
     * Factorises the problems of the lines. To be called before the first sweep
     * and whenever the matrix or the truncation has changed.
     * @param truncation  if not null, the matrix is $T(A+\omega'')T$.
     */
    void factorise(const Truncation<dim> *truncation = nullptr);

    /**
     * Sweeps over the lines, and then, if @p residual is not null, the
     * (truncated) residual of all rows.
     * @param b       one value per component of each owned node; truncated.
     * @param x       the same and the ghosts, which must be valid, and are on
     *                return; truncated.
     */
    void run(const unsigned int n_sweeps,
             const double      *b,
             double            *x,
             GhostExchange     &ghosts,
             double            *residual = nullptr) const;

    std::size_t memory_consumption() const;

  private:
    const NodeBlockMatrix<dim> *A;
    double                      share = 0.;

    // Line l has the nodes with indices starts[l],...,starts[l+1]-1 in @p
    // nodes.
    std::vector<unsigned int> starts = {0}, nodes;

    // By the same index: which components are free, as bits; eigenvalues of
    // pivots that count as zero; pseudo-inverses of the pivots; coupling to the
    // node before.
    std::vector<unsigned char>  free_components;
    std::vector<double>         cuts;
    std::vector<NodeBlock<dim>> inverse_pivots, couplings;

    const Truncation<dim> *truncation    = nullptr;
    bool                   is_factorised = false;

    mutable std::vector<NodeValue<dim>> values;

    void find_lines(const std::vector<char> &is_relaxed);

    void relax_line(const unsigned int line, const double *b, double *x) const;
  };
} // namespace Friction

#endif

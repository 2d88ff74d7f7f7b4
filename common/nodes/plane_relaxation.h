#ifndef friction_nodes_plane_relaxation_h
#define friction_nodes_plane_relaxation_h

#include <common/nodes/places.h>
#include <common/nodes/plane_problem.h>
#include <common/nodes/sweep_schedule.h>
#include <common/parallel/ghost_exchange.h>

#include <mpi.h>

#include <functional>
#include <memory>
#include <vector>

namespace Friction
{
  /** What the relaxation of several nodes at once has to know of the nodes of a
   * matrix. */
  struct RelaxedNodes
  {
    /// Those to be relaxed.
    NodeRanges nodes;

    /// Whether a component of a node has to keep its value.
    std::function<bool(const unsigned int node, const unsigned int component)>
      is_held;

    /// At which a truncation may come and go, while the matrix stays the same.
    std::vector<unsigned int> truncated;

    /// Where the nodes are, asked for only if that matters; in two dimensions
    /// the third coordinate is zero.
    std::function<Places()> positions;
  };



  /**
   * Gauss-Seidel for planes of strongly coupled nodes, each of them a block.
   *
   * Where cells are long in one of three directions, as in a mesh that has been
   * extruded or in a slender body, a node is coupled to its neighbours in the
   * other two many times more than to those in this one, and LineRelaxation
   * helps no more than relaxing node by node. A plane of such nodes is no
   * tridiagonal problem, but one of two dimensions, which nested dissection
   * factorises with little fill (PlaneProblem).
   *
   * How planes are found says strong_planes().
   *
   * What hangs together but is no plane, and would take too long to factorise,
   * is left alone. So are the contact nodes of a plane that has too many of
   * them, as the contact boundary of a body of needles that stand on it: what
   * they do changes with each cycle, and leading relaxation and coarse
   * functions take care of it.
   *
   * With several processes, planes end at the interfaces, as lines do.
   */
  template <int dim>
  class PlaneRelaxation
  {
  public:
    /**
     * Finds the planes; in two dimensions there are none. Collective.
     * @param A             kept by reference.
     * @param nodes         looked at here only.
     * @param communicator  of all processes that have rows of the matrix.
     */
    PlaneRelaxation(const NodeBlockMatrix<dim> &A,
                    const RelaxedNodes         &nodes,
                    const MPI_Comm              communicator);

    /** The share of the nodes to be relaxed that are in planes, over all
     * processes. If there are very few, none are. */
    double
    share_of_nodes() const
    {
      return share;
    }

    /** The nodes of each plane. */
    std::vector<std::vector<unsigned int>> planes() const;

    /** Those of @p all that are in no plane. */
    NodeRanges other_nodes(const NodeRanges &all) const;

    /**
     * Factorises the problems of the planes. To be called before the first
     * sweep and whenever the matrix or the truncation has changed.
     * @param truncation  if not null, the matrix, which is that of the first
     *                    call, is meant as $T(A+\omega'')T$. It must be given
     *                    if there are nodes that may be truncated.
     */
    void factorise(const Truncation<dim> *truncation = nullptr);

    /**
     * Sweeps over the planes, and then, if @p residual is not null, the
     * (truncated) residual of all rows; arguments as in LineRelaxation::run().
     */
    void run(const unsigned int n_sweeps,
             const double      *b,
             double            *x,
             GhostExchange     &ghosts,
             double            *residual = nullptr) const;

    std::size_t memory_consumption() const;

  private:
    using Problem = PlaneProblem<dim>;

    const NodeBlockMatrix<dim>           *A;
    double                                share = 0.;
    std::vector<std::unique_ptr<Problem>> problems;
    const Truncation<dim>                *truncation    = nullptr;
    bool                                  is_factorised = false;

    mutable std::vector<double> values;

    void find_planes(const RelaxedNodes      &nodes,
                     const std::vector<char> &is_relaxed,
                     const Places            &positions);

    std::vector<typename Problem::Node>
    nodes_of_problem(const RelaxedNodes              &nodes,
                     const Places                    &positions,
                     const std::vector<char>         &is_truncated,
                     const std::vector<unsigned int> &plane) const;
  };
} // namespace Friction

#endif

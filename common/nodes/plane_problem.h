#ifndef friction_nodes_plane_problem_h
#define friction_nodes_plane_problem_h

#include <common/nodes/condensation.h>
#include <common/nodes/elimination_tree.h>
#include <common/nodes/node_block_matrix.h>
#include <common/nodes/places.h>
#include <common/nodes/truncation.h>

#include <array>
#include <memory>
#include <vector>

namespace Friction
{
  /**
   * The linear problem of some nodes of a matrix, all others keeping their
   * values, solved by a factorisation: the block of the matrix that couples
   * them with each other.
   *
   * Nodes at which a truncation may come and go are eliminated last. The
   * factors of all others are made once (Condensation); what is left on the
   * former is a small dense matrix S, and only $T(S+\omega'')T$ is factorised
   * anew when T or $\omega''$ has changed.
   */
  template <int dim>
  class PlaneProblem
  {
  public:
    struct Node
    {
      unsigned int          number; ///< of its row
      Place                 position;
      std::array<bool, dim> is_held; ///< components that keep their values
      bool                  may_be_truncated; ///< and so is eliminated last
    };

    /**
     * @param A      its pattern and its diagonal are looked at, for what counts
     *               as zero later.
     * @param nodes  with ascending numbers.
     */
    PlaneProblem(const NodeBlockMatrix<dim> &A, const std::vector<Node> &nodes);

    PlaneProblem(const PlaneProblem &) = delete;

    const std::vector<unsigned int> &
    nodes() const
    {
      return numbers;
    }

    /** Of all nodes with others of them. */
    std::size_t
    n_couplings() const
    {
      return pattern->columns.size() - numbers.size();
    }

    /** About how many multiplications factorise() takes. */
    double
    cost() const
    {
      return tree->cost(dim);
    }

    /**
     * Factorises what couples the nodes, with half of interface_majorant() on
     * the diagonal, see LineRelaxation. In directions in which a diagonal block
     * vanishes nothing will move.
     * @param keeps_copy  whether to remember all this: the next call then does
     *                    nothing if it is the same.
     */
    void factorise(const NodeBlockMatrix<dim> &A, const bool keeps_copy);

    /** From now on the problem is that of $T(A+\omega'')T$, where all nodes of
     * the problem but those that may be truncated are free. Has to be called
     * before solve() if there are such nodes. */
    void truncate(const Truncation<dim> &truncation);

    /**
     * @param values  right hand side of the nodes, dim values each, truncated;
     *                on return the solution, truncated.
     */
    void solve(std::vector<double> &values) const;

    std::size_t memory_consumption() const;

  private:
    std::vector<unsigned int>          numbers;
    Places                             positions;
    std::vector<char>                  is_held; // of each degree of freedom
    std::vector<double>                traces;  // of diagonal blocks at first
    std::shared_ptr<const NodePattern> pattern;

    std::unique_ptr<EliminationTree>   tree;
    std::unique_ptr<Condensation<dim>> factors;
    NodeBlockMatrix<dim>               copy;

    // Of those that may be truncated, in the order of the last front:
    // projectors and second derivatives, and Cholesky's factor of what is left
    // on them.
    std::vector<NodeBlock<dim>> projectors, curvatures;
    std::vector<double>         dense_factor;

    const std::vector<unsigned int> &
    kept() const
    {
      return tree->fronts().back().nodes;
    }

    // What a direction that cannot move gets on the diagonal.
    double
    stiffness(const unsigned int node) const
    {
      return traces[node] / dim;
    }

    NodeBlockMatrix<dim> matrix_of(const NodeBlockMatrix<dim> &A) const;

    void solve_kept(std::vector<double> &values) const;
  };
} // namespace Friction

#endif

#ifndef friction_iteration_contact_strip_h
#define friction_iteration_contact_strip_h

#include <common/discretization/discrete_problem.h>
#include <common/levels/trilinos_names.h>
#include <common/nodes/truncation.h>

#include <deal.II/lac/solver_control.h>

#include <array>
#include <memory>
#include <vector>

namespace Friction
{
  /**
   * The linear problem of a step of Newton's method in a strip of the body
   * along its sliding contact nodes, solved exactly.
   *
   * Where a node slides, the bound of friction follows the normal force. This
   * couples neighbouring contact nodes at all wave lengths alike, with a
   * strength that grows with the coefficient of friction, so that a multigrid
   * cycle which does not know of it leaves all of that to the iteration around
   * it. In the strip the rows of sliding nodes are those of
   * $(T-F\,e\,n^T)(A+\omega'')T$, so that it deals with all waves which are
   * not much longer than the strip is deep; with longer ones the body is stiff
   * by itself.
   *
   * A process has its own part of the strip, and solves there as if nothing
   * moved on others.
   */
  template <int dim>
  class ContactStrip
  {
  public:
    /** @p problem is kept by reference. */
    explicit ContactStrip(const DiscreteProblem<dim> &problem);
    ~ContactStrip();

    /**
     * Finds the strip and factorises its matrix. Collective.
     * @param truncation  kept by reference.
     * @param slopes      of each contact node $F\,e$, zero unless it slides
     *                    and its bound follows the normal force.
     * @param n_layers    how deep it is: the neighbours of sliding nodes are
     *                    the first layer, their neighbours the next one. In
     *                    three dimensions a process with more than 5000 nodes
     *                    in its strip takes sliding nodes alone.
     */
    void update(const Truncation<dim>             &truncation,
                const std::vector<NodeValue<dim>> &slopes,
                const unsigned int                 n_layers);

    /** On no process there is anything to solve. */
    bool
    is_empty() const
    {
      return empty_everywhere;
    }

    /** Adds the solution for a truncated defect to v. */
    void add_solution(VectorType &v, const VectorType &defect);

    /** Of the matrix, in bytes; the factors are Trilinos'. */
    std::size_t memory_consumption() const;

  private:
    const DiscreteProblem<dim> &problem;
    const Truncation<dim>      *current          = nullptr;
    bool                        empty_everywhere = true;

    // Those of the strip, where a node is among them, and where it is among the
    // contact nodes; `outside` if it is not.
    std::vector<unsigned int> nodes, position, contact_node;

    std::unique_ptr<TrilinosWrappers::SparseMatrix> matrix;
    SolverControl                                   control;
    std::unique_ptr<TrilinosWrappers::SolverDirect> factors;
    VectorType                                      rhs, solution;

    // Of the rows that are being computed.
    std::vector<types::global_dof_index> columns;
    std::array<std::vector<double>, dim> rows;

    void find_nodes(const std::vector<NodeValue<dim>> &slopes,
                    const unsigned int                 n_layers);

    // @p is_new  whether the nodes are others than before.
    void fill(const std::vector<NodeValue<dim>> &slopes, const bool is_new);

    void factorize();
  };
} // namespace Friction

#endif

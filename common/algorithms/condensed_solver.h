#ifndef friction_algorithms_condensed_solver_h
#define friction_algorithms_condensed_solver_h

#include <common/algorithms/contact_zone.h>
#include <common/algorithms/coulomb_solver.h>
#include <common/discretization/discrete_problem.h>
#include <common/nodes/condensation.h>
#include <common/nodes/elimination_tree.h>
#include <common/nodes/places.h>

#include <deal.II/base/point.h>

#include <memory>
#include <vector>

namespace Friction
{
  /**
   * Solves the discrete contact problem on the contact nodes alone: all others
   * are condensed, see Condensation, and what remains is the same problem with
   * a dense matrix, for which CoulombSolver needs no levels. Coarse functions
   * have no part in it, so that no material and no shape of cells can make them
   * fail. The matrix is factorised whatever the phases turn out to be, where
   * Newton's method with a direct solver does so for each set of phases.
   *
   * That is the right thing to do as long as it is cheap: the work grows with
   * the power 3/2 of the number of unknowns in two dimensions, and with its
   * square in three.
   *
   * Of the contact nodes only those are kept that are in the ContactZone of the
   * guess. If the solution takes others into the obstacle, the zone grows, and
   * the matrix is factorised once more.
   *
   * Where the laws themselves are the trouble, Newton's method solves the same
   * small problem, see NewtonSolver and DenseNewtonStep, or in two dimensions
   * complementary pivoting, see solve_by_pivoting().
   *
   * All processes have the whole matrix and factorise it; the first one solves
   * for all of them.
   */
  template <int dim>
  class CondensedSolver
  {
  public:
    /// Cycles beyond which it is never worth while.
    static constexpr double most_cycles = (dim == 2 ? 800. : 400.);

    /**
     * Collective.
     * @param problem    kept by reference.
     * @param positions  of the nodes that this process owns.
     * @param settings   sweeps, local solver and truncation, and whether
     *                   Newton's method may finish.
     * @param guess      that solve() is likely to begin with: its zone is what
     *                   is kept at first.
     */
    CondensedSolver(const DiscreteProblem<dim>    &problem,
                    const std::vector<Point<dim>> &positions,
                    const SolverSettings          &settings,
                    const Iterate                 &guess);

    ~CondensedSolver();

    /** Whether, with the zone of the moment, it takes no longer than so many
     * multigrid cycles, of a material that is neither stiff in parts nor nearly
     * incompressible; never if it takes more than most_cycles. The same on all
     * processes. */
    bool is_worthwhile(const double n_cycles) const;

    /** Unknowns of the condensed problem, with the zone of the moment; zero if
     * it is never worth while. The same on all processes. */
    unsigned int n_unknowns() const;

    /** Has solve() end without a solution if the zone grows so that it takes
     * longer than so many cycles, or than most_cycles, which is the limit at
     * first. */
    void
    give_up_beyond(const double n_cycles)
    {
      limit = n_cycles;
    }

    /** Whether that has happened, or the matrix could not be factorised. */
    bool
    has_given_up() const
    {
      return !is_worthwhile(limit);
    }

    /// What solves the condensed problem.
    enum class By
    {
      coulomb_solver,
      newton_solver,
      pivoting ///< in two dimensions
    };

    /**
     * As CoulombSolver::solve(); collective. The cycles that are reported are
     * those of the condensed problem, which cost next to nothing, or steps of
     * Newton's method, or what takes as long.
     * @param functional  of the problem.
     */
    SolverReport solve(const TrescaFunctional<dim> &functional,
                       Iterate                      x,
                       const By                     method,
                       const CoulombSettings       &limits,
                       const Progress              &progress);

    /** In bytes, on this process. */
    std::size_t memory_consumption() const;

  private:
    const DiscreteProblem<dim> &problem;
    const SolverSettings        settings;

    // The rows of all processes' nodes, on several processes; the matrix of the
    // problem, on one.
    NodeBlockMatrix<dim>        gathered;
    const NodeBlockMatrix<dim> *matrix;

    // Of all nodes: those that take no part hang or are held altogether.
    Places            positions;
    std::vector<char> is_held, is_absent;

    // Nodes in the zone are kept.
    std::unique_ptr<ContactZone<dim>>  zone;
    std::unique_ptr<EliminationTree>   tree;
    std::unique_ptr<Condensation<dim>> condensation;
    bool                               has_failed = false;
    double                             limit      = most_cycles;

    void gather_nodes(const std::vector<Point<dim>> &own_positions);

    void gather_matrix();

    bool grow_zone(const Iterate &x);
    void keep_zone();
    bool factorize();

    // What happens in the zone as it is.
    SolverReport solve_in_zone(const TrescaFunctional<dim> &functional,
                               Iterate                     &x,
                               const By                     method,
                               const CoulombSettings       &limits,
                               const Progress              &progress);

    struct Small;
    std::unique_ptr<Small> make_small_problem(const VectorType &u) const;

    // The first process has this for as long as it solves.
    struct SmallSolver;

    unsigned int first_own_node() const;
    ContactState gather_state(const ContactState &own) const;
    void scatter_state(const ContactState &of_zone, ContactState &own) const;

    void share(SolverReport &report, VectorType &u, ContactState &state) const;
  };
} // namespace Friction

#endif

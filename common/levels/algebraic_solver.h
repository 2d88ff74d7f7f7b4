#ifndef friction_levels_algebraic_solver_h
#define friction_levels_algebraic_solver_h

#include <common/levels/sparse_factors.h>
#include <common/levels/trilinos_names.h>
#include <common/nodes/nodal_constraints.h>
#include <common/parameters/solver_settings.h>

#include <functional>
#include <memory>
#include <optional>

namespace Friction
{
  /**
   * Solves linear systems of which nothing is known but the matrix: by
   * SparseFactors as long as that is the quicker way, otherwise by conjugate
   * gradients preconditioned with the algebraic multigrid of Trilinos (smoothed
   * aggregation, Vanek, Mandel, Brezina 1996).
   *
   * The matrix is symmetric and positive definite, up to directions that right
   * hand sides have no part in; its rows may be owned by any of the processes,
   * all of a node's components by the same one.
   *
   * Matrices of contact problems change a little whenever a node changes its
   * phase. The hierarchy of algebraic multigrid is not made anew each time,
   * because it is only a preconditioner: it is kept, together with a copy of
   * the matrix it was made of, until conjugate gradients take noticeably longer
   * than they did when it was new. The copy is what keeps the preconditioner
   * positive definite; smoothers that had seen one matrix and are applied to
   * another might not be.
   *
   * Within a multigrid cycle a few digits are enough. Iterations stop when the
   * energy norm of the error, as the preconditioner sees it, has come down to
   * #tolerance. Stopping early is no harm to a descent method: each iterate of
   * conjugate gradients that start at zero lowers the energy more than the one
   * before.
   */
  class AlgebraicSolver
  {
  public:
    /// Projects onto a subspace, orthogonally.
    using Projection = std::function<void(VectorType &)>;

    /** Relative energy norm of the error at which conjugate gradients stop. */
    static constexpr double tolerance = 1e-3;

    /** Up to this number of unknowns CoarsestMethod::automatic is direct. It is
     * also where algebraic multigrid itself stops coarsening. */
    static constexpr types::global_dof_index largest_direct_size = 2000;

    /** Beyond, it is so for long and thin bodies: as long as elimination_cost()
     * is no more than this, a sixth of what it is for so many unknowns on a
     * square, and the number of unknowns one that a single process may hold.
     * The matrix of a body that is thousands of times as long as thick is so
     * badly conditioned that its factors are a preconditioner only. */
    static constexpr double                  largest_direct_cost = 1e7;
    static constexpr types::global_dof_index largest_thin_size   = 100000;

    /**
     * @param n_components  of a node; component c of node i has the number
     *                      n_components * i + c.
     */
    AlgebraicSolver(const CoarsestMethod method,
                    const unsigned int   n_components);
    ~AlgebraicSolver();

    /**
     * Is told the matrix for the calls of solve() that follow, and again
     * whenever its entries have changed. It is kept by reference.
     */
    void initialize(const TrilinosWrappers::SparseMatrix &matrix);

    /** Solves A x = b; the initial value of x does not matter. */
    void solve(VectorType &x, const VectorType &b);

    /**
     * Minimises $\frac12 x^TAx-b^Tx$ in a subspace, by conjugate gradients;
     * what the solver has prepared for the whole space is projected to serve as
     * the preconditioner. If the subspace lacks few directions only, these cost
     * one iteration each at most.
     */
    void solve_in_subspace(VectorType       &x,
                           const VectorType &b,
                           const Projection &project);

    bool
    is_direct() const
    {
      return factors != nullptr;
    }

    /** Conjugate gradient iterations in the last solution; 0 if it was direct,
     * and not by factors as a preconditioner. */
    unsigned int
    n_iterations() const
    {
      return last_iterations;
    }

    /** How often a factorisation or a hierarchy has been made. */
    unsigned int
    n_setups() const
    {
      return setups;
    }

  private:
    enum class Outcome
    {
      converged,
      slow,  // too many iterations; what there is lowers the energy
      broken // a direction without energy
    };

    const CoarsestMethod                  method;
    const unsigned int                    n_components;
    const TrilinosWrappers::SparseMatrix *matrix = nullptr;

    // Factors, and the matrix they belong to if that is not the given one.
    std::unique_ptr<TrilinosWrappers::SparseMatrix> shifted;
    std::unique_ptr<SparseFactors>                  factors;

    std::unique_ptr<TrilinosWrappers::SparseMatrix>    hierarchy_matrix;
    std::unique_ptr<TrilinosWrappers::PreconditionAMG> hierarchy;

    // Whether elimination of many unknowns is cheap; found out at the first
    // matrix of so many.
    std::optional<bool> is_thin;

    bool         is_current      = false; // made of the present matrix
    bool         is_worn_out     = false; // the hierarchy
    unsigned int new_iterations  = 0;     // when the hierarchy was new
    unsigned int last_iterations = 0;
    unsigned int setups          = 0;

    VectorType residual, direction, preconditioned, image;

    bool wants_factorization();

    void factorize();

    void make_hierarchy();

    void iterate(VectorType &x, const VectorType &b, const Projection &project);

    Outcome conjugate_gradients(VectorType       &x,
                                const VectorType &b,
                                const Projection &project);

    void precondition(VectorType &x, const VectorType &b);
  };
} // namespace Friction

#endif

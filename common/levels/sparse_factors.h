#ifndef friction_levels_sparse_factors_h
#define friction_levels_sparse_factors_h

#include <common/levels/trilinos_names.h>
#include <common/nodes/nodal_constraints.h>

#include <deal.II/lac/solver_control.h>

#include <memory>

namespace Friction
{
  /**
   * A factorisation of a sparse, symmetric and positive definite matrix.
   *
   * On one process it is Cholesky's, by Eigen, in an order of approximate
   * minimum degree (Amestoy, Davis and Duff 1996): half the operations of
   * an LU factorisation without knowledge of the symmetry, and in three
   * dimensions a quarter of its time. On several processes it is that of
   * Trilinos, which does all on the first one.
   */
  class SparseFactors
  {
  public:
    SparseFactors();
    ~SparseFactors();

    /**
     * Collective; the matrix is not needed any more afterwards. Later matrices
     * have the pattern of the first one.
     * @return whether the matrix is positive definite, up to rounding (on
     * several processes: whether no pivot is zero); if not, nothing can be
     * solved. The same on all processes.
     */
    bool factorize(const TrilinosWrappers::SparseMatrix &matrix);

    /** A x = b. Collective. */
    void solve(VectorType &x, const VectorType &b) const;

  private:
    struct Cholesky;
    std::unique_ptr<Cholesky> cholesky;

    SolverControl                                   control;
    std::unique_ptr<TrilinosWrappers::SolverDirect> by_trilinos;
  };
} // namespace Friction

#endif

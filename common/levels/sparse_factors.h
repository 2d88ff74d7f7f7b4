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
   * minimum degree (Amestoy, Davis and Duff 1996). In three dimensions it takes
   * a third of the time of an LU factorisation that does not know of the
   * symmetry, see doc/benchmark/coarsest.txt. On several processes it is that
   * of Trilinos, LU on the first one.
   */
  class SparseFactors
  {
  public:
    SparseFactors();
    ~SparseFactors();

    /**
     * Collective. The matrix is kept by reference. Later ones have its pattern.
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

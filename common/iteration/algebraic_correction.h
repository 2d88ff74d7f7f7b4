#ifndef friction_iteration_algebraic_correction_h
#define friction_iteration_algebraic_correction_h

#include <common/iteration/correction.h>
#include <common/levels/algebraic_solver.h>

#include <memory>

namespace Friction
{
  /**
   * Solves the truncated linear problem $T(A+\omega'')T\,v=r$ on the leaf mesh
   * as it stands, by AlgebraicSolver: the counterpart of TruncatedCorrection
   * for meshes or materials whose coarse levels are of no help, such as cells
   * that are short in two of three directions.
   *
   * With it a step of the iteration becomes one of Newton's method, between two
   * relaxations that keep it admissible and descending. It costs a
   * factorisation, or many iterations of conjugate gradients, where
   * TruncatedCorrection costs a few sweeps.
   */
  template <int dim>
  class AlgebraicCorrection : public Correction<dim>
  {
  public:
    /** Collective. @p problem is kept by reference. */
    AlgebraicCorrection(const DiscreteProblem<dim> &problem,
                        const CoarsestMethod        method);
    AlgebraicCorrection(DiscreteProblem<dim> &&, const CoarsestMethod) = delete;
    ~AlgebraicCorrection() override;

    void update(const Linearization<dim> &linearization,
                const Iterate            &x) override;

    void apply(VectorType &v, const VectorType &r) override;

    /** Of the matrix, in bytes; the solver's own memory is Trilinos'. */
    std::size_t memory_consumption() const override;

  private:
    const DiscreteProblem<dim>                     &problem;
    Truncation<dim>                                 current;
    std::unique_ptr<TrilinosWrappers::SparseMatrix> matrix;
    AlgebraicSolver                                 solver;
    VectorType                                      rhs, solution;
    double                                          scale     = 0.;
    bool                                            is_filled = false;

    void fill();
  };
} // namespace Friction

#endif

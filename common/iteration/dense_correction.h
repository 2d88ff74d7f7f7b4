#ifndef friction_iteration_dense_correction_h
#define friction_iteration_dense_correction_h

#include <common/iteration/correction.h>

#include <vector>

namespace Friction
{
  /**
   * Solves the truncated linear problem $T(A+\omega'')T\,v=r$ by a dense
   * Cholesky factorisation: for problems whose matrix is dense, as that of
   * CondensedSolver, all of whose nodes are on this process.
   */
  template <int dim>
  class DenseCorrection : public Correction<dim>
  {
  public:
    /** @p problem is kept by reference. */
    explicit DenseCorrection(const DiscreteProblem<dim> &problem);
    explicit DenseCorrection(DiscreteProblem<dim> &&) = delete;

    void update(const Linearization<dim> &linearization,
                const Iterate            &x) override;

    void apply(VectorType &v, const VectorType &r) override;

    std::size_t
    memory_consumption() const override
    {
      return factor.capacity() * sizeof(double);
    }

  private:
    const DiscreteProblem<dim> &problem;
    Truncation<dim>             current;
    bool                        is_factorised = false;

    // The lower triangle of the Cholesky factor, column by column.
    std::vector<double> factor;

    void fill(const double shift);
  };
} // namespace Friction

#endif

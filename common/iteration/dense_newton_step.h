#ifndef friction_iteration_dense_newton_step_h
#define friction_iteration_dense_newton_step_h

#include <common/iteration/newton_equations.h>

#include <vector>

namespace Friction
{
  /**
   * Solves the equations of a step of Newton's method by a dense factorisation
   * with pivots, in the directions that are free: for problems whose matrix is
   * dense, as that of CondensedSolver, all of whose nodes are on this process.
   */
  template <int dim>
  class DenseNewtonStep : public NewtonStep<dim>
  {
  public:
    void update(const NewtonEquations<dim> &equations) override;

    typename NewtonStep<dim>::Outcome
    solve(VectorType        &v,
          const VectorType  &r,
          const double       accuracy,
          const unsigned int maximum_iterations) override;

    std::size_t
    memory_consumption() const override
    {
      return matrix.capacity() * sizeof(double);
    }

  private:
    const NewtonEquations<dim> *equations = nullptr;

    // The directions in which nodes are free, and to which node each belongs;
    // those of node i are first[i], ..., first[i+1]-1.
    std::vector<NodeValue<dim>> directions;
    std::vector<unsigned int>   first;

    // Their equations, by columns; room of it is kept from step to step.
    std::vector<double> matrix;

    void find_directions();

    void fill(const double shift);
  };
} // namespace Friction

#endif

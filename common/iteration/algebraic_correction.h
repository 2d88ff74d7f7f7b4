#ifndef friction_iteration_algebraic_correction_h
#define friction_iteration_algebraic_correction_h

#include <common/nodes/nodal_constraints.h>
#include <common/levels/algebraic_solver.h>
#include <common/nodes/node_block_matrix.h>
#include <common/nodes/truncation.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>

namespace Friction
{
  /**
   * Solves the truncated linear problem $T(A+\omega'')T\,v=r$ on the leaf mesh
   * as it stands, by AlgebraicSolver: the counterpart of CoarseCycle for meshes
   * or materials whose coarse levels are of no help, such as cells a thousand
   * times longer than wide.
   *
   * With it a step of the iteration becomes one of Newton's method, between two
   * relaxations that keep it admissible and descending. It costs a
   * factorisation, or many iterations of conjugate gradients, where CoarseCycle
   * costs a few sweeps.
   */
  template <int dim>
  class AlgebraicCorrection
  {
  public:
    /** Collective. References are kept. */
    AlgebraicCorrection(const NodeBlockMatrix<dim>  &leaf_matrix,
                        const NodalConstraints<dim> &constraints,
                        const CoarsestMethod         method);

    /** Follows a change of phases. Collective. */
    void update(const Truncation<dim> &truncation);

    /** v := solution for the truncated residual @p r; zero where truncated and
     * at hanging nodes. Collective. */
    void apply(VectorType &v, const VectorType &r);

    /** Of the matrix, in bytes; the solver's own memory is Trilinos'. */
    std::size_t memory_consumption() const;

  private:
    const NodeBlockMatrix<dim>    &leaf_matrix;
    const NodalConstraints<dim>   &constraints;
    Truncation<dim>                current;
    TrilinosWrappers::SparseMatrix matrix;
    AlgebraicSolver                solver;
    VectorType                     rhs, solution;
    double                         scale     = 0.;
    bool                           is_filled = false;

    void fill();
  };
} // namespace Friction

#endif

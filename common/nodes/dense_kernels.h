#ifndef friction_nodes_dense_kernels_h
#define friction_nodes_dense_kernels_h

namespace Friction
{
  /**
   * Factorisations of dense matrices, by Eigen, compiled for several sets of
   * Instructions: from some hundred rows on they take less than half of the
   * time with AVX2, for which GCC can compile them. Matrices are stored column
   * by column, without gaps.
   */
  namespace DenseKernels
  {
    /**
     * Eliminates the first unknowns of a symmetric matrix, of which only the
     * lower triangle is read and written. In blocks, with those in front, its
     * first columns become Cholesky's factor of $A_{11}=LL^T$ and
     * $A_{21}L^{-T}$, and $A_{22}$ the Schur complement
     * $A_{22}-A_{21}A_{11}^{-1}A_{12}$.
     * @param n             rows of the matrix.
     * @param n_eliminated  rows of $A_{11}$; if all, this is Cholesky's
     *                      factorisation.
     * @return whether $A_{11}$ is positive definite; if not, what is in the
     *         matrix is of no use. Rounding errors may make a singular one
     *         positive definite, which small squares on the diagonal of L
     *         betray.
     */
    bool eliminate(double            *matrix,
                   const unsigned int n,
                   const unsigned int n_eliminated);

    /**
     * A x = b, by Gaussian elimination with partial pivoting.
     * @param matrix  any, with n > 0 rows; on return its factors, U with its
     *                diagonal above the unit lower triangle.
     * @param x       n values of b; on return the solution.
     */
    void solve(double *matrix, double *x, const unsigned int n);
  } // namespace DenseKernels
} // namespace Friction

#endif

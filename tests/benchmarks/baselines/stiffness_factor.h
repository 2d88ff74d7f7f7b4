#ifndef friction_tests_benchmarks_stiffness_factor_h
#define friction_tests_benchmarks_stiffness_factor_h

#include <tests/benchmarks/baselines/rotated_problem.h>

#include <memory>
#include <vector>

namespace Benchmark
{
  /**
   * A dense matrix, column by column.
   */
  struct DenseMatrix
  {
    explicit DenseMatrix(const std::size_t n = 0)
      : n(n)
      , values(n * n, 0.)
    {}

    double &
    operator()(const std::size_t i, const std::size_t j)
    {
      return values[j * n + i];
    }

    double
    operator()(const std::size_t i, const std::size_t j) const
    {
      return values[j * n + i];
    }

    std::size_t         n;
    std::vector<double> values;
  };

  /** Replaces b by the solution of A x = b; A is destroyed. LAPACK's LU
   * decomposition with pivoting. */
  void solve_dense(DenseMatrix &A, std::vector<double> &b);

  /**
   * The sparse Cholesky factor L of the stiffness matrix in which chosen
   * contact nodes come last. Its trailing block is the Cholesky factor of the
   * Schur complement
   * @f[ S = A_{cc} - A_{ci} A_{ii}^{-1} A_{ic}
   *       = L_{cc} L_{cc}^T @f]
   * on these nodes, dense, and free of charge; solutions for given values of
   * them take one forward and one backward substitution, whatever has been
   * found out about contact in between.
   *
   * CHOLMOD factorises, supernode by supernode, all other nodes in the order of
   * METIS' nested dissection. Nodes instead of degrees of freedom are ordered,
   * which is quicker.
   */
  template <int dim>
  class StiffnessFactor
  {
  public:
    /** @param last  the numbers of the contact nodes that come last. */
    StiffnessFactor(const RotatedProblem<dim>       &rotated,
                    const std::vector<unsigned int> &last);

    ~StiffnessFactor();

    /** The chosen contact nodes. */
    const std::vector<unsigned int> &
    nodes() const
    {
      return last;
    }

    /** The position of component e of the i-th chosen node in the dense block;
     * all components that are not prescribed have one. */
    unsigned int
    position(const unsigned int i, const unsigned int e) const
    {
      return first[i] + e;
    }

    unsigned int
    n_dense() const
    {
      return first.back();
    }

    /** The Schur complement. */
    const DenseMatrix &
    schur_complement() const
    {
      return S;
    }

    /** Eliminates all but the chosen nodes from a right hand side in frames,
     * and returns what remains; it is kept for solve(). */
    std::vector<double> reduce(const VectorType &b);

    /** The solution for given values at the chosen nodes; zero where it is
     * fixed. */
    void solve(VectorType &x, const std::vector<double> &values) const;

    std::size_t memory_consumption() const;

  private:
    struct Cholmod;

    const RotatedProblem<dim>      &rotated;
    const std::vector<unsigned int> last;
    std::vector<unsigned int>       first; // of each chosen node
    std::vector<std::size_t>        order; // degree of freedom by row of A
    std::unique_ptr<Cholmod>        cholmod;
    DenseMatrix                     S;

    std::vector<unsigned int> order_other_nodes() const;
    void                      factorize();
    void                      extract_schur_complement();
  };
} // namespace Benchmark

#endif

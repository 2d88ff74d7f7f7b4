#ifndef friction_nodes_condensation_h
#define friction_nodes_condensation_h

#include <common/nodes/elimination_tree.h>
#include <common/nodes/node_block_matrix.h>

#include <memory>
#include <vector>

namespace Friction
{
  /**
   * Static condensation (Guyan 1965): all nodes but some, here those near
   * the contact zone, are eliminated from $Au=f$ once and for all. With c for
   * the nodes that are kept and i for the others,
   * @f[ S\,u_c = f_c - A_{ci}A_{ii}^{-1}f_i, \qquad
   *     S = A_{cc} - A_{ci}A_{ii}^{-1}A_{ic}, \qquad
   *     u_i = A_{ii}^{-1}(f_i-A_{ic}u_c). @f]
   * This holds whatever law the nodes that are kept obey, so that a contact
   * problem becomes one of contact nodes alone, with a dense matrix; and it
   * holds for any material.
   *
   * The matrix is factorised by the multifrontal method, front by front of an
   * EliminationTree, with dense Cholesky factorisations.
   *
   * All nodes are on this process.
   */
  template <int dim>
  class Condensation
  {
  public:
    /**
     * References are kept.
     * @param tree       of the pattern of the matrix.
     * @param is_held    of each degree of freedom: its rows and columns are
     *                   left out, and so is its value.
     */
    Condensation(const EliminationTree &tree, const std::vector<char> &is_held);

    ~Condensation();

    /**
     * May be called again, with a matrix of the same pattern.
     * @param matrix  symmetric.
     * @return whether it is positive definite on what is eliminated, up to
     *         rounding; if not, nothing else may be asked.
     */
    bool factorize(const NodeBlockMatrix<dim> &matrix);

    /** The block of S that couples the kept nodes i and j, column by column;
     * kept nodes are numbered as in the last front of the tree. */
    NodeBlock<dim> block(const unsigned int i, const unsigned int j) const;

    /**
     * Eliminates from a right hand side.
     * @param f  of all nodes; on return of kept nodes
     *           $f_c-A_{ci}A_{ii}^{-1}f_i$, and of others something that
     *           expand() wants.
     */
    void reduce(std::vector<double> &f) const;

    /**
     * @param u  what reduce() has left of the right hand side, but at kept
     *           nodes their displacement $u_c$; on return the displacement of
     *           all nodes.
     */
    void expand(std::vector<double> &u) const;

    /** In bytes. */
    std::size_t memory_consumption() const;

  private:
    // Matrices are Eigen's, which not everybody needs to know.
    struct Factors;

    const EliminationTree   &tree;
    const std::vector<char> &is_held;
    std::unique_ptr<Factors> factors;
  };
} // namespace Friction

#endif

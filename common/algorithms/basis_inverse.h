#ifndef friction_algorithms_basis_inverse_h
#define friction_algorithms_basis_inverse_h

#include <cstddef>
#include <vector>

namespace Friction
{
  /**
   * The inverse of a matrix whose columns are exchanged one by one, as a
   * product (Dantzig and Orchard-Hays 1954): a factorisation of the matrix at
   * the beginning, and one elementary matrix for each column that has been
   * exchanged since. At the beginning some columns are those of a symmetric
   * positive definite matrix S, and the others those of the identity.
   */
  class BasisInverse
  {
  public:
    /**
     * @param S         n times n, by columns; kept by reference.
     * @param is_unit   of each column, whether it is one of the identity.
     * @return whether S is positive definite where it matters.
     */
    bool factorize(const std::vector<double> &S,
                   const std::vector<char>   &is_unit);

    /** The inverse of the beginning once more. */
    void
    undo_all()
    {
      changes.clear();
    }

    /** Replaces n values by the inverse times them. */
    void apply(std::vector<double> &x) const;

    /** A column is exchanged for another one.
     * @param position  which one.
     * @param image     the inverse times the new column. Its value at this
     *                  position must not vanish. */
    void exchange(const unsigned int         position,
                  const std::vector<double> &image);

    /** The column at position @p to is subtracted @p factor times from that at
     * @p from: in the inverse a row is added to another one. */
    void add_row(const unsigned int to,
                 const unsigned int from,
                 const double       factor);

    /** So far. */
    double
    n_multiplications() const
    {
      return n_products;
    }

    /** In bytes. */
    std::size_t memory_consumption() const;

  private:
    const std::vector<double> *matrix = nullptr;

    // The columns that are not those of the identity, the others, and
    // Cholesky's factor.
    std::vector<unsigned int> columns, units;
    std::vector<double>       factor;

    // With a vector it is an exchange, otherwise the addition of a row.
    struct Change
    {
      unsigned int        position, from;
      double              factor;
      std::vector<double> image;
    };
    std::vector<Change> changes;

    mutable double n_products = 0;
  };
} // namespace Friction

#endif

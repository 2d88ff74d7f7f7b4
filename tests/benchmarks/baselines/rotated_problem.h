#ifndef friction_tests_benchmarks_rotated_problem_h
#define friction_tests_benchmarks_rotated_problem_h

#include <common/discretization/discrete_problem.h>

#include <vector>

namespace Benchmark
{
  using namespace Friction;

  /**
   * The discrete problem in the frames of the contact nodes, as Newton's method
   * wants it: at a contact node component 0 of a vector is the normal one, the
   * others are the tangential ones; at all other nodes nothing is changed. In
   * these coordinates prescribed values, contact and stick each fix single
   * components.
   */
  template <int dim>
  class RotatedProblem
  {
  public:
    explicit RotatedProblem(const DiscreteProblem<dim> &problem);

    /** Prescribed, or at a hanging node: no unknown. */
    bool
    is_fixed(const std::size_t dof) const
    {
      return fixed[dof];
    }

    std::size_t
    n_dofs() const
    {
      return fixed.size();
    }

    /** The number of the contact node at a node, or
     * numbers::invalid_unsigned_int.
     */
    unsigned int
    contact_number(const unsigned int node) const
    {
      return contact_numbers[node];
    }

    /** Changes a vector from components along the axes to those in frames. */
    void to_frames(VectorType &v) const;

    /** The opposite. */
    void from_frames(VectorType &v) const;

    /** The block of the stiffness matrix at a position of a row, in frames. */
    NodeBlock<dim> block(const unsigned int row,
                         const std::size_t  position) const;

    /** y = A x in frames. */
    void vmult(VectorType &y, const VectorType &x) const;

    /** f - A u in frames, of a displacement @p u along the axes. */
    VectorType residual(const VectorType &u) const;

    const DiscreteProblem<dim> problem;

  private:
    std::vector<char>         fixed;
    std::vector<unsigned int> contact_numbers;
    mutable VectorType        along_axes;
  };
} // namespace Benchmark

#endif

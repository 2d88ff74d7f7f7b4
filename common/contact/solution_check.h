#ifndef friction_contact_solution_check_h
#define friction_contact_solution_check_h

#include <common/contact/contact_state.h>
#include <common/discretization/discretization.h>

#include <string>

namespace Friction
{
  /** What is to be said about what a solver has certified. */
  struct SolutionCheck
  {
    /// Whether it may be called a solution.
    bool is_solution = true;

    /// Why not, or what to be warned of; empty if all is well.
    std::string sentence;
  };



  /**
   * A certificate speaks of nodes, one by one. This asks two questions about
   * the whole body at a displacement that has one.
   *
   * Is it larger than a thousand times the body? Then something has not held
   * it.
   *
   * Do all forces on the body balance, see ForceBalance? Each node may be in
   * equilibrium to the last digit of the forces between neighbours, and still
   * these digits be larger than the loads: in bodies ten thousand times as long
   * as thick, or where materials are too far apart. The rest that is missing is
   * compared with the sum of the norms of loads at nodes, so that a moment,
   * whose forces have no sum, has a size; or with the forces that are wanted of
   * platens, or those of obstacles at nodes in contact, if these are larger. If
   * it is more than ten times the tolerance there is a warning. If it is more
   * than a hundred times the tolerance, or a third, and no more than rounding
   * errors explain, so that no further iteration would make it less, then
   * nothing of a solution is left.
   *
   * What holds the body does not count, since a lever makes it large; but loads
   * and contact that are small parts of it are no measure of anything. Where
   * nothing acts on the body there is nothing to balance.
   *
   * Collective; all processes get the same.
   *
   * @param state      which nodes are in contact.
   * @param tolerance  of the certificate.
   */
  template <int dim>
  SolutionCheck check_solution(const Discretization<dim> &discretization,
                               const VectorType          &displacement,
                               const ContactState        &state,
                               const double               tolerance);
} // namespace Friction

#endif

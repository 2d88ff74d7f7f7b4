#ifndef friction_contact_local_problem_h
#define friction_contact_local_problem_h

#include <common/contact/slip_problem.h>

#include <common/parameters/solver_settings.h>

#include <array>

namespace Friction
{
  /**
   * The solution of a local contact problem, in the frame of the node.
   */
  template <int dim>
  struct LocalSolution
  {
    double                      normal;
    std::array<double, dim - 1> tangential;
    bool                        in_contact;
    bool                        sticks;
  };



  /**
   * The local problem (6.15) at one node of the contact boundary: minimise
   * @f[ \tfrac12 z^T a z - b^T z + s |z_T| \quad\text{over } z_n \le g @f]
   * where $a$ is the diagonal block of the stiffness matrix in the frame of the
   * node, $b$ the force that the other nodes leave, and $s = F\tau$ the bound
   * of the tangential force.
   *
   * The problem is strictly convex and is solved exactly: first without the
   * obstacle, eliminating $z_n$ by its Schur complement; if that penetrates,
   * with $z_n = g$. Either way a problem in the tangential plane remains,
   * (6.18), the SlipProblem. In two dimensions its unit sphere has just two
   * points, so that stick, or slip to one side or the other, can be told from
   * the force alone; in three it is a circle, and the direction of slip has to
   * be found.
   *
   * Units: $z$ and $g$ are displacements, $b$ and $s$ nodal forces.
   */
  template <int dim>
  class LocalProblem
  {
  public:
    /**
     * @param block           the diagonal block in the frame of the node,
     *                        column by column, normal first. Must be symmetric
     *                        positive definite.
     * @param gap             $g$.
     * @param n_free_tangents number of tangential directions that can move,
     *                        the first ones of the frame.
     * @param solver          how the direction of slip is found if there are
     *                        two of them; otherwise it makes no difference.
     */
    LocalProblem(const std::array<double, dim * dim> &block,
                 const double                         gap,
                 const unsigned int                   n_free_tangents,
                 const LocalSolver solver = LocalSolver::secular_equation);

    /**
     * Solves the problem.
     * @param b           forces in the frame.
     * @param bound       $s \ge 0$; zero means no friction.
     * @param before      the tangential displacement before: what cannot move
     *                    stays, and of the others it is a guess that does not
     *                    change the solution.
     * @param contact_is_likely  which of the two cases to try first: this does
     *                    not change the solution, but with a good guess only
     *                    one slip problem has to be solved.
     */
    LocalSolution<dim> solve(const std::array<double, dim>     &b,
                             const double                       bound,
                             const std::array<double, dim - 1> &before,
                             const bool contact_is_likely = false) const;

  private:
    double                      a_nn;
    std::array<double, dim - 1> a_tn;
    double                      gap;
    unsigned int                n_free_tangents;

    SlipProblem<dim - 1> open;    // z_n eliminated
    SlipProblem<dim - 1> contact; // z_n = g
  };
} // namespace Friction

#endif

#ifndef friction_contact_slip_problem_h
#define friction_contact_slip_problem_h

#include <common/parameters/solver_settings.h>

#include <array>

namespace Friction
{
  /**
   * The slip problem: minimise
   * @f[ \tfrac12 v^T A v - b^T v + s |v| \quad\text{over } v \in R^n @f]
   * with a symmetric positive definite matrix $A$ and $s \ge 0$. It is what
   * remains of a local contact problem once the normal displacement is known
   * or eliminated: $v$ is the tangential displacement, $b$ the tangential force
   * without friction, and $s$ the bound of friction. Some components of $v$ may
   * be prescribed; then the minimum is taken over the others.
   *
   * By Lemma 6.5 the minimiser is characterised by $b - A v = s v/|v|$ if
   * $v\not=0$, and by $|b| \le s$ if $v=0$: friction holds the node as long as
   * it can. In one dimension, $n=1$, that leaves $v = (b \mp s)/A$.
   */
  template <int n>
  class SlipProblem;



  template <>
  class SlipProblem<1>
  {
  public:
    SlipProblem(const std::array<double, 1> &A,
                const unsigned int           n_free_components,
                const LocalSolver            solver);

    std::array<double, 1> solve(const std::array<double, 1> &b,
                                const double                 s,
                                const std::array<double, 1> &prescribed) const;

  private:
    double       a;
    unsigned int n_free_components;
  };



  /**
   * The slip problem in a plane. What is new is that the direction of slip is
   * sought, too. In the eigenbasis of $A$, where
   * $\lambda_1 \ge \lambda_2$ are the eigenvalues, and with $S = |v|$,
   * $n = v/|v|$, the inclusion reads
   * @f[ (S \lambda_i + s) n_i = b_i, \quad i = 1,2, \quad |n| = 1. @f]
   *
   * To eliminate $n$ gives the secular equation
   * $|(S A + s I)^{-1} b| = 1$ for $S$, known from trust region methods. The
   * method of choice there, Newton's for $1/|(S A + s I)^{-1} b|$, converges
   * from below without any safeguard since that function is concave. But $S$
   * only grows by a factor of 3/2 per step as long as it is much too small,
   * which happens if $|b_2|$ is slightly less than $s$ and $\lambda_2$ is
   * small. To eliminate $S$ instead gives an equation for the direction alone:
   * $t = |n_2/n_1|$ is the only positive solution of
   * @f[ \lambda_2 |b_1| t
   *     + (\lambda_1-\lambda_2) s \frac{t}{\sqrt{1+t^2}}
   *     = \lambda_1 |b_2|. @f]
   * The left side increases, from zero, and is concave; written for $1/t$ where
   * $t>1$ it is convex. There are close bounds to start from, and four steps
   * are enough. Nothing special happens where the slip vanishes, $|b| \to s$,
   * since the direction does not: Newton's method for $v$ itself fails there
   * (Remark 6.6). Finally, the square of the inclusion,
   * @f[ |b|^2 - s^2 = 2 s S\, n^T A n + S^2 |A n|^2, @f]
   * is a quadratic equation for $S$ whose terms are all positive, so that $S$
   * is as accurate as $|b|^2-s^2$ is.
   *
   * If one component is prescribed, $v_2 = w \not= 0$, the other one solves
   * $A_{11} v_1 + s v_1/\sqrt{v_1^2+w^2} = b_1 - A_{12} w$, the same equation
   * with $t=v_1/|w|$.
   */
  template <>
  class SlipProblem<2>
  {
  public:
    /**
     * Computes the eigenbasis.
     * @param A                  column by column; of the off-diagonal entries
     *                           only the first one is used.
     * @param n_free_components  the first ones are free, the others are
     *                           prescribed.
     * @param solver             how the problem with two free components is
     *                           solved.
     */
    SlipProblem(const std::array<double, 4> &A,
                const unsigned int           n_free_components,
                const LocalSolver            solver);

    /**
     * Solves the problem.
     * @param prescribed  values of the components that are; the others are
     *                    ignored.
     */
    std::array<double, 2> solve(const std::array<double, 2> &b,
                                const double                 s,
                                const std::array<double, 2> &prescribed) const;

    /**
     * The minimiser over all $v$ by the equation for the direction of slip,
     * to rounding.
     * @param n_iterations  if given, where to put the number of iterations.
     */
    std::array<double, 2>
    solve_secular_equation(const std::array<double, 2> &b,
                           const double                 s,
                           unsigned int *n_iterations = nullptr) const;

    /**
     * The same by a Uzawa method [Glo84, p. 170], the thesis's choice: with
     * the tangential force $s\mu$, $|\mu|\le1$, as multiplier
     * @f[ v = A^{-1} (b - s \mu), \quad
     *     \mu \leftarrow P(\mu + \rho s v), @f]
     * where $P$ projects onto the unit disc. This is the projected gradient
     * method for the dual problem; $\rho s^2 = 2/(1/\lambda_1+1/\lambda_2)$ is
     * its best step length. The error falls by
     * $(\lambda_1-\lambda_2)/(\lambda_1+\lambda_2)$ per step or faster, so that
     * the number of steps grows like the condition number of $A$. For blocks
     * of a stiffness matrix on elements of decent shape that is a small
     * number; for others it is not.
     *
     * The iteration ends as soon as the inclusion holds up to
     * uzawa_tolerance*|b|. If it does not after maximum_uzawa_steps, the
     * problem is solved by the secular equation.
     *
     * @param n_iterations  if given, where to put the number of steps; more
     * than maximum_uzawa_steps if that was not enough.
     */
    std::array<double, 2>
    solve_uzawa(const std::array<double, 2> &b,
                const double                 s,
                unsigned int                *n_iterations = nullptr) const;

    static constexpr double       uzawa_tolerance     = 1e-12;
    static constexpr unsigned int maximum_uzawa_steps = 1000;

  private:
    double amount_of_slip(const double n_1,
                          const double n_2,
                          const double s,
                          const double excess) const;

    std::array<double, 2> to_eigenbasis(const std::array<double, 2> &v) const;

    std::array<double, 2> from_eigenbasis(const double v_1,
                                          const double v_2) const;

    double       a_11, a_12;
    unsigned int n_free_components;
    LocalSolver  solver;

    // Eigenvalues, lambda_1 >= lambda_2, their difference, and the eigenvector
    // (c, s) of the first one; (-s, c) is that of the second.
    double lambda_1, lambda_2, difference;
    double e_c, e_s;
  };
} // namespace Friction

#endif

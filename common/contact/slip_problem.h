#ifndef friction_contact_slip_problem_h
#define friction_contact_slip_problem_h

#include <common/parameters/solver_settings.h>

#include <array>

namespace Friction
{
  /**
   * The slip problem: minimise
   * @f[ \tfrac12 z^T a z - b^T z + \kappa |z| \quad\text{over } z \in R^n @f]
   * with a symmetric positive definite matrix $a$ and $\kappa \ge 0$. It is
   * what remains of a local contact problem once the normal displacement is
   * known or eliminated: $z$ is the tangential displacement, $a$ the tangential
   * part of the diagonal block, $b$ the tangential force without friction, and
   * $\kappa$ the bound of friction. Some components of $z$ may be prescribed;
   * then the minimum is taken over the others.
   *
   * By Lemma 6.5 the minimiser is characterised by $b - a z = \kappa z/|z|$ if
   * $z\not=0$, and by $|b| \le \kappa$ if $z=0$: friction holds the node as
   * long as it can. In one dimension, $n=1$, that leaves $z = (b \mp
   * \kappa)/a$.
   */
  template <int n>
  class SlipProblem;



  template <>
  class SlipProblem<1>
  {
  public:
    SlipProblem(const std::array<double, 1> &block,
                const unsigned int           n_free_components,
                const LocalSolver            solver);

    std::array<double, 1> solve(const std::array<double, 1> &b,
                                const double                 kappa,
                                const std::array<double, 1> &before) const;

  private:
    double       a;
    unsigned int n_free_components;
  };



  /**
   * The slip problem in a plane. What is new is that the direction of slip is
   * sought, too. In the eigenbasis of $a$, with eigenvalues $a_1 \ge a_2$, and
   * with the amount of slip $\ell = |z|$ and its direction $e = z/|z|$, the
   * inclusion reads
   * @f[ (\ell a_i + \kappa) e_i = b_i, \quad i = 1,2, \quad |e| = 1. @f]
   *
   * To eliminate $e$ gives the secular equation
   * $|(\ell a + \kappa I)^{-1} b| = 1$ for $\ell$, known from trust region
   * methods. The method of choice there, Newton's for
   * $1/|(\ell a + \kappa I)^{-1} b|$, converges from below without any
   * safeguard since that function is concave. But $\ell$ only grows by a factor
   * of 3/2 per step as long as it is much too small, which happens if $|b_2|$
   * is slightly less than $\kappa$ and $a_2$ is small. To eliminate $\ell$
   * instead gives an equation for the direction alone: $t = |e_2/e_1|$ is the
   * only positive solution of
   * @f[ a_2 |b_1| t
   *     + (a_1-a_2) \kappa \frac{t}{\sqrt{1+t^2}}
   *     = a_1 |b_2|. @f]
   * The left side increases, from zero, and is concave; written for $1/t$ where
   * $t>1$ it is convex. There are close bounds to start from, and four steps
   * are enough; or one or two, if the slip was about the same before. Nothing
   * special happens where the slip vanishes,
   * $|b| \to \kappa$, since the direction does not: Newton's method for $z$
   * itself fails there (Remark 6.6). Finally, the square of the inclusion,
   * @f[ |b|^2 - \kappa^2 = 2 \kappa \ell\, e^T a e + \ell^2 |a e|^2, @f]
   * is a quadratic equation for $\ell$ whose terms are all positive, so that
   * $\ell$ is as accurate as $|b|^2-\kappa^2$ is.
   *
   * If one component is prescribed, $z_2 = w \not= 0$, the other one solves
   * $a_{11} z_1 + \kappa z_1/\sqrt{z_1^2+w^2} = b_1 - a_{12} w$, the same
   * equation with $t=z_1/|w|$.
   */
  template <>
  class SlipProblem<2>
  {
  public:
    /**
     * Computes the eigenbasis.
     * @param block              $a$, column by column; of the off-diagonal
     *                           entries only the first one is used.
     * @param n_free_components  the first ones are free, the others are
     *                           prescribed.
     * @param solver             how the problem with two free components is
     *                           solved.
     */
    SlipProblem(const std::array<double, 4> &block,
                const unsigned int           n_free_components,
                const LocalSolver            solver);

    /**
     * Solves the problem.
     * @param before  the values that prescribed components keep, and of the
     *                others a guess: with a good one the direction of slip is
     *                found sooner, with any other it is found, too.
     */
    std::array<double, 2> solve(const std::array<double, 2> &b,
                                const double                 kappa,
                                const std::array<double, 2> &before) const;

    /**
     * The minimiser over all $z$ by the equation for the direction of slip,
     * to rounding.
     * @param before        a guess.
     * @param n_iterations  if given, where to put the number of iterations.
     */
    std::array<double, 2>
    solve_secular_equation(const std::array<double, 2> &b,
                           const double                 kappa,
                           const std::array<double, 2> &before = {{}},
                           unsigned int *n_iterations          = nullptr) const;

    /**
     * The same by a Uzawa method [Glo84, p. 170], the thesis's choice: with
     * the tangential force $\kappa\eta$, $|\eta|\le1$, as multiplier
     * @f[ z = a^{-1} (b - \kappa \eta), \quad
     *     \eta \leftarrow P(\eta + \rho \kappa z), @f]
     * where $P$ projects onto the unit disc. This is the projected gradient
     * method for the dual problem; $\rho \kappa^2 = 2/(1/a_1+1/a_2)$ is its
     * best step length. The error falls by $(a_1-a_2)/(a_1+a_2)$ per step or
     * faster, so that the number of steps grows like the condition number of
     * $a$. For blocks of a stiffness matrix on elements of decent shape that is
     * a small number; for others it is not.
     *
     * The iteration ends as soon as the inclusion holds up to
     * uzawa_tolerance*|b|. If it does not after maximum_uzawa_steps, the
     * problem is solved by the secular equation.
     *
     * @param n_iterations  if given, where to put the number of steps; more
     *                      than maximum_uzawa_steps if that was not enough.
     */
    std::array<double, 2>
    solve_uzawa(const std::array<double, 2> &b,
                const double                 kappa,
                unsigned int                *n_iterations = nullptr) const;

    static constexpr double       uzawa_tolerance     = 1e-12;
    static constexpr unsigned int maximum_uzawa_steps = 1000;

  private:
    double amount_of_slip(const double e_1,
                          const double e_2,
                          const double kappa,
                          const double excess) const;

    std::array<double, 2> to_eigenbasis(const std::array<double, 2> &z) const;

    std::array<double, 2> from_eigenbasis(const double z_1,
                                          const double z_2) const;

    double       a_11, a_12;
    unsigned int n_free_components;
    LocalSolver  solver;

    // Eigenvalues, a_1 >= a_2, their difference, and the eigenvector
    // (axis_c, axis_s) of the first one.
    double a_1, a_2, difference;
    double axis_c, axis_s;
  };
} // namespace Friction

#endif

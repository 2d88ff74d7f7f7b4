#ifndef tests_reference_solutions_dense_contact_h
#define tests_reference_solutions_dense_contact_h

#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <vector>

/**
 * Truths for the tests: solutions found by other means than those under test.
 * Nothing in this namespace uses deal.II or the library of this project.
 */
namespace Reference
{
  /**
   * A mesh of quadrilaterals. The vertices of a cell are numbered
   * lexicographically: (0,0), (1,0), (0,1), (1,1).
   */
  struct Mesh
  {
    std::vector<Eigen::Vector2d>             nodes;
    std::vector<std::array<unsigned int, 4>> cells;
  };

  /**
   * One prescribed displacement component.
   */
  struct PrescribedDisplacement
  {
    unsigned int node;
    unsigned int component;
    double       value;
  };

  /**
   * A node whose displacement is the weighted mean of other (not hanging)
   * nodes.
   */
  struct HangingNode
  {
    unsigned int                                 node;
    std::vector<std::pair<unsigned int, double>> masters;
  };

  /**
   * A node that may touch the obstacle, which lies at the distance `gap` along
   * the unit vector `normal`.
   */
  struct ContactNode
  {
    unsigned int    node;
    Eigen::Vector2d normal;
    double          gap;
    double friction_coefficient = 0.; ///< F, used by Coulomb's law only
    double friction_bound       = 0.; ///< nodal force s, by Tresca's law only
  };

  enum class Friction
  {
    none,
    tresca,
    coulomb
  };

  /**
   * Everything that defines the discrete problem. Degree of freedom
   * 2 * node + component; forces are nodal forces, not densities.
   */
  struct ContactProblem
  {
    Mesh                                mesh;
    double                              youngs_modulus = 1.;
    double                              poisson_ratio  = 0.3;
    std::vector<PrescribedDisplacement> dirichlet;
    std::vector<HangingNode>            hanging; ///< none on conforming meshes
    Eigen::VectorXd                     forces;  ///< empty means zero
    std::vector<ContactNode>            contact;
    Friction                            friction = Friction::coulomb;
  };

  /**
   * By how much a displacement field violates the discrete law. Forces are
   * relative to the largest nodal contact force, lengths to the largest
   * displacement; all are zero at an exact solution.
   */
  struct Violations
  {
    double penetration     = 0.; ///< u_n - g where positive
    double tension         = 0.; ///< -tau where positive
    double complementarity = 0.; ///< min(tau, g - u_n)
    double cone            = 0.; ///< |R_T| - s where positive
    double slip            = 0.; ///< slip without the full bound, or along R_T
    double equilibrium     = 0.; ///< R where nothing is in touch

    double
    max() const
    {
      return std::max(
        {penetration, tension, complementarity, cone, slip, equilibrium});
    }
  };

  enum class State
  {
    open     = 0,
    sliding  = 1,
    sticking = 2
  };

  /**
   * The solution. The vectors `state`, `normal_force`, `tangential_force` and
   * `slip` run over the contact nodes in the order of the problem. Tangent is
   * t = (-n_y, n_x): (1,0) for n = (0,-1).
   */
  struct ContactSolution
  {
    Eigen::VectorXd    displacement; ///< u, all degrees of freedom
    Eigen::VectorXd    residual;     ///< R = A u - f, zero at hanging nodes
    std::vector<State> state; ///< `open` whenever not in touch, also if Tresca
                              ///< friction holds it
    Eigen::VectorXd normal_force;     ///< tau = -R.n
    Eigen::VectorXd tangential_force; ///< R.t
    Eigen::VectorXd slip;             ///< u.t
    Violations      violations;
    unsigned int    active_set_steps      = 0;
    bool            relaxation_was_needed = false;

    unsigned int
    count(const State which) const
    {
      return std::count(state.begin(), state.end(), which);
    }
  };

  /**
   * How the condensed problem is solved. The active set method falls back to
   * relaxation by itself; asking for relaxation gives a second opinion.
   */
  enum class Method
  {
    active_set,
    relaxation
  };

  /**
   * Stiffness matrix of plane strain for Young's modulus one, bilinear
   * elements, 2x2 Gauss points. (All computations are done for modulus one:
   * a scene in pascals would otherwise lose its meaning of "small".)
   */
  Eigen::SparseMatrix<double> stiffness(const Mesh &mesh, const double nu);

  /**
   * Check every condition of the discrete law, and equilibrium, at a given
   * displacement, which may come from anywhere.
   */
  Violations check(const ContactProblem &problem, const Eigen::VectorXd &u);

  /**
   * Solve the discrete Signorini problem with the given friction law directly.
   * All nodes but those of the contact boundary are eliminated by a sparse
   * factorisation, the small dense rest is solved by an active set method with
   * the exact derivative of Coulomb's law, and by nonlinear relaxation where
   * that cycles. Throws when the result violates the law by more than 1e-10.
   */
  ContactSolution solve(const ContactProblem &problem,
                        const Method          method = Method::active_set);
} // namespace Reference

#endif

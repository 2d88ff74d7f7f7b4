#ifndef tests_reference_solutions_dense_contact_3d_h
#define tests_reference_solutions_dense_contact_3d_h

#include <tests/reference/solutions/dense_contact.h>

#include <array>
#include <vector>

/**
 * The truth in three dimensions. In two, where a node stands is one of finitely
 * many phases, each of them linear; here the direction of slip is a continuous
 * unknown and the law is solved by a semismooth Newton method. What a phase, a
 * violation, or a law of friction is, the header for two dimensions says.
 */
namespace Reference
{
  /**
   * A mesh of trilinear hexahedra. The vertices of a cell are numbered
   * lexicographically, x running fastest: (0,0,0), (1,0,0), (0,1,0), ...
   */
  struct Mesh3D
  {
    std::vector<Eigen::Vector3d>             nodes;
    std::vector<std::array<unsigned int, 8>> cells;
  };

  /**
   * A node that may touch the obstacle, which lies at the distance `gap` along
   * the unit vector `normal`.
   */
  struct ContactNode3D
  {
    unsigned int    node;
    Eigen::Vector3d normal;
    double          gap;
    double friction_coefficient = 0.; ///< F, used by Coulomb's law only
    double friction_bound       = 0.; ///< nodal force s, by Tresca's law only
  };

  /**
   * Everything that defines the discrete problem. Degree of freedom
   * 3 * node + component; forces are nodal forces, not densities. A tangential
   * component of a contact node may be prescribed to be zero, as on a plane of
   * symmetry; friction then acts along the other tangent only.
   */
  struct ContactProblem3D
  {
    Mesh3D                              mesh;
    double                              youngs_modulus = 1.;
    double                              poisson_ratio  = 0.3;
    std::vector<PrescribedDisplacement> dirichlet;
    Eigen::VectorXd                     forces; ///< empty means zero
    std::vector<ContactNode3D>          contact;
    Friction                            friction = Friction::coulomb;
  };

  /**
   * The solution. The vectors `state`, `normal_force`, `tangential_force` and
   * `slip` run over the contact nodes in the order of the problem.
   */
  struct ContactSolution3D
  {
    Eigen::VectorXd    displacement; ///< u, all degrees of freedom
    Eigen::VectorXd    residual;     ///< R = A u - f
    std::vector<State> state; ///< `open` whenever not in touch, also if Tresca
                              ///< friction holds it
    Eigen::VectorXd              normal_force;          ///< tau = -R.n
    std::vector<Eigen::Vector3d> tangential_force;      ///< R + tau n
    std::vector<Eigen::Vector3d> slip;                  ///< u - (u.n) n
    double                       potential_energy = 0.; ///< u.(A u) / 2 - f.u
    double       friction_energy = 0.; ///< sum of s |u_T|, s at the solution
    Violations   violations;
    unsigned int newton_steps       = 0; ///< of all steps of the continuation
    unsigned int continuation_steps = 0; ///< 1: frictionless, then all friction

    unsigned int
    count(const State which) const
    {
      return std::count(state.begin(), state.end(), which);
    }

    /// Value of the functional that is minimal for given friction bounds.
    double
    energy() const
    {
      return potential_energy + friction_energy;
    }
  };

  /**
   * Stiffness matrix for Young's modulus one, trilinear elements, 2x2x2 Gauss
   * points.
   */
  Eigen::SparseMatrix<double> stiffness(const Mesh3D &mesh, const double nu);

  /// Which degrees of freedom are prescribed.
  std::vector<bool> prescribed(const ContactProblem3D &problem);

  /// Whether nothing is left to decide at a node.
  bool wholly_prescribed(const std::vector<bool> &prescribed,
                         const unsigned int       node);

  /**
   * Check every condition of the discrete law, and equilibrium, at a given
   * displacement, which may come from anywhere. The conditions are those of
   * the header for two dimensions, written with vectors; nothing of the
   * equation that `solve` solves enters.
   */
  Violations check(const ContactProblem3D &problem, const Eigen::VectorXd &u);

  /**
   * Solve the discrete Signorini problem with the given friction law directly.
   * All nodes but those of the contact boundary are eliminated by a sparse
   * factorisation, the dense rest is solved by Newton's method. Throws when the
   * result violates the law by more than 1e-10.
   *
   * The interior is solved for once per contact degree of freedom, which is
   * what takes the time: a quarter of a second for 8^3 cells, half a minute for
   * 16^3.
   */
  ContactSolution3D solve(const ContactProblem3D &problem);
} // namespace Reference

#endif

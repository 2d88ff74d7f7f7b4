#ifndef tests_reference_scenes_h
#define tests_reference_scenes_h

#include <cmath>
#include <functional>

#include "dense_contact.h"

/**
 * The scenes that have a truth, on structured meshes.
 */
namespace Reference
{
  /**
   * [0,length] x [0,height] in n_x by n_y cells; node (i,j) has the number
   * j * (n_x + 1) + i. With `distortion` > 0 the inner nodes move by that
   * fraction of a cell, and the ones inside the lower and upper edge along it.
   */
  inline Mesh
  rectangle(const unsigned int n_x,
            const unsigned int n_y,
            const double       length     = 1.,
            const double       height     = 1.,
            const double       distortion = 0.)
  {
    Mesh         mesh;
    const double h_x = length / n_x, h_y = height / n_y;
    for (unsigned int j = 0; j <= n_y; ++j)
      for (unsigned int i = 0; i <= n_x; ++i)
        {
          Eigen::Vector2d x(i * h_x, j * h_y);
          if (i > 0 && i < n_x)
            x[0] += distortion * h_x * std::sin(12.9898 * i + 78.233 * j);
          if (i > 0 && i < n_x && j > 0 && j < n_y)
            x[1] += distortion * h_y * std::sin(39.346 * i - 11.135 * j);
          mesh.nodes.push_back(x);
        }
    for (unsigned int j = 0; j < n_y; ++j)
      for (unsigned int i = 0; i < n_x; ++i)
        {
          const unsigned int first = j * (n_x + 1) + i;
          mesh.cells.push_back(
            {{first, first + 1, first + n_x + 1, first + n_x + 2}});
        }
    return mesh;
  }

  /**
   * Number of the node at a point, for tests whose nodes are ordered
   * differently. Throws if there is none within 1e-9 of the mesh's extent.
   */
  inline unsigned int
  node_at(const Mesh &mesh, const Eigen::Vector2d &point)
  {
    double extent = 0.;
    for (const auto &x : mesh.nodes)
      extent = std::max(extent, (x - mesh.nodes[0]).norm());
    for (unsigned int p = 0; p < mesh.nodes.size(); ++p)
      if ((mesh.nodes[p] - point).norm() <= 1e-9 * extent)
        return p;
    throw std::runtime_error("Reference: no node at this point.");
  }

  /**
   * Add the consistent load of a constant traction along the edge from node a
   * to node b: half the resultant to each.
   */
  inline void
  add_traction(ContactProblem        &problem,
               const unsigned int     a,
               const unsigned int     b,
               const Eigen::Vector2d &traction)
  {
    if (problem.forces.size() == 0)
      problem.forces = Eigen::VectorXd::Zero(2 * problem.mesh.nodes.size());
    const double length =
      (problem.mesh.nodes[a] - problem.mesh.nodes[b]).norm();
    problem.forces.segment<2>(2 * a) += 0.5 * length * traction;
    problem.forces.segment<2>(2 * b) += 0.5 * length * traction;
  }

  /**
   * The unit square on y = 0, the displacement of its top edge given, its sides
   * free.
   */
  inline ContactProblem
  block(const unsigned int     n,
        const double           friction_coefficient,
        const double           poisson_ratio = 0.3,
        const Eigen::Vector2d &top           = {0.02, -0.02})
  {
    ContactProblem problem;
    problem.mesh          = rectangle(n, n);
    problem.poisson_ratio = poisson_ratio;
    problem.friction =
      friction_coefficient > 0. ? Friction::coulomb : Friction::none;
    for (unsigned int i = 0; i <= n; ++i)
      {
        for (unsigned int c = 0; c < 2; ++c)
          problem.dirichlet.push_back({n * (n + 1) + i, c, top[c]});
        problem.contact.push_back(
          {i, Eigen::Vector2d(0., -1.), 0., friction_coefficient, 0.});
      }
    return problem;
  }

  /**
   * Half of the block of Raous, Chabrand and Lebon (1988), 40 mm x 40 mm, in
   * metres and pascals: pressure on the free side x = 0 and on top, symmetry at
   * x = 40 mm, whose lower corner is pinned.
   */
  inline ContactProblem
  raous(const unsigned int n, const double friction_coefficient = 1.)
  {
    const double   side = 0.04;
    ContactProblem problem;
    problem.mesh           = rectangle(n, n, side, side);
    problem.youngs_modulus = 1.3e11;
    problem.poisson_ratio  = 0.2;
    problem.friction =
      friction_coefficient > 0. ? Friction::coulomb : Friction::none;
    for (unsigned int j = 0; j <= n; ++j)
      problem.dirichlet.push_back({j * (n + 1) + n, 0, 0.});
    problem.dirichlet.push_back({n, 1, 0.});
    for (unsigned int i = 0; i < n; ++i)
      {
        problem.contact.push_back(
          {i, Eigen::Vector2d(0., -1.), 0., friction_coefficient, 0.});
        add_traction(
          problem, i * (n + 1), (i + 1) * (n + 1), Eigen::Vector2d(15e7, 0.));
        add_traction(problem,
                     n * (n + 1) + i,
                     n * (n + 1) + i + 1,
                     Eigen::Vector2d(0., -5e7));
      }
    return problem;
  }

  /**
   * A patch test in which the whole contact boundary sticks or the whole of it
   * slides, at constant stress: [0,length] x [0,height] on y = 0, its top moved
   * by (shear, -compression) beyond closing the initial gap, and the side
   * tractions that keep the stress uniform. The solution is linear, so any mesh
   * reproduces it.
   */
  class StickSlip
  {
  public:
    StickSlip(const double shear,
              const double compression,
              const double friction_coefficient,
              const double initial_gap    = 0.,
              const double length         = 1.,
              const double height         = 1.,
              const double youngs_modulus = 1.,
              const double poisson_ratio  = 0.3,
              const double angle          = 0.) // the whole scene rotated by it
      : shear(shear)
      , compression(compression)
      , friction_coefficient(friction_coefficient)
      , initial_gap(initial_gap)
      , length(length)
      , height(height)
      , youngs_modulus(youngs_modulus)
      , poisson_ratio(poisson_ratio)
      , angle(angle)
      , lambda(youngs_modulus * poisson_ratio /
               ((1. + poisson_ratio) * (1. - 2. * poisson_ratio)))
      , mu(youngs_modulus / (2. * (1. + poisson_ratio)))
    {}

    /// Shear beyond which it slides, from q = mu U / H and q = F p.
    static double
    threshold(const double compression,
              const double friction_coefficient,
              const double poisson_ratio = 0.3)
    {
      return friction_coefficient * compression * 2. * (1. - poisson_ratio) /
        (1. - 2. * poisson_ratio);
    }

    bool
    sticks() const
    {
      return std::abs(shear) <=
        threshold(compression, friction_coefficient, poisson_ratio);
    }

    /// Normal pressure p.
    double
    pressure() const
    {
      return (lambda + 2. * mu) * compression / height;
    }

    /// Shear stress q.
    double
    shear_stress() const
    {
      return sticks() ? mu * shear / height
                      : std::copysign(friction_coefficient * pressure(), shear);
    }

    /// Tangential displacement of the contact boundary.
    double
    slip() const
    {
      return sticks() ? 0. : shear - shear_stress() * height / mu;
    }

    /// Displacement at a point of the (rotated) body.
    Eigen::Vector2d
    displacement(const Eigen::Vector2d &point) const
    {
      const Eigen::Rotation2Dd rotation(angle);
      const double             y = (rotation.inverse() * point)[1];
      return rotation *
        Eigen::Vector2d(slip() + shear_stress() / mu * y,
                        -initial_gap - compression / height * y);
    }

    ContactProblem
    problem(const unsigned int n_x,
            const unsigned int n_y,
            const double       distortion = 0.) const
    {
      const Eigen::Rotation2Dd rotation(angle);
      ContactProblem           problem;
      problem.mesh           = rectangle(n_x, n_y, length, height, distortion);
      problem.youngs_modulus = youngs_modulus;
      problem.poisson_ratio  = poisson_ratio;
      for (auto &x : problem.mesh.nodes)
        x = (rotation * x).eval();

      const Eigen::Vector2d top =
        rotation * Eigen::Vector2d(shear, -compression - initial_gap);
      for (unsigned int i = 0; i <= n_x; ++i)
        {
          for (unsigned int c = 0; c < 2; ++c)
            problem.dirichlet.push_back({n_y * (n_x + 1) + i, c, top[c]});
          problem.contact.push_back({i,
                                     rotation * Eigen::Vector2d(0., -1.),
                                     initial_gap,
                                     friction_coefficient,
                                     0.});
        }
      const Eigen::Vector2d traction = rotation *
        Eigen::Vector2d(-lambda * compression / height, shear_stress());
      for (unsigned int j = 0; j < n_y; ++j)
        {
          add_traction(
            problem, j * (n_x + 1) + n_x, (j + 1) * (n_x + 1) + n_x, traction);
          add_traction(problem, j * (n_x + 1), (j + 1) * (n_x + 1), -traction);
        }
      return problem;
    }

  private:
    const double shear, compression, friction_coefficient, initial_gap, length,
      height, youngs_modulus, poisson_ratio, angle, lambda, mu;
  };
} // namespace Reference

#endif

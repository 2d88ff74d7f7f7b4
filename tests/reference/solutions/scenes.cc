#include <Eigen/Geometry>
#include <tests/reference/solutions/scenes.h>

namespace Reference
{
  Mesh
  rectangle(const unsigned int n_x,
            const unsigned int n_y,
            const double       length,
            const double       height,
            const double       distortion)
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



  void
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



  ContactProblem
  block(const unsigned int     n,
        const double           friction_coefficient,
        const double           poisson_ratio,
        const Eigen::Vector2d &top)
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



  ContactProblem
  raous(const unsigned int n, const double friction_coefficient)
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



  Eigen::Vector2d
  StickSlip::displacement(const Eigen::Vector2d &point) const
  {
    const Eigen::Rotation2Dd rotation(angle);
    const double             y = (rotation.inverse() * point)[1];
    return rotation *
      Eigen::Vector2d(slip() + shear_stress() / mu * y,
                      -initial_gap - compression / height * y);
  }



  ContactProblem
  StickSlip::problem(const unsigned int n_x,
                     const unsigned int n_y,
                     const double       distortion) const
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
} // namespace Reference

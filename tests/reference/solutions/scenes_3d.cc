#include <Eigen/Geometry>
#include <tests/reference/solutions/scenes_3d.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace Reference
{
  Mesh3D
  box(const std::array<unsigned int, 3> &n,
      const Eigen::Vector3d             &size,
      const double                       distortion)
  {
    Mesh3D mesh;
    for (unsigned int k = 0; k <= n[2]; ++k)
      for (unsigned int j = 0; j <= n[1]; ++j)
        for (unsigned int i = 0; i <= n[0]; ++i)
          {
            const std::array<unsigned int, 3> index = {{i, j, k}};
            Eigen::Vector3d                   x;
            for (unsigned int c = 0; c < 3; ++c)
              {
                x[c] = index[c];
                if (index[c] > 0 && index[c] < n[c])
                  x[c] += distortion *
                    std::sin(12.9898 * i + 78.233 * j + 39.346 * k + 5. * c);
                x[c] *= size[c] / n[c];
              }
            mesh.nodes.push_back(x);
          }
    const unsigned int row = n[0] + 1, layer = row * (n[1] + 1);
    for (unsigned int k = 0; k < n[2]; ++k)
      for (unsigned int j = 0; j < n[1]; ++j)
        for (unsigned int i = 0; i < n[0]; ++i)
          {
            const unsigned int          first = k * layer + j * row + i;
            std::array<unsigned int, 8> cell;
            for (unsigned int v = 0; v < 8; ++v)
              cell[v] =
                first + (v & 1) + ((v >> 1) & 1) * row + ((v >> 2) & 1) * layer;
            mesh.cells.push_back(cell);
          }
    return mesh;
  }



  void
  add_traction(ContactProblem3D      &problem,
               const unsigned int     component,
               const double           coordinate,
               const Eigen::Vector3d &traction)
  {
    const auto &nodes = problem.mesh.nodes;
    if (problem.forces.size() == 0)
      problem.forces = Eigen::VectorXd::Zero(3 * nodes.size());
    double extent = 0.;
    for (const auto &x : nodes)
      extent = std::max(extent, (x - nodes[0]).norm());

    for (const auto &cell : problem.mesh.cells)
      for (const bool upper : {false, true})
        {
          // The face's four vertices, lexicographically.
          std::vector<unsigned int> face;
          for (unsigned int v = 0; v < 8; ++v)
            if (((v >> component) & 1) == upper)
              face.push_back(cell[v]);
          if (std::any_of(face.begin(), face.end(), [&](const unsigned int p) {
                return std::abs(nodes[p][component] - coordinate) >
                  1e-9 * extent;
              }))
            continue;
          const double q = 1. / std::sqrt(3.);
          for (const double xi : {-q, q})
            for (const double eta : {-q, q})
              {
                Eigen::Vector3d along_xi  = Eigen::Vector3d::Zero(),
                                along_eta = along_xi;
                Eigen::Vector4d shape;
                for (unsigned int v = 0; v < 4; ++v)
                  {
                    const double a = v & 1 ? 1. : -1., b = v & 2 ? 1. : -1.;
                    shape[v] = 0.25 * (1. + a * xi) * (1. + b * eta);
                    along_xi += 0.25 * a * (1. + b * eta) * nodes[face[v]];
                    along_eta += 0.25 * b * (1. + a * xi) * nodes[face[v]];
                  }
                const double area = along_xi.cross(along_eta).norm();
                for (unsigned int v = 0; v < 4; ++v)
                  problem.forces.segment<3>(3 * face[v]) +=
                    area * shape[v] * traction;
              }
        }
  }



  ContactProblem3D
  body_on_plane(const Mesh3D          &mesh,
                const double           friction_coefficient,
                const Eigen::Vector3d &top,
                const double           gap)
  {
    ContactProblem3D problem;
    problem.mesh = mesh;
    problem.friction =
      friction_coefficient > 0. ? Friction::coulomb : Friction::none;
    double lowest = mesh.nodes[0][2], highest = lowest;
    for (const auto &x : mesh.nodes)
      {
        lowest  = std::min(lowest, x[2]);
        highest = std::max(highest, x[2]);
      }
    const double tolerance = 1e-9 * (highest - lowest);
    for (unsigned int p = 0; p < mesh.nodes.size(); ++p)
      if (mesh.nodes[p][2] >= highest - tolerance)
        for (unsigned int c = 0; c < 3; ++c)
          problem.dirichlet.push_back({p, c, top[c]});
      else if (mesh.nodes[p][2] <= lowest + tolerance)
        problem.contact.push_back(
          {p, Eigen::Vector3d(0., 0., -1.), gap, friction_coefficient, 0.});
    return problem;
  }



  ContactProblem3D
  block_3d(const unsigned int     n,
           const double           friction_coefficient,
           const double           poisson_ratio,
           const Eigen::Vector3d &top)
  {
    ContactProblem3D problem =
      body_on_plane(box({{n, n, n}}), friction_coefficient, top);
    problem.poisson_ratio = poisson_ratio;
    return problem;
  }



  ContactProblem3D
  rotated(const ContactProblem3D &problem, const Eigen::Matrix3d &rotation)
  {
    ContactProblem3D result = problem;
    for (auto &x : result.mesh.nodes)
      x = (rotation * x).eval();
    for (auto &node : result.contact)
      node.normal = (rotation * node.normal).normalized();
    for (int i = 0; i < result.forces.size(); i += 3)
      result.forces.segment<3>(i) = rotation * problem.forces.segment<3>(i);

    const std::vector<bool> fixed  = prescribed(problem);
    Eigen::VectorXd         values = Eigen::VectorXd::Zero(fixed.size());
    for (const auto &d : problem.dirichlet)
      {
        if (!wholly_prescribed(fixed, d.node))
          throw std::runtime_error(
            "Reference: a single prescribed component cannot be rotated.");
        values[3 * d.node + d.component] = d.value;
      }
    for (auto &d : result.dirichlet)
      d.value = rotation.row(d.component) * values.segment<3>(3 * d.node);
    return result;
  }



  Eigen::Vector3d
  StickSlip3D::displacement(const Eigen::Vector3d &point) const
  {
    const double          z        = (rotation.transpose() * point)[2];
    const Eigen::Vector2d gradient = shear_stress() / mu;
    Eigen::Vector3d       u;
    u << shear - (size[2] - z) * gradient,
      -initial_gap - compression / size[2] * z;
    return rotation * u;
  }



  ContactProblem3D
  StickSlip3D::problem(const std::array<unsigned int, 3> &n,
                       const double                       distortion) const
  {
    Eigen::Vector3d top;
    top << shear, -compression - initial_gap;
    ContactProblem3D problem = body_on_plane(
      box(n, size, distortion), friction_coefficient, top, initial_gap);
    problem.youngs_modulus = youngs_modulus;
    problem.poisson_ratio  = poisson_ratio;
    for (unsigned int c = 0; c < 2; ++c)
      {
        Eigen::Vector3d traction = Eigen::Vector3d::Zero();
        traction[c]              = -lambda * compression / size[2];
        traction[2]              = shear_stress()[c];
        add_traction(problem, c, size[c], traction);
        add_traction(problem, c, 0., -traction);
      }
    return rotated(problem, rotation);
  }
} // namespace Reference

#ifndef tests_reference_scenes_3d_h
#define tests_reference_scenes_3d_h

#include <cmath>

#include "dense_contact_3d.h"
#include "scenes.h"

/**
 * The scenes in three dimensions that have a truth, on structured meshes.
 */
namespace Reference
{
  /**
   * [0,size_x] x [0,size_y] x [0,size_z] in n_x by n_y by n_z cells, x running
   * fastest in the numbers of nodes. With `distortion` > 0 nodes move by up to
   * that fraction of a cell: inner ones anywhere, those of faces and edges
   * within them.
   */
  inline Mesh3D
  box(const std::array<unsigned int, 3> &n,
      const Eigen::Vector3d             &size       = {1., 1., 1.},
      const double                       distortion = 0.)
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

  /**
   * Number of the node at a point, for tests whose nodes are ordered
   * differently. Throws if there is none within 1e-9 of the mesh's extent.
   */
  inline unsigned int
  node_at(const Mesh3D &mesh, const Eigen::Vector3d &point)
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
   * Add the consistent load of a constant traction on all faces of cells that
   * lie in the boundary plane x_component = coordinate.
   */
  inline void
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

  /**
   * A body whose lowest nodes may touch the plane `gap` below them and whose
   * highest ones are displaced as given. Material, other gaps and loads are for
   * the caller to add.
   */
  inline ContactProblem3D
  body_on_plane(const Mesh3D          &mesh,
                const double           friction_coefficient,
                const Eigen::Vector3d &top,
                const double           gap = 0.)
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

  /**
   * The unit cube on z = 0, the displacement of its top given, its sides free.
   */
  inline ContactProblem3D
  block_3d(const unsigned int     n,
           const double           friction_coefficient,
           const double           poisson_ratio = 0.3,
           const Eigen::Vector3d &top           = {0.02, 0.01, -0.02})
  {
    ContactProblem3D problem =
      body_on_plane(box({{n, n, n}}), friction_coefficient, top);
    problem.poisson_ratio = poisson_ratio;
    return problem;
  }

  /**
   * The same problem looked at from elsewhere. Displacements must be prescribed
   * as whole vectors.
   */
  inline ContactProblem3D
  rotated(const ContactProblem3D &problem, const Eigen::Matrix3d &rotation)
  {
    ContactProblem3D result = problem;
    for (auto &x : result.mesh.nodes)
      x = (rotation * x).eval();
    for (auto &node : result.contact)
      node.normal = (rotation * node.normal).normalized();
    for (int i = 0; i < result.forces.size(); i += 3)
      result.forces.segment<3>(i) = rotation * problem.forces.segment<3>(i);

    const std::vector<bool> fixed  = internal::prescribed(problem);
    Eigen::VectorXd         values = Eigen::VectorXd::Zero(fixed.size());
    for (const auto &d : problem.dirichlet)
      {
        if (!internal::wholly_prescribed(fixed, d.node))
          throw std::runtime_error(
            "Reference: a single prescribed component cannot be rotated.");
        values[3 * d.node + d.component] = d.value;
      }
    for (auto &d : result.dirichlet)
      d.value = rotation.row(d.component) * values.segment<3>(3 * d.node);
    return result;
  }

  /**
   * The patch test of `StickSlip` with shear in any direction: the top of a box
   * moved by (shear, -compression) beyond closing the initial gap, side
   * tractions that keep the stress uniform, all of it rotated. The solution is
   * linear, so any mesh reproduces it.
   */
  class StickSlip3D
  {
  public:
    StickSlip3D(const Eigen::Vector2d &shear,
                const double           compression,
                const double           friction_coefficient,
                const double           initial_gap    = 0.,
                const Eigen::Vector3d &size           = {1., 1., 1.},
                const double           youngs_modulus = 1.,
                const double           poisson_ratio  = 0.3,
                const Eigen::Matrix3d &rotation = Eigen::Matrix3d::Identity())
      : shear(shear)
      , compression(compression)
      , friction_coefficient(friction_coefficient)
      , initial_gap(initial_gap)
      , size(size)
      , youngs_modulus(youngs_modulus)
      , poisson_ratio(poisson_ratio)
      , rotation(rotation)
      , lambda(youngs_modulus * poisson_ratio /
               ((1. + poisson_ratio) * (1. - 2. * poisson_ratio)))
      , mu(youngs_modulus / (2. * (1. + poisson_ratio)))
    {}

    bool
    sticks() const
    {
      return shear.norm() <=
        StickSlip::threshold(compression, friction_coefficient, poisson_ratio);
    }

    /// Shear stresses (sigma_xz, sigma_yz).
    Eigen::Vector2d
    shear_stress() const
    {
      return sticks()
        ? Eigen::Vector2d(mu / size[2] * shear)
        : Eigen::Vector2d(friction_coefficient * (lambda + 2. * mu) *
                          compression / size[2] * shear.normalized());
    }

    /// Displacement at a point of the (rotated) body.
    Eigen::Vector3d
    displacement(const Eigen::Vector3d &point) const
    {
      const double          z        = (rotation.transpose() * point)[2];
      const Eigen::Vector2d gradient = shear_stress() / mu;
      Eigen::Vector3d       u;
      u << shear - (size[2] - z) * gradient,
        -initial_gap - compression / size[2] * z;
      return rotation * u;
    }

    ContactProblem3D
    problem(const std::array<unsigned int, 3> &n,
            const double                       distortion = 0.) const
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

  private:
    const Eigen::Vector2d shear;
    const double          compression, friction_coefficient, initial_gap;
    const Eigen::Vector3d size;
    const double          youngs_modulus, poisson_ratio;
    const Eigen::Matrix3d rotation;
    const double          lambda, mu;
  };
} // namespace Reference

#endif

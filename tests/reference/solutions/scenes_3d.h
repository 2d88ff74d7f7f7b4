#ifndef tests_reference_solutions_scenes_3d_h
#define tests_reference_solutions_scenes_3d_h

#include <tests/reference/solutions/both_dimensions.h>
#include <tests/reference/solutions/dense_contact_3d.h>
#include <tests/reference/solutions/scenes.h>

#include <array>

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
  Mesh3D box(const std::array<unsigned int, 3> &n,
             const Eigen::Vector3d             &size       = {1., 1., 1.},
             const double                       distortion = 0.);

  /**
   * Add the consistent load of a constant traction on all faces of cells that
   * lie in the boundary plane x_component = coordinate.
   */
  void add_traction(ContactProblem3D      &problem,
                    const unsigned int     component,
                    const double           coordinate,
                    const Eigen::Vector3d &traction);

  /**
   * A body whose lowest nodes may touch the plane `gap` below them and whose
   * highest ones are displaced as given. Material, other gaps and loads are for
   * the caller to add.
   */
  ContactProblem3D body_on_plane(const Mesh3D          &mesh,
                                 const double           friction_coefficient,
                                 const Eigen::Vector3d &top,
                                 const double           gap = 0.);

  /**
   * The unit cube on z = 0, the displacement of its top given, its sides free.
   */
  ContactProblem3D block_3d(const unsigned int     n,
                            const double           friction_coefficient,
                            const double           poisson_ratio = 0.3,
                            const Eigen::Vector3d &top = {0.02, 0.01, -0.02});

  /**
   * The same problem looked at from elsewhere. Displacements must be prescribed
   * as whole vectors.
   */
  ContactProblem3D rotated(const ContactProblem3D &problem,
                           const Eigen::Matrix3d  &rotation);

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
    Eigen::Vector3d displacement(const Eigen::Vector3d &point) const;

    ContactProblem3D problem(const std::array<unsigned int, 3> &n,
                             const double distortion = 0.) const;

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

#ifndef tests_reference_solutions_scenes_h
#define tests_reference_solutions_scenes_h

#include <tests/reference/solutions/both_dimensions.h>
#include <tests/reference/solutions/dense_contact.h>

#include <cmath>
#include <functional>

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
  Mesh rectangle(const unsigned int n_x,
                 const unsigned int n_y,
                 const double       length     = 1.,
                 const double       height     = 1.,
                 const double       distortion = 0.);

  /**
   * Add the consistent load of a constant traction along the edge from node a
   * to node b: half the resultant to each.
   */
  void add_traction(ContactProblem        &problem,
                    const unsigned int     a,
                    const unsigned int     b,
                    const Eigen::Vector2d &traction);

  /**
   * The unit square on y = 0, the displacement of its top edge given, its sides
   * free.
   */
  ContactProblem block(const unsigned int     n,
                       const double           friction_coefficient,
                       const double           poisson_ratio = 0.3,
                       const Eigen::Vector2d &top           = {0.02, -0.02});

  /**
   * Half of the block of Raous, Chabrand and Lebon (1988), 40 mm x 40 mm, in
   * metres and pascals: pressure on the free side x = 0 and on top, symmetry at
   * x = 40 mm, whose lower corner is pinned.
   */
  ContactProblem raous(const unsigned int n,
                       const double       friction_coefficient = 1.);

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
    Eigen::Vector2d displacement(const Eigen::Vector2d &point) const;

    ContactProblem problem(const unsigned int n_x,
                           const unsigned int n_y,
                           const double       distortion = 0.) const;

  private:
    const double shear, compression, friction_coefficient, initial_gap, length,
      height, youngs_modulus, poisson_ratio, angle, lambda, mu;
  };
} // namespace Reference

#endif

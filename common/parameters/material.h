#ifndef friction_parameters_material_h
#define friction_parameters_material_h

#include <cmath>

namespace Friction
{
  /**
   * Which volumetric strain the compressive stiffness of a discrete body is
   * made of.
   */
  enum class VolumetricStrain
  {
    pointwise, ///< the divergence of the displacement, as it is
    mean       ///< its mean over each cell, which does not lock
  };

  /**
   * A linear elastic, isotropic material. In two dimensions we mean plane
   * strain throughout, so that the Lam&eacute; constants are the same in 2D and
   * 3D.
   */
  class Material
  {
  public:
    /**
     * @param youngs_modulus positive, in units of stress
     * @param poisson_ratio between -1 and 1/2, both excluded
     * @param volumetric_strain of the discrete body
     */
    Material(
      const double           youngs_modulus,
      const double           poisson_ratio,
      const VolumetricStrain volumetric_strain = VolumetricStrain::pointwise)
      : E(youngs_modulus)
      , nu(poisson_ratio)
      , dilatation(volumetric_strain)
    {}

    /// Young's modulus, in units of stress.
    double
    youngs_modulus() const
    {
      return E;
    }

    /// Poisson's ratio, a pure number.
    double
    poisson_ratio() const
    {
      return nu;
    }

    /// First Lam&eacute; constant, in units of stress.
    double
    lambda() const
    {
      return E * nu / ((1. + nu) * (1. - 2. * nu));
    }

    /// Second Lam&eacute; constant, the shear modulus, in units of stress.
    double
    mu() const
    {
      return E / (2. * (1. + nu));
    }

    /// What the discrete body's pressure is made of.
    VolumetricStrain
    volumetric_strain() const
    {
      return dilatation;
    }

  private:
    double           E;
    double           nu;
    VolumetricStrain dilatation;
  };

  /**
   * Eck's bound on the coefficient of friction, below which a solution of the
   * static problem with Coulomb friction is known to exist in @p dim space
   * dimensions for a body of Poisson ratio @p nu. Above it nothing is known in
   * general, and there may be several solutions.
   */
  inline double
  eck_bound(const unsigned int dim, const double nu)
  {
    const double ratio = (1. - 2. * nu) / (1. - nu);
    return (dim == 2) ? std::sqrt(1. - ratio * ratio / 4.)
                      : std::sqrt(1. - 1. / (4. * (1. - nu)));
  }
} // namespace Friction

#endif

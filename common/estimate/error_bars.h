#ifndef friction_estimate_error_bars_h
#define friction_estimate_error_bars_h

#include <string>
#include <vector>

namespace Friction
{
  /** A quantity of the solution on one of several meshes, each finer than the
   * one before. */
  struct ValueOnMesh
  {
    double dofs; ///< of the mesh
    double value;

    /// By how much the value may be wrong since nodes are a distance apart,
    /// whatever the solution is at the nodes.
    double resolution;
  };

  /// The bar of a quantity whose error is not known.
  constexpr double unknown_error = -1;

  /**
   * An estimate of the error of the last of these values, for quantities that
   * depend smoothly on the solution: forces, or a pressure.
   *
   * An error of order q is $C\,h^q$ with $h=N^{-1/d}$, so that the difference
   * of two meshes is $C\,(h_{k-1}^q-h_k^q)$. Each of the last three differences
   * gives a C. Of the orders one and two, that of stresses at nodes next to an
   * edge or of first-order elements in general, and that of energies and what
   * is dual to them, the one is taken for which these differ less, and of the
   * three the largest, with a factor of 3/2 for safety; the resolution is
   * added.
   *
   * Unknown with fewer than three meshes.
   */
  double error_of_smooth_value(const std::vector<ValueOnMesh> &values,
                               const unsigned int              dim);

  /**
   * The same for the width of a zone, which is that of a number of nodes and
   * jumps from mesh to mesh: a multiple of the resolution, which is half of
   * what the nodes at the rim stand for. The multiple is at least one. If
   * errors are multiples of the resolution, so is the difference of two meshes,
   * and the largest multiple among the last three differences counts. Again
   * with a factor of 3/2.
   */
  double error_of_width(const std::vector<ValueOnMesh> &values);

  /**
   * The same on the last of these meshes for another solution, of which nothing
   * is known but the resolution of its width: the multiple is that of the
   * values.
   */
  double error_of_width(const std::vector<ValueOnMesh> &values,
                        const double                    resolution);

  /**
   * A value with as many digits as its error leaves it, and that: "0.0598 ±
   * 0.0003", with the error rounded up to one digit; "0.06 ± ?" if it is
   * unknown.
   */
  std::string with_error(const double value, const double error);
} // namespace Friction

#endif

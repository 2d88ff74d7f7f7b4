#ifndef friction_contact_peak_pressure_h
#define friction_contact_peak_pressure_h

#include <common/contact/contact_state.h>
#include <common/discretization/discrete_problem.h>

#include <algorithm>

namespace Friction
{
  /**
   * The unit of a Certificate.
   *
   * The peak pressure is the largest normal stress at a node in contact, or the
   * largest stress of friction whose bound is given (and not that bound, which
   * may be anything where all is to be glued), and counts as no less than a
   * thousandth of the largest stress_inside() at a node that may get into
   * contact: a node that barely touches is no measure of anything. If no node
   * touches, the largest stress_inside() of all nodes takes its place.
   */
  template <int dim>
  class PeakPressure
  {
  public:
    /**
     * Collective. Displacement and problem are kept by reference.
     * @param residual  f - A u, at all nodes.
     */
    PeakPressure(const DiscreteProblem<dim> &problem,
                 const VectorType           &u,
                 const VectorType           &residual,
                 const ContactState         &state);

    /** A stress. */
    double
    value() const
    {
      return stress;
    }

    /** A force at a node, relative to that of the peak pressure on @p measure,
     * and to no less than force_of_rounding(). */
    double
    relative_force(const double       force,
                   const unsigned int node,
                   const double       measure) const
    {
      return relative(force, node, stress * measure);
    }

    /** The same at a node off the contact boundary, whose cells may have more
     * to bear than the contact. */
    double
    relative_force_inside(const double force, const unsigned int node) const
    {
      return relative(force,
                      node,
                      std::max(stress, stress_inside(node)) *
                        problem.face_measures[node]);
    }

    /**
     * The stress that the cells around a node bear: half the sum of the forces
     * $|A_{pq}(u_q-u_p)|$ that neighbours exert, per face. Rigid translations
     * do not enter.
     */
    double stress_inside(const unsigned int node) const;

    /** The measure of all nodes in contact, on all processes: a length in 2D,
     * an area in 3D. */
    double
    contact_measure() const
    {
      return touching;
    }

    /**
     * A part in 1e8, or two in three dimensions, of the force that the
     * displacement of a node would cause if all others stayed where they are;
     * in a later load step the largest one of the step before, if that is
     * larger. Of what is left where a body merely moves, or where all loads
     * have been taken away, nothing but rounding errors, this is still a large
     * multiple.
     */
    double force_of_rounding(const unsigned int node) const;

  private:
    const DiscreteProblem<dim> &problem;
    const VectorType           &u;
    double                      stress = 0, touching = 0;
    double                      previous_length = 0;

    // Nothing is no part of nothing.
    double
    relative(const double       force,
             const unsigned int node,
             const double       unit) const
    {
      return force == 0 ? 0. : force / std::max(unit, force_of_rounding(node));
    }
  };
} // namespace Friction

#endif

#ifndef friction_output_level_records_h
#define friction_output_level_records_h

#include <common/algorithms/solver_report.h>
#include <common/discretization/discretization.h>
#include <common/output/history.h>

#include <string>
#include <vector>

namespace Friction
{
  /** All records of one level; see History. */
  template <int dim>
  struct LevelRecords
  {
    /// What the solver has cost this process.
    PhaseCosts  costs{};
    std::size_t matrix_memory = 0;
    std::size_t solver_memory = 0;

    /// What the solver has tried, if that was more than one thing.
    std::string attempts;

    LevelRecord              level;
    std::vector<CycleRecord> cycles;
    std::vector<OuterRecord> outer;

    /// Those of all contact nodes, on the first process; empty on the others.
    /// Sorted by their points, so that neither the numbering of nodes nor the
    /// number of processes matters.
    std::vector<ContactRecord<dim>> contact;

    /// Those of the contact nodes that this process owns.
    std::vector<ContactRecord<dim>> own_contact;

    /// If they are wanted: one record. Left to the caller.
    std::vector<ForceRecord<dim>> forces;
  };

  /**
   * Turns what the solver has found on a level into records.
   *
   * The solver's residual is $f-Au$, so that the force of the obstacle on the
   * body, $R=Au-f$, is its negative (see contact_force()); $\tau(p)=-R(p)\cdot
   * n(p)$ is positive in contact, and over the nodal measure a pressure. From
   * the nodes are summed up
   * - the numbers of nodes in contact, and sticking: flags of the state;
   * - the normal forces, and the vectors of the tangential forces. Where a
   *   scene is symmetric, the latter cancel, and a norm near zero does not mean
   *   that there is no friction;
   * - the measure of the zones of contact and stick. In two dimensions their
   *   half-widths are half of it, and sensible only if the zone is connected,
   *   not those of several contact boundaries, over which all of this is
   * summed; in three they are the radii of circles of that area. The edge of a
   * zone is not known better than to a cell.
   *
   * The number of cycles is that of all outer iterations; there is one of these
   * unless Algorithm 2 is used. The estimated error and the seconds are left to
   * the caller.
   *
   * All of it is about the contact nodes of all processes. A collective
   * operation; every process gets the same numbers.
   *
   * @param report  of the solution @p displacement, @p state.
   */
  template <int dim>
  LevelRecords<dim>
  make_level_records(const unsigned int         level,
                     const Discretization<dim> &discretization,
                     const VectorType          &displacement,
                     const ContactState        &state,
                     const SolverReport        &report);
} // namespace Friction

#endif

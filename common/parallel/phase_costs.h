#ifndef friction_parallel_phase_costs_h
#define friction_parallel_phase_costs_h

#include <array>
#include <chrono>
#include <cstddef>

namespace Friction
{
  /** The parts of a solution whose costs are counted apart. */
  enum class SolverPhase
  {
    leading_sweeps, ///< relaxation on the leaf mesh
    coarse_sweeps,  ///< relaxation on the levels
    transfer,       ///< between the levels, and between them and the leaf mesh
    coarsest,       ///< the problem of the coarsest level
    matrix_updates, ///< linearisation, and level matrices brought up to date
    line_search,    ///< recombination, products with the matrix, line search
    other           ///< everything else: norms, energy, certificate
  };

  constexpr unsigned int n_solver_phases = 7;

  /** The name of a phase, for tables. */
  const char *name_of(const SolverPhase phase);

  /** What one process has spent on one phase. */
  struct PhaseCost
  {
    double      seconds    = 0; ///< wall time, waiting included
    double      waiting    = 0; ///< for messages and reductions
    std::size_t messages   = 0; ///< sent from point to point
    std::size_t bytes      = 0; ///< in those messages
    std::size_t reductions = 0; ///< sums, maxima, ... over all processes

    PhaseCost operator-(const PhaseCost &other) const;
  };

  using PhaseCosts = std::array<PhaseCost, n_solver_phases>;

  /** What has been added from @p before to @p after. */
  PhaseCosts operator-(const PhaseCosts &after, const PhaseCosts &before);

  /**
   * What this process has spent since it started, by phase.
   *
   * Communication is counted where it happens, in GhostExchange and in the
   * reductions of reductions.h, rather than estimated. What Trilinos sends
   * while it solves the coarsest problem, and what deal.II sends during set-up,
   * is not seen here.
   *
   * The costs belong to the process and not to any object, since the present
   * phase is a matter of where the program is: a PhaseScope says so for as long
   * as it lives.
   */
  PhaseCosts phase_costs();

  /** Sets the phase of what is counted until the object is destroyed, when the
   * phase before it is resumed. */
  class PhaseScope
  {
  public:
    explicit PhaseScope(const SolverPhase phase);
    ~PhaseScope();

    PhaseScope(const PhaseScope &)            = delete;
    PhaseScope &operator=(const PhaseScope &) = delete;

  private:
    const SolverPhase before;
  };

  /** To be called by whoever sends a message. */
  void count_message(const std::size_t bytes);

  /** To be called by whoever takes part in a reduction. */
  void count_reduction();

  /** Counts the time until it is destroyed as waiting. */
  class WaitingScope
  {
  public:
    WaitingScope();
    ~WaitingScope();

    WaitingScope(const WaitingScope &)            = delete;
    WaitingScope &operator=(const WaitingScope &) = delete;

  private:
    const std::chrono::steady_clock::time_point start;
  };
} // namespace Friction

#endif

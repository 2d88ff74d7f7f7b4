#ifndef friction_parallel_communication_count_h
#define friction_parallel_communication_count_h

#include <array>
#include <cstddef>

namespace Friction
{
  /** The parts of a solution whose communication is counted apart. */
  enum class SolverPhase
  {
    leading_sweeps, ///< relaxation on the leaf mesh
    coarse_sweeps,  ///< relaxation on the levels
    transfer,       ///< between the levels, and between them and the leaf mesh
    coarsest,       ///< of the coarsest problem; only what we send ourselves
    matrix_updates, ///< changed truncations, and level matrices across
                    ///< processes
    line_search,    ///< recombination, line search, norms
    other           ///< everything else: set-up, certificate
  };

  constexpr unsigned int n_solver_phases = 7;

  /** The name of a phase, for tables. */
  const char *name_of(const SolverPhase phase);

  /** What one process has sent in one phase. */
  struct CommunicationCount
  {
    std::size_t messages   = 0; ///< point to point
    std::size_t bytes      = 0; ///< in those messages
    std::size_t reductions = 0; ///< sums, maxima, ... over all processes

    CommunicationCount operator-(const CommunicationCount &other) const;
  };

  using CommunicationCounts = std::array<CommunicationCount, n_solver_phases>;

  /**
   * What this process has sent since it started, by phase.
   *
   * Communication is counted where it happens, in GhostExchange and in the
   * reductions of reductions.h, rather than estimated. What Trilinos sends
   * while it solves the coarsest problem, and what deal.II sends during set-up,
   * is not seen here.
   *
   * The counts belong to the process and not to any object, since the present
   * phase is a matter of where the program is: a CommunicationPhase says so for
   * as long as it lives.
   */
  const CommunicationCounts &communication_counts();

  /** Sets the phase of what is counted until the object is destroyed, when the
   * phase before it is resumed. */
  class CommunicationPhase
  {
  public:
    explicit CommunicationPhase(const SolverPhase phase);
    ~CommunicationPhase();

    CommunicationPhase(const CommunicationPhase &)            = delete;
    CommunicationPhase &operator=(const CommunicationPhase &) = delete;

  private:
    const SolverPhase before;
  };

  /** To be called by whoever sends a message. */
  void count_message(const std::size_t bytes);

  /** To be called by whoever takes part in a reduction. */
  void count_reduction();
} // namespace Friction

#endif

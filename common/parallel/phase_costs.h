#ifndef friction_parallel_phase_costs_h
#define friction_parallel_phase_costs_h

#include <deal.II/base/mpi.h>

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
    coarsest,       ///< the problem of the coarsest level, or of contact nodes
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
   * What this process has spent on one discrete problem, by phase.
   *
   * Communication is counted where it happens, in GhostExchange, in the
   * reductions of reductions.h, in the updates of LevelMatrices and in the
   * scalar products of AlgebraicSolver, rather than estimated. What else
   * Trilinos and deal.II send is not seen here.
   *
   * The account is attached to a communicator (see SolverCommunicator), and
   * found again by all that is given this communicator.
   */
  class CostAccount
  {
  public:
    CostAccount();

    CostAccount(const CostAccount &)            = delete;
    CostAccount &operator=(const CostAccount &) = delete;

    /** Makes this the account of @p communicator, which it must outlive. */
    void attach(const MPI_Comm communicator);

    /** The account of a communicator; null if it has none. */
    static CostAccount *of(const MPI_Comm communicator);

    /** Books the time that has passed, and goes on in another phase. Returns
     * the phase until now. */
    SolverPhase change_phase(const SolverPhase phase);

    /** What has been spent until now. */
    const PhaseCosts &costs();

    /** Of the present phase. */
    PhaseCost &
    present_cost()
    {
      return all_costs[static_cast<unsigned int>(present)];
    }

  private:
    using Clock = std::chrono::steady_clock;

    PhaseCosts        all_costs{};
    SolverPhase       present = SolverPhase::other;
    Clock::time_point since;
  };

  /** What has been counted for @p communicator until now; nothing if it has no
   * account. */
  PhaseCosts phase_costs(const MPI_Comm communicator);

  /** Sets the phase of what is counted until the object is destroyed, when the
   * phase before it is resumed. */
  class PhaseScope
  {
  public:
    PhaseScope(const MPI_Comm communicator, const SolverPhase phase);
    ~PhaseScope();

    PhaseScope(const PhaseScope &)            = delete;
    PhaseScope &operator=(const PhaseScope &) = delete;

  private:
    CostAccount *const account;
    SolverPhase        before;
  };

  /** Counts a message of so many bytes that this process sends. */
  void count_message(const MPI_Comm communicator, const std::size_t bytes);

  /** Counts a reduction over all processes. */
  void count_reduction(const MPI_Comm communicator);

  /** Counts the time until it is destroyed as waiting. */
  class WaitingScope
  {
  public:
    explicit WaitingScope(const MPI_Comm communicator);
    ~WaitingScope();

    WaitingScope(const WaitingScope &)            = delete;
    WaitingScope &operator=(const WaitingScope &) = delete;

  private:
    CostAccount *const                          account;
    const std::chrono::steady_clock::time_point start;
  };
} // namespace Friction

#endif

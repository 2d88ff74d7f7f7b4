#include <common/parallel/phase_costs.h>

namespace Friction
{
  namespace
  {
    using Clock = std::chrono::steady_clock;

    PhaseCosts        costs;
    SolverPhase       present = SolverPhase::other;
    Clock::time_point since   = Clock::now();

    PhaseCost &
    present_cost()
    {
      return costs[static_cast<unsigned int>(present)];
    }

    double
    seconds_since(const Clock::time_point start, const Clock::time_point end)
    {
      return std::chrono::duration<double>(end - start).count();
    }

    // Time is booked when the phase changes.
    void
    change_phase(const SolverPhase phase)
    {
      const Clock::time_point now = Clock::now();
      present_cost().seconds += seconds_since(since, now);
      since   = now;
      present = phase;
    }
  } // namespace



  const char *
  name_of(const SolverPhase phase)
  {
    constexpr const char *names[n_solver_phases] = {"leading sweeps",
                                                    "coarse sweeps",
                                                    "transfer",
                                                    "coarsest level",
                                                    "matrix updates",
                                                    "line search",
                                                    "other"};
    return names[static_cast<unsigned int>(phase)];
  }



  PhaseCost
  PhaseCost::operator-(const PhaseCost &other) const
  {
    return {seconds - other.seconds,
            waiting - other.waiting,
            messages - other.messages,
            bytes - other.bytes,
            reductions - other.reductions};
  }



  PhaseCosts
  operator-(const PhaseCosts &after, const PhaseCosts &before)
  {
    PhaseCosts result;
    for (unsigned int i = 0; i < n_solver_phases; ++i)
      result[i] = after[i] - before[i];
    return result;
  }



  PhaseCosts
  phase_costs()
  {
    change_phase(present);
    return costs;
  }



  PhaseScope::PhaseScope(const SolverPhase phase)
    : before(present)
  {
    change_phase(phase);
  }



  PhaseScope::~PhaseScope()
  {
    change_phase(before);
  }



  void
  count_message(const std::size_t bytes)
  {
    ++present_cost().messages;
    present_cost().bytes += bytes;
  }



  void
  count_reduction()
  {
    ++present_cost().reductions;
  }



  WaitingScope::WaitingScope()
    : start(Clock::now())
  {}



  WaitingScope::~WaitingScope()
  {
    present_cost().waiting += seconds_since(start, Clock::now());
  }
} // namespace Friction

#include <common/parallel/phase_costs.h>

namespace Friction
{
  namespace
  {
    double
    seconds_until(const std::chrono::steady_clock::time_point start,
                  const std::chrono::steady_clock::time_point end)
    {
      return std::chrono::duration<double>(end - start).count();
    }

    // The key under which MPI keeps accounts.
    int
    account_key()
    {
      static const int key = []() {
        int new_key = MPI_KEYVAL_INVALID;
        MPI_Comm_create_keyval(
          MPI_COMM_NULL_COPY_FN, MPI_COMM_NULL_DELETE_FN, &new_key, nullptr);
        return new_key;
      }();
      return key;
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



  CostAccount::CostAccount()
    : since(Clock::now())
  {}



  void
  CostAccount::attach(const MPI_Comm communicator)
  {
    MPI_Comm_set_attr(communicator, account_key(), this);
  }



  CostAccount *
  CostAccount::of(const MPI_Comm communicator)
  {
    void *account = nullptr;
    int   found   = 0;
    MPI_Comm_get_attr(communicator, account_key(), &account, &found);
    return found ? static_cast<CostAccount *>(account) : nullptr;
  }



  SolverPhase
  CostAccount::change_phase(const SolverPhase phase)
  {
    const Clock::time_point now = Clock::now();
    present_cost().seconds += seconds_until(since, now);
    since                    = now;
    const SolverPhase before = present;
    present                  = phase;
    return before;
  }



  const PhaseCosts &
  CostAccount::costs()
  {
    change_phase(present);
    return all_costs;
  }



  PhaseCosts
  phase_costs(const MPI_Comm communicator)
  {
    CostAccount *const account = CostAccount::of(communicator);
    return account != nullptr ? account->costs() : PhaseCosts{};
  }



  PhaseScope::PhaseScope(const MPI_Comm communicator, const SolverPhase phase)
    : account(CostAccount::of(communicator))
    , before(phase)
  {
    if (account != nullptr)
      before = account->change_phase(phase);
  }



  PhaseScope::~PhaseScope()
  {
    if (account != nullptr)
      account->change_phase(before);
  }



  void
  count_message(const MPI_Comm communicator, const std::size_t bytes)
  {
    if (CostAccount *const account = CostAccount::of(communicator))
      {
        ++account->present_cost().messages;
        account->present_cost().bytes += bytes;
      }
  }



  void
  count_reduction(const MPI_Comm communicator)
  {
    if (CostAccount *const account = CostAccount::of(communicator))
      ++account->present_cost().reductions;
  }



  WaitingScope::WaitingScope(const MPI_Comm communicator)
    : account(CostAccount::of(communicator))
    , start(std::chrono::steady_clock::now())
  {}



  WaitingScope::~WaitingScope()
  {
    if (account != nullptr)
      account->present_cost().waiting +=
        seconds_until(start, std::chrono::steady_clock::now());
  }
} // namespace Friction

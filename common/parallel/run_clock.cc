#include <common/parallel/run_clock.h>

#include <iomanip>
#include <numeric>
#include <sstream>

namespace Friction
{
  namespace
  {
    constexpr const char *part_names[n_run_parts] = {"start and other",
                                                     "mesh",
                                                     "degrees of freedom",
                                                     "transfer to next mesh",
                                                     "contact nodes",
                                                     "assembly",
                                                     "levels and smoother",
                                                     "solution",
                                                     "error estimate",
                                                     "records",
                                                     "fields"};

    // The key under which MPI keeps clocks. A duplicate of a communicator has
    // the same one.
    int
    clock_key()
    {
      static const int key = []() {
        int new_key = MPI_KEYVAL_INVALID;
        MPI_Comm_create_keyval(
          MPI_COMM_DUP_FN, MPI_COMM_NULL_DELETE_FN, &new_key, nullptr);
        return new_key;
      }();
      return key;
    }
  } // namespace



  RunClock::RunClock(const std::chrono::steady_clock::time_point begin)
    : since(begin)
  {}



  RunClock::~RunClock()
  {
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (attached_to != MPI_COMM_NULL && !finalized)
      MPI_Comm_delete_attr(attached_to, clock_key());
  }



  void
  RunClock::attach(const MPI_Comm communicator)
  {
    attached_to = communicator;
    MPI_Comm_set_attr(communicator, clock_key(), this);
  }



  RunClock *
  RunClock::of(const MPI_Comm communicator)
  {
    void *clock = nullptr;
    int   found = 0;
    MPI_Comm_get_attr(communicator, clock_key(), &clock, &found);
    return found ? static_cast<RunClock *>(clock) : nullptr;
  }



  RunPart
  RunClock::change_part(const RunPart part)
  {
    const Clock::time_point now = Clock::now();
    all_seconds[static_cast<unsigned int>(present)] +=
      std::chrono::duration<double>(now - since).count();
    since                = now;
    const RunPart before = present;
    present              = part;
    return before;
  }



  const std::array<double, n_run_parts> &
  RunClock::seconds()
  {
    change_part(present);
    return all_seconds;
  }



  std::string
  RunClock::describe()
  {
    const auto        &parts = seconds();
    const double       all   = std::accumulate(parts.begin(), parts.end(), 0.);
    std::ostringstream text;
    text << std::fixed << "Parts of the run         seconds   share";
    const auto print = [&](const std::string &name, const double seconds) {
      text << '\n'
           << std::left << std::setw(22) << name << std::right
           << std::setprecision(2) << std::setw(10) << seconds
           << std::setprecision(1) << std::setw(7) << 100. * seconds / all
           << '%';
    };
    for (unsigned int i = 0; i < n_run_parts; ++i)
      print(part_names[i], parts[i]);
    print("all", all);
    return text.str();
  }



  RunScope::RunScope(const MPI_Comm communicator, const RunPart part)
    : clock(RunClock::of(communicator))
    , before(part)
  {
    if (clock != nullptr)
      before = clock->change_part(part);
  }



  RunScope::~RunScope()
  {
    if (clock != nullptr)
      clock->change_part(before);
  }
} // namespace Friction

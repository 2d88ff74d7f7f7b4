#include <common/parallel/run_clock.h>

#include <initializer_list>
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

    using PlaceOfClock = std::shared_ptr<RunClock *>;

    // A communicator has a place of its own, which goes with it.
    int
    copy_place(MPI_Comm, int, void *, void *place, void *new_place, int *flag)
    {
      *static_cast<void **>(new_place) =
        new PlaceOfClock(*static_cast<PlaceOfClock *>(place));
      *flag = 1;
      return MPI_SUCCESS;
    }

    int
    delete_place(MPI_Comm, int, void *place, void *)
    {
      delete static_cast<PlaceOfClock *>(place);
      return MPI_SUCCESS;
    }

    // The key under which MPI keeps clocks. A duplicate of a communicator has
    // the same one.
    int
    clock_key()
    {
      static const int key = []() {
        int new_key = MPI_KEYVAL_INVALID;
        MPI_Comm_create_keyval(copy_place, delete_place, &new_key, nullptr);
        return new_key;
      }();
      return key;
    }
  } // namespace



  RunClock::RunClock(const std::chrono::steady_clock::time_point begin)
    : since(begin)
    , place(std::make_shared<RunClock *>(this))
  {}



  RunClock::~RunClock()
  {
    *place = nullptr;
  }



  void
  RunClock::attach(const MPI_Comm communicator)
  {
    MPI_Comm_set_attr(communicator, clock_key(), new PlaceOfClock(place));
  }



  RunClock *
  RunClock::of(const MPI_Comm communicator)
  {
    void *place = nullptr;
    int   found = 0;
    MPI_Comm_get_attr(communicator, clock_key(), &place, &found);
    return found ? **static_cast<PlaceOfClock *>(place) : nullptr;
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
  RunClock::summary()
  {
    const auto  &parts = seconds();
    const double all   = std::accumulate(parts.begin(), parts.end(), 0.);
    const auto   sum   = [&](const std::initializer_list<RunPart> some) {
      double result = 0;
      for (const RunPart part : some)
        result += parts[static_cast<unsigned int>(part)];
      return result;
    };
    const double levels   = sum({RunPart::dofs,
                                 RunPart::contact,
                                 RunPart::assembly,
                                 RunPart::levels,
                                 RunPart::solution}),
                 mesh     = sum({RunPart::mesh, RunPart::transfer}),
                 estimate = sum({RunPart::estimate}),
                 files    = sum({RunPart::records, RunPart::fields});
    std::ostringstream text;
    text << std::fixed << std::setprecision(2) << "Time of the run: " << all
         << " s, of which " << levels
         << " to set up and solve (the column seconds), " << mesh
         << " for the mesh, " << estimate << " for error estimates, " << files
         << " for files, " << all - levels - mesh - estimate - files
         << " for start and other.";
    return text.str();
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

#ifndef friction_parallel_run_clock_h
#define friction_parallel_run_clock_h

#include <deal.II/base/mpi.h>

#include <array>
#include <chrono>
#include <memory>
#include <string>

namespace Friction
{
  /** The parts of a run whose times are taken apart. */
  enum class RunPart
  {
    start,    ///< MPI, parameters, and all that belongs to no other part
    mesh,     ///< making and refining it: deal.II, p4est
    dofs,     ///< degrees of freedom, their numbers, hanging nodes: deal.II
    transfer, ///< of displacements and tractions to the next mesh
    contact,  ///< nodal constraints and the contact boundary
    assembly, ///< couplings, stiffness, loads
    levels,   ///< hierarchy, transfers and matrices of the levels, smoother
    solution, ///< cycles and certificates
    estimate, ///< error estimates, and what is marked
    records,  ///< history, records, checkpoints, warnings
    fields    ///< files for ParaView
  };

  constexpr unsigned int n_run_parts =
    static_cast<unsigned int>(RunPart::fields) + 1;

  /**
   * Where the wall time of a run goes on this process.
   *
   * Three accounts of time answer three questions. This one: what does the user
   * wait for, from the start of the program to its end, whatever level it is
   * on? CostAccount: what does one discrete problem cost, by the phases of its
   * solution, in seconds and in messages, the time spent waiting for other
   * processes among them? Its seconds are a part of RunPart::solution and
   * RunPart::levels here. And LevelRecord::setup_seconds and solve_seconds,
   * which are read off a deal.II Timer: how long did one level take? They are
   * numbers of the results, which a program without either account has, too.
   *
   * The clock is attached to a communicator, as CostAccount is, and to all that
   * are duplicated from it afterwards; RunScope finds it there, as long as the
   * clock exists. A program without a clock, a test for example, does without.
   */
  class RunClock
  {
  public:
    /** @param begin  since when the first part has been going on. */
    explicit RunClock(const std::chrono::steady_clock::time_point begin =
                        std::chrono::steady_clock::now());
    ~RunClock();

    RunClock(const RunClock &)            = delete;
    RunClock &operator=(const RunClock &) = delete;

    /** Makes this the clock of @p communicator. Call it once. */
    void attach(const MPI_Comm communicator);

    /** The clock of a communicator; null if it has none. */
    static RunClock *of(const MPI_Comm communicator);

    /** Books the time that has passed, and goes on in another part. Returns the
     * part until now. */
    RunPart change_part(const RunPart part);

    /** Seconds until now, by part. */
    const std::array<double, n_run_parts> &seconds();

    /** One sentence: the whole time, and what is in the column 'seconds' of the
     * table of levels, files and the rest of it. */
    std::string summary();

    /** A table of the parts, with the share that each has in the whole. Of this
     * process: where it waits for others is not told. */
    std::string describe();

  private:
    using Clock = std::chrono::steady_clock;

    std::array<double, n_run_parts> all_seconds{};
    RunPart                         present = RunPart::start;
    Clock::time_point               since;

    // What communicators keep: where the clock is, or that it is gone.
    std::shared_ptr<RunClock *> place;
  };

  /** Sets the part of the run until the object is destroyed, when the part
   * before it is resumed. */
  class RunScope
  {
  public:
    RunScope(const MPI_Comm communicator, const RunPart part);
    ~RunScope();

    RunScope(const RunScope &)            = delete;
    RunScope &operator=(const RunScope &) = delete;

  private:
    RunClock *const clock;
    RunPart         before;
  };
} // namespace Friction

#endif

#ifndef friction_output_console_h
#define friction_output_console_h

#include <common/output/history.h>
#include <common/parameters/parameters.h>

#include <deal.II/base/mpi.h>

#include <chrono>
#include <iosfwd>
#include <string>
#include <vector>

namespace Friction
{
  /**
   * The table a run prints: one row per level, as the level completes, and a
   * sign of life inside long levels.
   *
   * On a terminal the sign of life is one line that is overwritten; in a file
   * it is a line of its own every five seconds, and later on every time that
   * the run has got longer by a tenth. Nothing of what depends on the
   * clock is printed if times are switched off, so that the output can be
   * compared from run to run.
   *
   * Without progress, rows and remarks are all; a silent console prints
   * warnings and nothing else. With several processes only that of the first
   * one prints at all.
   */
  class Console
  {
  public:
    enum class Times
    {
      shown,
      hidden ///< no column of seconds, no progress
    };

    /// A remark, and after how many rows it was made.
    struct Note
    {
      unsigned int rows = 0;
      std::string  text;

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &rows &text;
      }
    };

    /**
     * @param out where to print; must outlive this object. If it is std::cout
     *            and that is a terminal, progress lines are overwritten.
     */
    explicit Console(std::ostream   &out,
                     const Times     times        = Times::shown,
                     const Verbosity verbosity    = Verbosity::cycles,
                     const MPI_Comm  communicator = MPI_COMM_SELF);

    /// The row of a level that is complete; before the first one the header.
    void level_complete(const LevelRecord &record);

    /**
     * To be called after each cycle; prints only if the level has been running
     * for more than two seconds, and not too often then.
     */
    void progress(const unsigned int level,
                  const unsigned int cycle,
                  const double       increment);

    /// A line of text between the rows: a remark.
    void note(const std::string &text);

    /// The same for a warning or an error, which even a silent console prints.
    void warning(const std::string &text);

    /// All remarks so far, whether they were printed or not.
    const std::vector<Note> &notes() const;

    /// Print what a run that is continued has printed: its rows and remarks.
    void repeat(const std::vector<LevelRecord> &levels,
                const std::vector<Note>        &notes);

  private:
    using Clock = std::chrono::steady_clock;

    void clear_progress();

    std::ostream &out;
    const bool    first_process;
    const bool    show_times;
    const bool    silent;
    const bool    show_progress;
    const bool    terminal;

    unsigned int      rows = 0;
    std::vector<Note> remarks;
    std::size_t       progress_width = 0;
    Clock::time_point start;
    Clock::time_point level_start;
    Clock::time_point last_progress;
  };
} // namespace Friction

#endif

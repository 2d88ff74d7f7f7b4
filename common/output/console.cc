#include <common/output/console.h>
#include <unistd.h>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace Friction
{
  Console::Console(std::ostream   &out,
                   const Times     times,
                   const Verbosity verbosity,
                   const MPI_Comm  communicator)
    : out(out)
    , first_process(dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    , show_times(times == Times::shown)
    , silent(verbosity == Verbosity::quiet || !first_process)
    , show_progress(verbosity == Verbosity::cycles && first_process &&
                    show_times)
    , terminal(&out == &std::cout && ::isatty(STDOUT_FILENO) != 0)
    , start(Clock::now())
    , level_start(start)
    , last_progress(start)
  {}



  void
  Console::level_complete(const LevelRecord &record)
  {
    // The next level starts here.
    level_start   = Clock::now();
    last_progress = level_start;
    ++rows;
    if (silent)
      return;

    clear_progress();

    std::ostringstream line;
    if (rows == 1)
      line << "level     cells      dofs  contact   sticky  outer  cycles"
           << "   rate        energy" << (show_times ? "   seconds" : "")
           << '\n';

    line << std::setw(5) << record.level << std::setw(10) << record.cells
         << std::setw(10) << record.dofs << std::setw(9) << record.contact_nodes
         << std::setw(9) << record.sticky_nodes << std::setw(7)
         << record.outer_iterations << std::setw(8) << record.cycles
         << std::fixed << std::setprecision(3) << std::setw(7)
         << record.contraction << std::scientific << std::setprecision(5)
         << std::setw(14) << record.energy;
    if (show_times)
      line << std::fixed << std::setprecision(2) << std::setw(10)
           << record.setup_seconds + record.solve_seconds;

    // Flushed, since the next row may take long and the output may be a pipe.
    out << line.str() << std::endl;
  }



  void
  Console::progress(const unsigned int level,
                    const unsigned int cycle,
                    const double       increment)
  {
    if (!show_progress)
      return;

    const Clock::time_point now = Clock::now();
    using Seconds               = std::chrono::duration<double>;
    if (Seconds(now - level_start).count() < 2.)
      return;
    // A terminal shows the present state. A file that is read as it grows gets
    // a line every few seconds, of a long run fewer, so that it stays short.
    const double elapsed = Seconds(now - start).count();
    if (Seconds(now - last_progress).count() <
        (terminal ? 0.2 : std::max(5., .1 * elapsed)))
      return;
    last_progress = now;

    std::ostringstream line;
    line << "  level " << level << ": cycle " << cycle << ", increment "
         << std::scientific << std::setprecision(1) << increment << ", after "
         << std::fixed << std::setprecision(0) << elapsed << " s";
    if (terminal)
      {
        const std::string text = line.str();
        out << '\r' << text
            << std::string(progress_width > text.size()
                             ? progress_width - text.size()
                             : 0,
                           ' ')
            << std::flush;
        progress_width = std::max(progress_width, text.size());
      }
    else
      out << line.str() << std::endl;
  }



  void
  Console::note(const std::string &text)
  {
    Note note;
    note.rows = rows;
    note.text = text;
    remarks.push_back(note);
    if (!silent)
      warning(text);
  }



  void
  Console::warning(const std::string &text)
  {
    if (!first_process)
      return;
    clear_progress();
    out << text << std::endl;
  }



  const std::vector<Console::Note> &
  Console::notes() const
  {
    return remarks;
  }



  void
  Console::repeat(const std::vector<LevelRecord> &levels,
                  const std::vector<Note>        &notes)
  {
    auto       next            = notes.begin();
    const auto notes_up_to_row = [&]() {
      for (; next != notes.end() && next->rows <= rows; ++next)
        note(next->text);
    };
    notes_up_to_row();
    for (const LevelRecord &level : levels)
      {
        level_complete(level);
        notes_up_to_row();
      }
  }



  void
  Console::clear_progress()
  {
    if (progress_width == 0)
      return;
    out << '\r' << std::string(progress_width, ' ') << '\r';
    progress_width = 0;
  }
} // namespace Friction

#include <common/output/run_directory.h>
#include <common/parallel/collective_error.h>
#include <common/printable.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace Friction
{
  namespace
  {
    std::string
    temporary_name(const std::filesystem::path &final_path)
    {
      return (final_path.parent_path() /
              (final_path.stem().string() + ".part" +
               final_path.extension().string()))
        .string();
    }



    // Removes the temporary file on the way out, however we leave, unless it
    // has been renamed before.
    class TemporaryFile
    {
    public:
      explicit TemporaryFile(const std::filesystem::path &final_path)
        : final_path(final_path)
        , temporary(temporary_name(final_path))
      {}

      TemporaryFile(const TemporaryFile &)            = delete;
      TemporaryFile &operator=(const TemporaryFile &) = delete;

      ~TemporaryFile()
      {
        if (!renamed)
          {
            std::error_code ignored;
            std::filesystem::remove(temporary, ignored);
          }
      }

      std::string
      name() const
      {
        return temporary.string();
      }

      // Not before the contents are on the disk: otherwise a power failure
      // might leave the final name with nothing behind it.
      void
      rename()
      {
        flush_to_disk(temporary.string());
        std::error_code error;
        std::filesystem::rename(temporary, final_path, error);
        if (error)
          throw InputError("The file '" + final_path.string() +
                           "' cannot be written: " + error.message() + ".");
        renamed = true;
      }

      // Another process renames it, or removes it.
      void
      leave_alone()
      {
        renamed = true;
      }

    private:
      const std::filesystem::path final_path;
      const std::filesystem::path temporary;
      bool                        renamed = false;
    };



    // Streams keep silent about why they failed; the system still knows, as
    // long as nothing else has been asked of it.
    std::string
    reason()
    {
      return errno != 0 ? std::string(std::strerror(errno))
                        : std::string("is the disk full?");
    }
  } // namespace



  void
  write_then_rename(
    const std::string                                            &final_name,
    const std::function<void(const std::string &temporary_name)> &write_to)
  {
    TemporaryFile temporary(final_name);
    write_to(temporary.name());
    temporary.rename();
  }



  void
  write_stream_then_rename(const std::string &final_name,
                           const std::function<void(std::ostream &)> &write_to)
  {
    write_then_rename(final_name, [&](const std::string &temporary) {
      errno = 0;
      std::ofstream out(temporary, std::ios::binary);
      if (!out)
        throw InputError("The file '" + final_name +
                         "' cannot be written: " + reason() + ".");

      // Some writers throw when their stream fails, others go on. Both end
      // here: if the stream is bad, what they throw says less than we do.
      try
        {
          write_to(out);
        }
      catch (...)
        {
          if (out)
            throw;
        }

      // The last bytes reach the disk, or fail to, only now.
      out.close();
      if (!out)
        throw InputError("The file '" + final_name +
                         "' cannot be written completely: " + reason() + ".");
    });
  }



  void
  flush_to_disk(const std::string &path)
  {
    errno               = 0;
    const int  file     = ::open(path.c_str(), O_RDONLY);
    const bool complete = file >= 0 && ::fsync(file) == 0;
    // Some file systems cannot flush a directory, and need not.
    const bool        pointless = file >= 0 && errno == EINVAL;
    const std::string why       = reason();
    if (file >= 0)
      ::close(file);
    if (!complete && !pointless)
      throw InputError("The file '" + path +
                       "' cannot be written completely: " + why + ".");
  }



  // Asking is not enough: the file system does not know quotas of its users,
  // nor what others are about to write. MPI does not even say if of the last
  // bytes of a file only some were written. So we take the room, and leave it
  // again.
  void
  demand_space(const std::string  &file_name,
               const MPI_Comm      communicator,
               const std::uint64_t size)
  {
    on_first_process(communicator, [&]() {
      std::error_code error;
      const auto      space = std::filesystem::space(
        std::filesystem::absolute(file_name).parent_path(), error);
      bool is_room = error || space.available >= size;
#ifdef __linux__
      const std::string trial = temporary_name(file_name);
      const int         file =
        ::open(trial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
      if (is_room && file >= 0)
        // Some file systems cannot do this, and have other answers.
        is_room = ::fallocate(file, 0, 0, size) == 0 ||
          (errno != ENOSPC && errno != EDQUOT && errno != EFBIG);
      if (file >= 0)
        {
          ::close(file);
          ::unlink(trial.c_str());
        }
#endif
      if (!is_room)
        throw InputError("The file '" + file_name +
                         "' cannot be written: there is not enough space.");
    });
  }



  void
  write_together_then_rename(
    const std::string                                            &final_name,
    const MPI_Comm                                                communicator,
    const std::uint64_t                                           size,
    const std::function<void(const std::string &temporary_name)> &write_to)
  {
    TemporaryFile file(final_name);

    // Only the first process removes and renames.
    const bool first =
      dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
    if (!first)
      file.leave_alone();

    demand_space(final_name, communicator, size);
    try
      {
        write_to(file.name());
      }
    catch (const std::exception &)
      {
        throw_or_abort(communicator,
                       "The file '" + final_name +
                         "' cannot be written completely: is the disk full?");
      }
    // Some processes may have had nothing to write, the first among them.
    MPI_Barrier(communicator);
    on_first_process(communicator, [&]() { file.rename(); });
  }



  RunDirectory::RunDirectory(const std::string &path,
                             const MPI_Comm     communicator)
    : directory(path.empty() ? "." : path)
  {
    on_first_process(communicator, [&]() { create(); });
    on_all_processes(communicator, [&]() {
      create();
      try_to_write(dealii::Utilities::MPI::this_mpi_process(communicator));
    });
  }



  void
  RunDirectory::create() const
  {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (!error && !std::filesystem::is_directory(directory, error))
      error = std::make_error_code(std::errc::not_a_directory);
    if (error)
      throw InputError("The output directory '" + excerpt(directory, 300) +
                       "' cannot be created: " + error.message() + ".");
  }



  // Permissions do not tell everything (read-only file systems, quotas), so we
  // try. The name is our own, also if several processes try at once.
  void
  RunDirectory::try_to_write(const unsigned int rank) const
  {
    const std::filesystem::path probe = std::filesystem::path(directory) /
      (".writable-" + std::to_string(::getpid()) + "-" + std::to_string(rank));
    errno = 0;
    std::ofstream out(probe);
    out << "This file shows that the directory can be written to.\n";
    out.close();
    const bool        writable = !out.fail();
    const std::string why      = reason();
    std::error_code   ignored;
    std::filesystem::remove(probe, ignored);
    if (!writable)
      throw InputError("The output directory '" + excerpt(directory, 300) +
                       "' cannot be written to: " + why + ".");
  }



  const std::string &
  RunDirectory::path() const
  {
    return directory;
  }



  std::string
  RunDirectory::file(const std::string &name) const
  {
    return (std::filesystem::path(directory) / name).string();
  }



  void
  RunDirectory::write(const std::string                         &name,
                      const std::function<void(std::ostream &)> &write_to) const
  {
    write_stream_then_rename(file(name), write_to);
  }



  void
  RunDirectory::remove(const std::string &name) const
  {
    std::error_code error;
    if (std::filesystem::is_directory(file(name), error))
      error = std::make_error_code(std::errc::is_a_directory);
    else
      std::filesystem::remove(file(name), error);
    if (error)
      throw InputError(
        "The file '" + excerpt(file(name), 300) +
        "' of an earlier run cannot be removed: " + error.message() + ".");
  }
} // namespace Friction

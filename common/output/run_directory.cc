#include <common/output/run_directory.h>
#include <common/scene/input_error.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace Friction
{
  namespace
  {
    // Removes the temporary file on the way out, however we leave, unless it
    // has been renamed before.
    class TemporaryFile
    {
    public:
      explicit TemporaryFile(const std::filesystem::path &final_path)
        : final_path(final_path)
        , temporary(final_path.parent_path() /
                    (final_path.stem().string() + ".part" +
                     final_path.extension().string()))
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

      void
      rename()
      {
        std::error_code error;
        std::filesystem::rename(temporary, final_path, error);
        if (error)
          throw InputError("The file '" + final_path.string() +
                           "' cannot be written: " + error.message() + ".");
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



  RunDirectory::RunDirectory(const std::string &path)
    : directory(path.empty() ? "." : path)
  {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (!error && !std::filesystem::is_directory(directory, error))
      error = std::make_error_code(std::errc::not_a_directory);
    if (error)
      throw InputError("The output directory '" + directory +
                       "' cannot be created: " + error.message() + ".");

    // Permissions do not tell everything (read-only file systems, quotas), so
    // we try. The name is our own, also if several processes try at once.
    const std::filesystem::path probe = std::filesystem::path(directory) /
      (".writable-" + std::to_string(::getpid()));
    errno = 0;
    std::ofstream out(probe);
    out << "This file shows that the directory can be written to.\n";
    out.close();
    const bool        writable = !out.fail();
    const std::string why      = reason();
    std::filesystem::remove(probe, error);
    if (!writable)
      throw InputError("The output directory '" + directory +
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
} // namespace Friction

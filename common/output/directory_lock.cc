#include <common/output/directory_lock.h>
#include <common/parallel/collective_error.h>
#include <common/printable.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace Friction
{
  namespace
  {
    // This process, for those who find its lock.
    std::string
    describe_this_process()
    {
      std::array<char, 256> host{};
      if (::gethostname(host.data(), host.size() - 1) != 0)
        host[0] = '?';
      std::array<char, 32> since{};
      const std::time_t    now = std::time(nullptr);
      std::tm              utc{};
      ::gmtime_r(&now, &utc);
      std::strftime(since.data(), since.size(), "%Y-%m-%d %H:%M:%S UTC", &utc);
      return "process " + std::to_string(::getpid()) + " on " + host.data() +
        ", since " + since.data();
    }



    // What a lock file says, which is nothing if it was made just now.
    std::string
    read_lock(const int descriptor)
    {
      std::array<char, 512> text{};
      const auto n = ::pread(descriptor, text.data(), text.size(), 0);
      return n > 0 ? ": " + excerpt(std::string(text.data(), n), 200) : "";
    }



    // Whether a file that we have opened still has its name: the run that had
    // the lock may have removed it in between.
    bool
    has_its_name(const int descriptor, const std::string &name)
    {
      struct ::stat opened, named;
      return ::fstat(descriptor, &opened) == 0 &&
        ::stat(name.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
        opened.st_ino == named.st_ino;
    }
  } // namespace



  DirectoryLock::DirectoryLock(const RunDirectory &directory,
                               const MPI_Comm      communicator)
    : file(directory.file(".lock"))
  {
    on_first_process(communicator, [&]() { lock(directory.path()); });
  }



  void
  DirectoryLock::lock(const std::string &directory)
  {
    // Some file systems give a file another number each time it is looked at.
    for (unsigned int attempt = 0; descriptor < 0; ++attempt)
      {
        const int opened =
          ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (opened < 0)
          throw InputError("The file '" + file + "' cannot be written: " +
                           std::string(std::strerror(errno)) + ".");

        int status;
        do
          status = ::flock(opened, LOCK_EX | LOCK_NB);
        while (status != 0 && errno == EINTR);
        const int error = (status == 0 ? 0 : errno);

        if (error == EWOULDBLOCK)
          {
            const std::string owner = read_lock(opened);
            ::close(opened);
            throw InputError("Another run is writing into the directory '" +
                             directory + "'" + owner +
                             "; wait until it has ended, or set another "
                             "'Output/Directory'.");
          }
        if (error != 0)
          sentence = "Warning: the directory '" + directory +
            "' cannot be locked (" + std::string(std::strerror(error)) +
            "); see to it that no other run writes into it.";
        if (error != 0 || has_its_name(opened, file) || attempt > 10)
          descriptor = opened;
        else
          ::close(opened);
      }

    // On a full disk there may be no room for it; a lock is a lock
    // nevertheless.
    const std::string text    = describe_this_process();
    const bool        written = ::ftruncate(descriptor, 0) == 0 &&
      ::pwrite(descriptor, text.data(), text.size(), 0) >= 0;
    (void)written;
  }



  // As long as the file is locked, its name is ours, unless it was removed by
  // hand.
  DirectoryLock::~DirectoryLock()
  {
    if (descriptor < 0)
      return;
    if (has_its_name(descriptor, file))
      ::unlink(file.c_str());
    ::close(descriptor);
  }



  const std::string &
  DirectoryLock::warning() const
  {
    return sentence;
  }
} // namespace Friction

// Runs a program as if it were this process: by the server of fork_server.cc
// that has it loaded already, or, where there is none, as usual.
//
// Usage: fork-client PROGRAM ARGUMENTS...

#include <sys/wait.h>

#include <cstdio>

#include <fcntl.h>
#include <tests/support/fork_request.h>

extern char **environ;

namespace
{
  int server = -1;



  // We are in the program's directory.
  bool
  connect_to(const std::string &program)
  {
    const sockaddr_un address = Fork::address_of(program);
    const int         one     = socket(AF_UNIX, SOCK_STREAM, 0);
    // Not in the place of a standard file that has been closed.
    server = fcntl(one, F_DUPFD_CLOEXEC, 3);
    close(one);
    return connect(server,
                   reinterpret_cast<const sockaddr *>(&address),
                   sizeof(address)) == 0;
  }



  bool
  ask(const int directory, char **arguments)
  {
    Fork::Request request{};
    std::string   bytes;
    for (; arguments[request.n_arguments] != nullptr; ++request.n_arguments)
      bytes.append(arguments[request.n_arguments]) += '\0';
    for (char **variable = environ; *variable != nullptr; ++variable)
      bytes.append(*variable) += '\0';
    request.n_bytes = bytes.size();
    request.nice    = getpriority(PRIO_PROCESS, 0);
    request.umask   = umask(0);
    umask(request.umask);
    sched_getaffinity(0, sizeof(request.processors), &request.processors);
    for (int i = 0; i < int(RLIM_NLIMITS); ++i)
      getrlimit(decltype(RLIMIT_CPU)(i), &request.limits[i]);
    for (int i = 1; i < NSIG; ++i)
      request.is_ignored[i] = Fork::is_ignored(i);

    const Fork::Files files{{0, 1, 2, directory}};
    Fork::Message     message(request);
    cmsghdr          *header = CMSG_FIRSTHDR(&message.header);
    header->cmsg_level       = SOL_SOCKET;
    header->cmsg_type        = SCM_RIGHTS;
    header->cmsg_len         = CMSG_LEN(sizeof(files));
    std::memcpy(CMSG_DATA(header), files.data(), sizeof(files));
    return sendmsg(server, &message.header, MSG_NOSIGNAL) ==
      ssize_t(sizeof(request)) &&
      Fork::send(server, bytes.data(), bytes.size());
  }



  void
  pass_on(const int signal)
  {
    const int error = errno;
    Fork::send(server, &signal, sizeof(signal));
    errno = error;
  }



  // The status of the copy, or that there is none.
  int
  status_of(const int directory, char **arguments)
  {
    if (!connect_to(arguments[0]) || !ask(directory, arguments))
      return Fork::NOT_STARTED;
    for (const int signal :
         {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2})
      if (!Fork::is_ignored(signal))
        std::signal(signal, pass_on);
    int status;
    if (Fork::receive(server, &status, sizeof(status)))
      return status;
    std::fprintf(stderr, "The fork server of %s has ended.\n", arguments[0]);
    _exit(126);
  }
} // namespace



int
main(int argc, char **argv)
{
  if (argc < 2)
    {
      std::fprintf(stderr, "Usage: fork-client PROGRAM ARGUMENTS...\n");
      return 2;
    }
  const std::string program   = argv[1];
  const int         here      = open(".", O_RDONLY | O_DIRECTORY);
  const int         directory = fcntl(here, F_DUPFD_CLOEXEC, 3);
  close(here);
  int status = Fork::NOT_STARTED;
  if (directory >= 0 &&
      chdir(program.substr(0, program.rfind('/') + 1).c_str()) == 0)
    {
      status = status_of(directory, argv + 1);
      if (fchdir(directory) != 0)
        return 126;
    }
  if (status == Fork::NOT_STARTED)
    {
      execv(argv[1], argv + 1);
      std::perror(argv[1]);
      return 127;
    }
  if (!WIFSIGNALED(status))
    return WEXITSTATUS(status);

  const int    signal = WTERMSIG(status);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  std::signal(signal, SIG_DFL);
  sigset_t this_one;
  sigemptyset(&this_one);
  sigaddset(&this_one, signal);
  sigprocmask(SIG_UNBLOCK, &this_one, nullptr);
  kill(getpid(), signal);
  return 128 + signal;
}

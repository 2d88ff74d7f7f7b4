// To be loaded before a program (LD_PRELOAD) that is run many times: it takes
// several times as long to load deal.II's two hundred libraries, and to find
// symbols in them, as to run a scene on a small mesh. So the program is loaded
// once, and stops before its main(). Whenever fork_client.cc asks for it, it
// makes a copy of itself, which has everything that a program has that begins,
// and calls main(). fork_server.sh starts it.
//
// The copy has what the client has: arguments, environment, standard input,
// output and error, directory, limits, ignored signals, processors and
// priority. What libraries have read in the environment when they were loaded,
// like the number of threads, is the server's. Signals are passed on, and if
// the client is killed, so is the copy. In the environment of the server
// FORK_SERVER_PARENT is the number of a process: when that has ended, the
// server starts nothing any more, and ends.

#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>

#include <cstdlib>
#include <map>
#include <vector>

#include <dlfcn.h>
#include <poll.h>
#include <tests/support/fork_request.h>

extern char **environ;

namespace
{
  using Main = int (*)(int, char **, char **);

  Main program;



  class Server
  {
  public:
    Server(const char *name, const pid_t parent)
      : parent(parent)
      , listening(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0))
    {
      const sockaddr_un address = Fork::address_of(name);
      sigemptyset(&child_ends);
      sigaddset(&child_ends, SIGCHLD);
      sigprocmask(SIG_BLOCK, &child_ends, nullptr);
      ended = signalfd(-1, &child_ends, SFD_CLOEXEC | SFD_NONBLOCK);
      works = bind(listening,
                   reinterpret_cast<const sockaddr *>(&address),
                   sizeof(address)) == 0 &&
        listen(listening, 100) == 0 && ended >= 0;
    }

    int
    serve()
    {
      while (works && (is_wanted() || !clients.empty()))
        {
          std::vector<pollfd> events{{listening, POLLIN, 0},
                                     {ended, POLLIN, 0}};
          for (const auto &copy : clients)
            events.push_back({copy.second, POLLIN, 0});
          if (poll(events.data(), events.size(), 1000) < 0 && errno != EINTR)
            return 1;
          auto event = events.begin() + 2;
          for (const auto &copy : clients)
            if ((event++)->revents != 0)
              pass_on(copy.first, copy.second);
          answer();
          if (events[0].revents & POLLIN)
            accept();
        }
      return works ? 0 : 1;
    }

  private:
    pid_t                parent;
    int                  listening, ended;
    bool                 works;
    sigset_t             child_ends;
    std::map<pid_t, int> clients;

    bool
    is_wanted() const
    {
      return kill(parent, 0) == 0;
    }

    // A signal, or, of a client that has been killed, what has killed it.
    static void
    pass_on(const pid_t copy, const int client)
    {
      int signal;
      kill(copy,
           Fork::receive(client, &signal, sizeof(signal)) ? signal : SIGKILL);
    }

    // To clients whose copies have ended.
    void
    answer()
    {
      signalfd_siginfo ignored;
      while (read(ended, &ignored, sizeof(ignored)) > 0)
        ;
      int   status;
      pid_t copy;
      while ((copy = waitpid(-1, &status, WNOHANG)) > 0)
        {
          Fork::send(clients[copy], &status, sizeof(status));
          close(clients[copy]);
          clients.erase(copy);
        }
    }

    void
    accept()
    {
      const int client = accept4(listening, nullptr, nullptr, SOCK_CLOEXEC);
      if (client < 0)
        return;
      // One that has been stopped has not all others wait.
      const timeval patience{10, 0};
      setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
      Fork::Request request;
      Fork::Files   files{{-1, -1, -1, -1}};
      std::string   bytes;
      pid_t         copy = -1;
      if (receive(client, request, files, bytes) && is_wanted())
        {
          copy = fork();
          if (copy == 0)
            run(client, request, files, bytes);
        }
      for (const int file : files)
        if (file >= 0)
          close(file);
      if (copy > 0)
        clients[copy] = client;
      else
        {
          Fork::send(client, &Fork::NOT_STARTED, sizeof(int));
          close(client);
        }
    }

    static bool
    receive(const int      client,
            Fork::Request &request,
            Fork::Files   &files,
            std::string   &bytes)
    {
      Fork::Message  message(request);
      const ssize_t  n      = recvmsg(client, &message.header, MSG_WAITALL);
      const cmsghdr *header = n > 0 ? CMSG_FIRSTHDR(&message.header) : nullptr;
      if (header == nullptr || header->cmsg_len != CMSG_LEN(sizeof(files)))
        return false;
      std::memcpy(files.data(), CMSG_DATA(header), sizeof(files));
      if (n != ssize_t(sizeof(request)))
        return false;
      bytes.resize(request.n_bytes);
      return Fork::receive(client, &bytes[0], bytes.size());
    }

    // In the copy.
    [[noreturn]] void
    run(const int            client,
        const Fork::Request &request,
        const Fork::Files   &files,
        std::string         &bytes) const
    {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      sigprocmask(SIG_UNBLOCK, &child_ends, nullptr);
      if (fchdir(files[3]) != 0)
        _exit(126);
      for (int i = 0; i < 3; ++i)
        dup2(files[i], i);
      for (const int file : files)
        close(file);
      for (const int file : {client, listening, ended})
        close(file);
      for (const auto &other : clients)
        close(other.second);
      umask(request.umask);
      setpriority(PRIO_PROCESS, 0, request.nice);
      sched_setaffinity(0, sizeof(request.processors), &request.processors);
      for (int i = 0; i < int(RLIM_NLIMITS); ++i)
        setrlimit(decltype(RLIMIT_CPU)(i), &request.limits[i]);
      for (int i = 1; i < NSIG; ++i)
        if (Fork::is_ignored(i) != request.is_ignored[i])
          std::signal(i, request.is_ignored[i] ? SIG_IGN : SIG_DFL);

      std::vector<char *> arguments, variables;
      for (std::size_t at = 0; at < bytes.size();
           at += std::strlen(&bytes[at]) + 1)
        (arguments.size() < request.n_arguments ? arguments : variables)
          .push_back(&bytes[at]);
      arguments.push_back(nullptr);
      variables.push_back(nullptr);
      environ = variables.data();
      std::exit(program(int(request.n_arguments), arguments.data(), environ));
    }
  };



  int
  serve(int, char **arguments, char **)
  {
    // What has started it may be interrupted, or wait for files. Not a session
    // of its own: in that priorities would only count among its copies.
    setpgid(0, 0);
    for (int file = 3; file < 1024; ++file)
      close(file);
    const char *parent = std::getenv("FORK_SERVER_PARENT");
    return parent ? Server(arguments[0], std::atoi(parent)).serve() : 1;
  }
} // namespace



// What calls main(), in the library of C, is given another.
extern "C" int
__libc_start_main(Main   main,
                  int    argc,
                  char **argv,
                  void (*init)(),
                  void (*fini)(),
                  void (*rtld_fini)(),
                  void *stack_end)
{
  program          = main;
  const auto start = reinterpret_cast<decltype(&__libc_start_main)>(
    dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(&serve, argc, argv, init, fini, rtld_fini, stack_end);
}

#ifndef tests_support_fork_request_h
#define tests_support_fork_request_h

// What fork_client.cc asks of fork_server.cc, over a socket beside the program:
// first a Request together with the files in Files, then its bytes, which are
// the arguments of the program with its name, and then its environment, each
// with a zero at its end. While it waits it may send numbers of signals for the
// copy. The answer is the status of the copy, as from waitpid(), or
// NOT_STARTED.

#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <string>

#include <sched.h>
#include <unistd.h>

namespace Fork
{
  struct Request
  {
    std::size_t n_arguments, n_bytes;
    int         nice;
    mode_t      umask;
    cpu_set_t   processors;
    rlimit      limits[RLIM_NLIMITS];
    bool        is_ignored[NSIG]; // by number of the signal
  };



  // Standard input, output and error, and the directory to be in.
  using Files = std::array<int, 4>;

  constexpr int NOT_STARTED = -1;



  // What sendmsg() and recvmsg() take: a Request, and room for Files.
  struct Message
  {
    explicit Message(Request &request)
      : data{&request, sizeof(request)}
    {
      header.msg_iov        = &data;
      header.msg_iovlen     = 1;
      header.msg_control    = control;
      header.msg_controllen = sizeof(control);
    }

    Message(const Message &) = delete;

    msghdr header{};
    iovec  data;
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(Files))] = {};
  };



  // The socket of a program that is in the directory where one is: the names of
  // sockets must not have more than a hundred characters.
  inline sockaddr_un
  address_of(const std::string &program)
  {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string name =
      program.substr(program.rfind('/') + 1, sizeof(address.sun_path) - 8) +
      ".socket";
    std::memcpy(address.sun_path, name.c_str(), name.size());
    return address;
  }



  inline bool
  is_ignored(const int signal)
  {
    struct sigaction action;
    return sigaction(signal, nullptr, &action) == 0 &&
      action.sa_handler == SIG_IGN;
  }



  // All of the bytes, or nothing that can be relied on.
  inline bool
  receive(const int socket, void *bytes, const std::size_t n)
  {
    std::size_t done = 0;
    while (done < n)
      {
        const ssize_t more =
          recv(socket, static_cast<char *>(bytes) + done, n - done, 0);
        if (more == 0 || (more < 0 && errno != EINTR))
          return false;
        done += more > 0 ? more : 0;
      }
    return true;
  }



  inline bool
  send(const int socket, const void *bytes, const std::size_t n)
  {
    std::size_t done = 0;
    while (done < n)
      {
        const ssize_t more = ::send(socket,
                                    static_cast<const char *>(bytes) + done,
                                    n - done,
                                    MSG_NOSIGNAL);
        if (more < 0 && errno != EINTR)
          return false;
        done += more > 0 ? more : 0;
      }
    return true;
  }
} // namespace Fork

#endif

// To be loaded before a program (LD_PRELOAD) that is run hundreds of times: it
// takes several times as long to load deal.II's two hundred libraries, and to
// find symbols in them, as to see that an entry of a scene is wrong. So the
// program is loaded once, and stops before its main(). For each request that it
// then reads, it makes a copy of itself, which has everything that a program
// has that begins, and calls main().
//
// A request, on standard input, is a number of strings, and these, with a zero
// at the end of each: the directory to be in, files for standard output and
// standard error, and the arguments of the program with its name. The answer, a
// line on standard output, is the status of the copy, or minus the signal that
// has ended it. started_program.py asks.

#include <sys/wait.h>

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace
{
  using Main = int (*)(int, char **, char **);

  Main program;



  bool
  read_string(std::string &text)
  {
    text.clear();
    int c;
    while ((c = std::getc(stdin)) != EOF)
      if (c == 0)
        return true;
      else
        text += char(c);
    return false;
  }



  void
  open_as(const int descriptor, const char *file, const int mode)
  {
    const int opened = open(file, mode, 0666);
    if (opened < 0 || dup2(opened, descriptor) < 0)
      _exit(126);
    close(opened);
  }



  [[noreturn]] void
  run(std::vector<std::string> &words, char **environment)
  {
    constexpr int create = O_WRONLY | O_CREAT | O_TRUNC;
    if (chdir(words[0].c_str()) != 0)
      _exit(126);
    open_as(STDIN_FILENO, "/dev/null", O_RDONLY);
    open_as(STDOUT_FILENO, words[1].c_str(), create);
    open_as(STDERR_FILENO, words[2].c_str(), create);
    std::vector<char *> arguments;
    for (std::size_t i = 3; i < words.size(); ++i)
      arguments.push_back(&words[i][0]);
    arguments.push_back(nullptr);
    std::exit(program(int(words.size()) - 3, arguments.data(), environment));
  }



  int
  serve(int, char **, char **environment)
  {
    unsetenv("LD_PRELOAD"); // not for what the program starts
    std::string text;
    while (read_string(text))
      {
        std::vector<std::string> words(std::stoul(text));
        for (std::string &word : words)
          if (!read_string(word))
            return 1;
        const pid_t child = fork();
        if (child < 0)
          return 1;
        if (child == 0)
          run(words, environment);
        int status = 0;
        if (waitpid(child, &status, 0) != child)
          return 1;
        std::printf(
          "%d\n", WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status));
        std::fflush(stdout);
      }
    return 0;
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

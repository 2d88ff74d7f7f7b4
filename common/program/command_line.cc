#include <common/parallel/collective_error.h>
#include <common/parallel/run_clock.h>
#include <common/parameters/scene_file.h>
#include <common/printable.h>
#include <common/program/check_scene.h>
#include <common/program/command_line.h>
#include <common/program/version.h>

#include <deal.II/base/config.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <new>
#include <sstream>
#include <vector>

namespace Friction
{
  namespace
  {
    std::string
    usage(const Program &program)
    {
      const std::string &name = program.name;
      return "Usage: " + name +
        " SCENE.prm [--restart] [Section/Entry=value ...]\n"
        "       " +
        name +
        " SCENE.prm --check [Section/Entry=value ...]\n"
        "       " +
        name +
        " --parameters   print all entries with defaults\n"
        "       " +
        name +
        " --version      print the version\n"
        "       " +
        name +
        " --help         print this\n"
        "\n"
        "Solves a contact problem with friction in " +
        program.dimensions +
        " dimensions by monotone\n"
        "multigrid. SCENE.prm describes body, obstacle, loads and solver; "
        "entries\n"
        "given on the command line take precedence over the file, for example\n"
        "\n"
        "  " +
        name + " " + program.example +
        "\n"
        "\n"
        "On several processors: mpirun -np N " +
        name +
        " SCENE.prm ...\n"
        "\n"
        "The results go to the directory given by Output/Directory: history.h5 "
        "and\n"
        "fields for ParaView. With Output/Checkpoint=true each level and each "
        "load step\n"
        "leave a checkpoint there, from which --restart continues a run that "
        "was interrupted, or "
        "is to get\n"
        "more levels. --check makes the first mesh and says what is strange "
        "about "
        "the\n"
        "scene, without solving or writing anything. Exit status: 0 solved, 1 "
        "no "
        "solution\n"
        "(not converged, or forces that do not balance), 2 bad input, or "
        "output "
        "that cannot\n"
        "be written, 3 an error of the program.\n";
    }



    // What deal.II says has many lines, and may quote what the user gave us.
    std::string
    printable_lines(const std::string &text)
    {
      std::istringstream in(text);
      std::string        result, line;
      while (std::getline(in, line))
        result += (result.empty() ? "" : "\n") + printable(line);
      return result;
    }



    // Those that stand alone have been answered already.
    void
    check_options(const std::vector<std::string> &arguments)
    {
      for (const std::string &argument : arguments)
        for (const std::string option : {"--help", "--version", "--parameters"})
          if (argument == option)
            throw InputError("'" + option + "' has to be the first argument.");
      for (const std::string &argument : arguments)
        if (argument.rfind("-", 0) == 0 && argument != "--restart" &&
            argument != "--check")
          throw InputError("'" + excerpt(argument) +
                           "' is no option; there are '--check', '--restart', "
                           "'--parameters', '--version' and '--help'.");
    }
  } // namespace



  int
  run_program(int            argc,
              char         **argv,
              const Program &program,
              const std::function<bool(const Parameters &, const Start)> &run)
  {
    using namespace dealii;

    // Everything happens while MPI is running, messages included: they are out
    // before the first process ends with a status other than 0, upon which
    // mpirun may end the others.
    const auto start_of_program = std::chrono::steady_clock::now();
    // deal.II starts other libraries along with MPI, which would look for
    // options of theirs among ours: PETSc 3.22 tells on standard output which
    // ones it does not know. They get the name of the program.
    int                              n_names = 1;
    char                            *names[] = {argv[0], nullptr};
    char                           **name    = names;
    Utilities::MPI::MPI_InitFinalize mpi(n_names, name, 1);
    RunClock                         clock(start_of_program);
    clock.attach(MPI_COMM_WORLD);
    const bool speaks = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;

    // An unexpected exception may be that of a single process. We do not know
    // what the others are waiting for; only MPI can end them.
    const auto unexpected = [&](const std::string &what) {
      print_error(program.name +
                  ": unexpected error: " + printable_lines(what));
      if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
        MPI_Abort(MPI_COMM_WORLD, 3);
      return 3;
    };

    // What is printed is a part of the results.
    const auto finish = [&](const int status) {
      if (!speaks || std::cout.flush())
        return status;
      print_error(program.name +
                  ": standard output cannot be written; is its disk full?");
      return 2;
    };

    try
      {
        std::vector<std::string> arguments(argv + 1, argv + argc);
        if (arguments.empty() || arguments[0] == "--help" ||
            arguments[0] == "-h")
          {
            if (speaks)
              (arguments.empty() ? std::cerr : std::cout)
                << usage(program) << std::flush;
            return finish(arguments.empty() ? 2 : 0);
          }
        if (arguments[0] == "--version")
          {
            if (speaks)
              std::cout << program.name << ' ' << version() << " (deal.II "
                        << DEAL_II_PACKAGE_VERSION << ", "
#ifdef DEBUG
                        << "debug mode"
#else
                        << "release mode"
#endif
                        << ')' << std::endl;
            return finish(0);
          }
        if (arguments[0] == "--parameters")
          {
            if (speaks)
              print_default_parameters(std::cout);
            return finish(0);
          }

        on_all_processes(MPI_COMM_WORLD, [&]() { check_options(arguments); });

        // This one may stand anywhere, for it is easily appended to the command
        // line of the run that was interrupted.
        const auto restart =
          std::remove(arguments.begin(), arguments.end(), "--restart");
        const Start start =
          restart == arguments.end() ? Start::anew : Start::from_checkpoint;
        arguments.erase(restart, arguments.end());
        const auto check =
          std::remove(arguments.begin(), arguments.end(), "--check");
        const bool only_check = check != arguments.end();
        arguments.erase(check, arguments.end());
        if (arguments.empty() && only_check)
          throw InputError("--check needs a scene file.");
        if (arguments.empty())
          throw InputError("--restart needs the scene file of the run that is "
                           "to be continued.");

        // The scene is read and checked before anything is created.
        const Parameters parameters = on_all_processes(MPI_COMM_WORLD, [&]() {
          return read_parameters(arguments[0],
                                 {arguments.begin() + 1, arguments.end()});
        });
        if (only_check)
          {
            if (program.dimensions == "two")
              check_scene<2>(parameters, std::cout, MPI_COMM_WORLD);
            else
              check_scene<3>(parameters, std::cout, MPI_COMM_WORLD);
            return finish(0);
          }
        const bool solved = run(parameters, start);
        if (speaks && parameters.output.times)
          {
            if (parameters.output.verbosity != Verbosity::quiet)
              std::cout << clock.summary() << std::endl;
            if (parameters.output.profile)
              std::cout << clock.describe() << std::endl;
          }
        return finish(solved ? 0 : 1);
      }
    catch (const InputError &error)
      {
        if (speaks)
          print_error(program.name + ": " + printable(error.what()));
        return 2;
      }
    catch (const std::bad_alloc &)
      {
        return unexpected("there is not enough memory; a coarser mesh, or "
                          "several machines, would need less on each");
      }
    catch (const std::exception &error)
      {
        return unexpected(error.what());
      }
    catch (...)
      {
        return unexpected("of a kind that says nothing about itself");
      }
  }
} // namespace Friction

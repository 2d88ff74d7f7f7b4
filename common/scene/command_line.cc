#include <common/scene/command_line.h>

#include <deal.II/base/mpi.h>

#include <exception>
#include <iostream>
#include <vector>

namespace Friction
{
  namespace
  {
    std::string
    usage(const std::string &program,
          const std::string &dimensions,
          const std::string &example)
    {
      return "Usage: " + program +
        " SCENE.prm [Section/Entry=value ...]\n"
        "       " +
        program +
        " --parameters   print all entries with defaults\n"
        "       " +
        program +
        " --help         print this\n"
        "\n"
        "Solves a contact problem with friction in " +
        dimensions +
        " dimensions by monotone\n"
        "multigrid. SCENE.prm describes body, obstacle, loads and solver; "
        "entries\n"
        "given on the command line take precedence over the file, for example\n"
        "\n"
        "  " +
        program + " " + example +
        "\n"
        "\n"
        "The results go to the directory given by Output/Directory: history.h5 "
        "and\n"
        "fields for ParaView. Exit status: 0 solved, 1 not converged, 2 bad "
        "input.\n";
    }
  } // namespace



  int
  run_program(int                                            argc,
              char                                         **argv,
              const std::string                             &program,
              const std::string                             &dimensions,
              const std::string                             &example,
              const std::function<bool(const Parameters &)> &run)
  {
    using namespace dealii;
    try
      {
        Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
        const std::vector<std::string>   arguments(argv + 1, argv + argc);
        if (arguments.empty() || arguments[0] == "--help" ||
            arguments[0] == "-h")
          {
            (arguments.empty() ? std::cerr : std::cout)
              << usage(program, dimensions, example);
            return arguments.empty() ? 2 : 0;
          }
        if (arguments[0] == "--parameters")
          {
            print_default_parameters(std::cout);
            return 0;
          }
        // The scene is read and checked before anything is created.
        return run(read_parameters(arguments[0],
                                   {arguments.begin() + 1, arguments.end()}))
          ? 0
          : 1;
      }
    catch (const InputError &error)
      {
        std::cerr << program << ": " << error.what() << std::endl;
        return 2;
      }
    catch (const std::exception &error)
      {
        std::cerr << program << ": unexpected error: " << error.what()
                  << std::endl;
        return 3;
      }
  }
} // namespace Friction

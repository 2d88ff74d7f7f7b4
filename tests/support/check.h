#ifndef friction_tests_support_check_h
#define friction_tests_support_check_h

#include <deal.II/base/mpi.h>

#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>

namespace Tests
{
  /**
   * The checks of this program that have failed. A program with a failed check
   * ends with exit status 1, whatever its main() returns, so that this
   * does not depend on a comparison of its output.
   */
  class FailedChecks
  {
  public:
    static void
    add()
    {
      static const FailedChecks failed;
    }

  private:
    FailedChecks() = default;

    // Runs when the program ends, after MPI has been shut down; the status
    // that main() has returned is replaced.
    ~FailedChecks()
    {
      std::cout.flush();
      std::cerr.flush();
      std::_Exit(EXIT_FAILURE);
    }
  };



  /** Prints the outcome of a check: only that, so that no digits are compared.
   */
  inline void
  check(const bool         condition,
        const std::string &what,
        std::ostream      &out = std::cout)
  {
    out << (condition ? "ok      " : "FAILED  ") << what << std::endl;
    if (!condition)
      FailedChecks::add();
  }



  /** The same on several processes, all of which have to agree: the first one
   * prints. */
  inline void
  check_everywhere(const bool         condition,
                   const std::string &what,
                   std::ostream      &out = std::cout)
  {
    const bool all =
      dealii::Utilities::MPI::min(condition ? 1 : 0, MPI_COMM_WORLD) == 1;
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      check(all, what, out);
    else if (!all)
      FailedChecks::add();
  }



  /** Prints the outcome of a check that a value is not larger than a bound;
   * the value itself only if it is. */
  inline void
  check_below(const double value, const double bound, const std::string &what)
  {
    std::ostringstream how_much;
    if (!(value <= bound))
      how_much << ": " << value << " instead of " << bound;
    check(value <= bound, what + how_much.str());
  }
} // namespace Tests

#endif

#ifndef friction_tests_support_check_below_h
#define friction_tests_support_check_below_h

#include <iostream>
#include <string>

namespace Tests
{
  /** Prints the outcome of a check that a value is not larger than a bound;
   * the value itself only if it is. */
  inline void
  check_below(const double value, const double bound, const std::string &what)
  {
    if (value <= bound)
      std::cout << "ok      " << what << std::endl;
    else
      std::cout << "FAILED  " << what << ": " << value << " instead of "
                << bound << std::endl;
  }
} // namespace Tests

#endif

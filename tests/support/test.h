#ifndef friction_tests_support_test_h
#define friction_tests_support_test_h

#include <string>
#include <vector>

// The tests of a folder are one program, since linking deal.II takes longer
// than compiling most of them, and the files of several tests are compiled as
// one. So a test has no main(), but, in block.cc, whose output is block.output,
//
//   namespace test_block
//   {
//     ... what it needs
//   }
//
//   TEST(block)
//   {
//     ... what it does; names of test_block are known here
//   }
//
// MPI has been started before, with one thread per process. Nothing catches
// exceptions: one on any process ends all of them. ctest says by the variable
// FRICTION_TEST which test the program is to be; by hand it is the first
// argument. A test that replaces functions of the system is a program of its
// own, see pickup_tests().
#define TEST(name)                                              \
  namespace test_##name                                         \
  {                                                             \
    static void                      run_test();                \
    static const Tests::Registration is_test(#name, &run_test); \
  }                                                             \
  static void test_##name::run_test()

namespace Tests
{
  /** That there is a test. */
  struct Registration
  {
    Registration(const char *name, void (*run)());
  };

  /** What has been added to the name of the test on the command line, for those
   * that can do more than ctest lets them. */
  const std::vector<std::string> &arguments();
} // namespace Tests

#endif

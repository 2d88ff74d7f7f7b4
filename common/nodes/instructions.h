#ifndef friction_nodes_instructions_h
#define friction_nodes_instructions_h

#include <vector>

// What compiles a function for processors with AVX2.
#if defined(__x86_64__) && defined(__GNUC__)
#  define FRICTION_AVX2 __attribute__((target("avx2,fma")))
#endif

// Whether a file can be compiled so from some line on, which only GCC does.
#if defined(FRICTION_AVX2) && !defined(__clang__) && \
  !defined(__INTEL_COMPILER) && !defined(__NVCOMPILER)
#  define FRICTION_AVX2_FILES
#endif

namespace Friction
{
  /**
   * Sets of instructions that innermost loops are compiled for: RowKernels and
   * DenseKernels. Which of them a processor has is found out when the program
   * starts, so that a program that is made for all processors of a kind is as
   * fast as one made for this one. Results differ in rounding.
   */
  enum class Instructions
  {
    common, ///< what every processor of this kind has
    avx2    ///< x86-64: four numbers at a time, product and sum in one
  };

  /** What this processor has, in ascending order of speed. */
  std::vector<Instructions> available_instructions();

  /** One of available_instructions(), the last one to begin with. For tests and
   * measurements to change. */
  extern Instructions instructions_in_use;
} // namespace Friction

#endif

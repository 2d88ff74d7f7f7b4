// Nothing is built twice. A safeguard is the same iteration with one part
// exchanged, and shares levels and matrices with the first attempt: all that it
// asks for in large pieces of memory is little beside what a solver asks for
// when it is made. Vectors are not counted, which are allocated in another way;
// matrices, patterns, and what is known of nodes are, from half of the size of
// the matrix of the second finest level on. The strip along sliding nodes,
// which Newton's method makes anew in each of its steps, is smaller.

#include <common/algorithms/nested_iteration.h>

#include <cstdlib>
#include <iostream>
#include <new>
#include <string>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

namespace
{
  constexpr std::size_t large     = 150000;
  std::size_t           allocated = 0;
} // namespace

void *
operator new(const std::size_t size)
{
  if (size >= large)
    allocated += size;
  if (void *memory = std::malloc(size > 0 ? size : 1))
    return memory;
  throw std::bad_alloc();
}

// What the standard library's version of this would call, but not one that a
// sanitizer puts in its place.
void *
operator new(const std::size_t size, const std::nothrow_t &) noexcept
{
  if (size >= large)
    allocated += size;
  return std::malloc(size > 0 ? size : 1);
}

void *
operator new(const std::size_t size, const std::align_val_t alignment)
{
  if (size >= large)
    allocated += size;
  const std::size_t a = static_cast<std::size_t>(alignment);
  if (void *memory = std::aligned_alloc(a, (size + a - 1) / a * a))
    return memory;
  throw std::bad_alloc();
}

void
operator delete(void *memory, const std::align_val_t) noexcept
{
  std::free(memory);
}

void
operator delete(void *memory, std::size_t, const std::align_val_t) noexcept
{
  std::free(memory);
}

void
operator delete(void *memory) noexcept
{
  std::free(memory);
}

void
operator delete(void *memory, std::size_t) noexcept
{
  std::free(memory);
}

using namespace Tests;

namespace test_shared_parts
{
  // Much friction, for which Algorithm 3 goes to and fro.
  void
  test(const std::string &name, const std::vector<std::string> &entries)
  {
    std::cout << name << std::endl;
    std::vector<std::string> overrides = {"Contact/Friction coefficient=10",
                                          "Refinement/Initial refinements=6",
                                          "Refinement/Levels=0"};
    overrides.insert(overrides.end(), entries.begin(), entries.end());
    NestedIteration<2> nest(
      read_parameters(SCENES_DIR "/raous.prm", overrides));
    nest.begin();
    VectorType   u;
    ContactState state = nest.make_guess(u);

    std::size_t      before = allocated;
    ContactSolver<2> solver(nest.discretization(), nest.parameters().solver);
    solver.prepare(u, state);
    const double construction = allocated - before;
    check(construction > 1e5, "a solver takes 100 kB or more");

    before                    = allocated;
    const SolverReport report = solver.solve(u, state);
    check(report.converged, "the problem is solved");
    for (const SolverAttempt &attempt : report.attempts)
      std::cout << attempt.name << std::endl;
    check_below((allocated - before) / construction,
                .1,
                "what attempts allocate is little beside the construction");
  }
} // namespace test_shared_parts



TEST(shared_parts)
{
  test("The parts of the default", {"Solver/Condensation=never"});
  test("Others, which the safeguards exchange",
       {"Solver/Truncation=contact", "Solver/Coarse correction=monotone"});
}

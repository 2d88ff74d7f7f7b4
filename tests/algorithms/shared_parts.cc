// Nothing is built twice. A safeguard is the same iteration with one part
// exchanged, and shares levels and matrices with the first attempt: all that it
// asks for in large pieces of memory is little beside what a solver asks for
// when it is made. Vectors are not counted, which are allocated in another way;
// matrices, patterns, and what is known of nodes are.

#include <common/algorithms/contact_solver.h>

#include <cstdlib>
#include <iostream>
#include <new>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/random_problem.h>

namespace
{
  constexpr std::size_t large     = 2048;
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

namespace
{
  void
  test(const std::string &name, const SolverSettings &settings)
  {
    std::cout << name << std::endl;
    Parameters p = block_parameters<2>(FrictionLaw::Coulomb, .4);
    p.refinement.initial_refinements = 6;
    const Scene<2> scene(p);
    const auto     mesh = make_triangulation<2>();
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(p.refinement.initial_refinements);
    const Discretized<2> d(scene, *mesh);

    std::size_t      before = allocated;
    ContactSolver<2> solver(d, settings);
    const double     construction = allocated - before;
    check(construction > 1e6, "a solver takes a megabyte or more");

    // The algebraic correction is made at most once, when it is needed first.
    for (const bool first : {true, false})
      {
        VectorType   u = admissible_start(d);
        ContactState state(d.contact().size(), true);
        before                            = allocated;
        const SolverReport report         = solver.solve(u, state);
        std::size_t        without_levels = 0;
        for (const SolverAttempt &attempt : report.attempts)
          without_levels += attempt.name.find("algebraic") != std::string::npos;
        check(report.attempts.size() >= 3, "three attempts or more");
        if (!first || without_levels == 0)
          check_below((allocated - before) / construction,
                      .1,
                      "what they allocate, beside the construction");
      }
  }
} // namespace



int
main(int argc, char *argv[])
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  // Two cycles are too few for all attempts.
  SolverSettings settings;
  settings.maximum_cycles           = 2;
  settings.maximum_outer_iterations = 2;
  test("The parts of the default", settings);
  settings.truncation        = TruncationVariant::contact;
  settings.coarse_correction = CoarseCorrection::monotone;
  test("Others, which the safeguards exchange", settings);
}

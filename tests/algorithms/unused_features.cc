// What a scene does not use costs nothing. That is counted and not timed:
// cycles, solutions, messages, bytes and reductions of all levels, what is kept
// in memory, what is allocated while a problem is solved, and what a checkpoint
// has to hold. A plain scene is compared with the same one said in the words of
// everything that it does not use: regions, a second contact boundary, a list
// of times, a coefficient and an obstacle that are formulas. None of the counts
// may differ, and a force that is given, and a second time, must show in them.
//
// With two processes a cycle of the block in space sends no more messages, and
// waits for no more reductions, than when there was none of these: 38.4 and
// 10.9 for 2187 unknowns (doc/benchmark/parallel.txt has today's numbers).

#include <common/algorithms/nested_iteration.h>

#include <cstdlib>
#include <iostream>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace
{
  std::size_t n_allocations = 0;
}

void *
operator new(const std::size_t size)
{
  ++n_allocations;
  if (void *const memory = std::malloc(size > 0 ? size : 1))
    return memory;
  throw std::bad_alloc();
}

// The standard library's version calls the one above; that of a sanitizer does
// not.
void *
operator new(const std::size_t size, const std::nothrow_t &) noexcept
{
  ++n_allocations;
  return std::malloc(size > 0 ? size : 1);
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

namespace test_unused_features
{
  using Entries = std::vector<std::string>;

  struct Counts
  {
    std::size_t cycles = 0, solutions = 0, levels = 0, messages = 0, bytes = 0,
                reductions = 0, allocations = 0, matrix_memory = 0,
                solver_memory = 0, kept_vectors = 0, platen_numbers = 0;

    bool
    operator==(const Counts &other) const
    {
      return text() == other.text();
    }

    std::string
    text() const
    {
      std::ostringstream out;
      out << cycles << " cycles, " << solutions << " solutions, " << levels
          << " levels, " << messages << " messages, " << bytes << " bytes, "
          << reductions << " reductions, " << allocations << " allocations, "
          << matrix_memory << " and " << solver_memory << " in memory, "
          << kept_vectors << " vectors, " << platen_numbers
          << " numbers of platens";
      return out.str();
    }
  };



  template <int dim>
  Counts
  count(const std::string &scene, const Entries &entries)
  {
    Counts               counts;
    NestedIteration<dim> nest(without_safeguards(read_parameters(
      std::string(dim == 2 ? SCENES_DIR : SCENES_3D_DIR) + "/" + scene + ".prm",
      entries)));
    nest.begin();
    do
      {
        const std::size_t   before = n_allocations;
        const SolverReport &report = nest.solve();
        counts.allocations += n_allocations - before;
        AssertThrow(report.converged, ExcInternalError());
        ++counts.levels;
        counts.solutions += report.outer_iterations;
        counts.cycles += report.cycles.size();
        for (const PhaseCost &cost : report.costs)
          {
            counts.messages += cost.messages;
            counts.bytes += cost.bytes;
            counts.reductions += cost.reductions;
          }
        counts.matrix_memory +=
          nest.discretization().stiffness().memory_consumption();
        counts.solver_memory += report.solver_memory;
    } while (nest.advance());
    nest.begin_next_load_step();
    counts.kept_vectors   = nest.checkpoint_vectors().size();
    counts.platen_numbers = nest.platens().checkpoint_numbers().size();
    return counts;
  }



  template <int dim>
  void
  same_words()
  {
    const std::string where = std::to_string(dim) + "D: ";
    const Entries     basic = {"Refinement/Strategy=adaptive",
                           dim == 2 ? "Refinement/Levels=2"
                                        : "Refinement/Levels=1",
                           dim == 2 ? "Refinement/Initial refinements=2"
                                        : "Refinement/Initial refinements=1"};
    const auto        with  = [&](const Entries &more) {
      Entries all = basic;
      all.insert(all.end(), more.begin(), more.end());
      return count<dim>("block", all);
    };
    const bool plane = dim == 2;
    with({}); // What is allocated once and for all.
    const Counts plain = with({});
    check_everywhere(plain == with({}), where + "counts can be repeated");
    check_everywhere(plain.solutions == plain.levels && plain.kept_vectors == 2,
                     where + "one solution on each mesh, from two vectors");
    const auto costs_nothing = [&](const std::string &what,
                                   const Entries     &entries) {
      const Counts other = with(entries);
      check_everywhere(other == plain, where + what);
      if (!(other == plain))
        std::cout << other.text() << std::endl << plain.text() << std::endl;
    };
    costs_nothing("a region without cells",
                  {"Material/Regions=where x < -1: 7, 0.2, mean"});
    costs_nothing("one time", {"Load steps/Times=0"});
    costs_nothing("a coefficient that is a formula",
                  {"Contact/Friction coefficient=if(x > 5, 1, 0.4)"});
    costs_nothing("an obstacle that is a formula",
                  {"Obstacle/Kind=surface",
                   plane ? "Obstacle/Function=y" : "Obstacle/Function=z"});
    costs_nothing(
      "another section of the contact",
      {"Contact/Boundary id=-1",
       "Obstacle/Kind=none",
       plane ? "Contact 2/Boundary id=2" : "Contact 2/Boundary id=4",
       "Contact 2/Friction coefficient=0.4",
       "Obstacle 2/Kind=plane"});

    const Counts pressed =
      with({plane ? "Boundary conditions/Force=3: free, -0.02"
                  : "Boundary conditions/Force=5: free, free, -0.02"});
    check_everywhere(pressed.solutions > plain.solutions &&
                       pressed.platen_numbers > plain.platen_numbers,
                     where + "a force that is given is counted");
    check_everywhere(with({"Load steps/Times=0, 1"}).kept_vectors >
                       plain.kept_vectors,
                     where + "a second time is counted");
  }



  void
  as_before()
  {
    NestedIteration<3> nest(without_safeguards(read_parameters(
      SCENES_3D_DIR "/block.prm",
      {"Refinement/Initial refinements=1", "Refinement/Levels=2"})));
    nest.begin();
    do
      nest.solve();
    while (nest.advance());
    double messages = 0, reductions = 0;
    for (const PhaseCost &cost : nest.report().costs)
      {
        messages += cost.messages;
        reductions += cost.reductions;
      }
    const double cycles = nest.report().cycles.size();
    check_everywhere(messages > 0 && messages / cycles < 38.45,
                     "messages in a cycle");
    check_everywhere(reductions > 0 && reductions / cycles < 10.95,
                     "reductions in a cycle");
  }
} // namespace test_unused_features



TEST(unused_features)
{
  same_words<2>();
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1)
    same_words<3>();
  else
    as_before();
}

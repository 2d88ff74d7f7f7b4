// A scene with several times: a block whose stress is the same everywhere is
// pressed, dragged until it slides, and dragged back, with displacements and
// tractions that are expressions in t. Its solution at each time is an
// expression as well, with a return map written out step by step. In steps that
// keep their loads nothing may change, and a scene with a single time must be
// that scene without times, to the last bit.
//
// What a run writes of it: columns and groups of history.h5 and levels.csv, and
// lists of fields by times.

#include <common/algorithms/nested_iteration.h>
#include <common/output/run_output.h>

#include <deal.II/base/hdf5.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_load_steps
{
  // The threshold of the shear is .028. At t = 0 the block is pressed, at 1 it
  // sticks, at 2 it has slid to .012, at 3 and 3.5 (where nothing changes) it
  // sticks there, at 5 it has slid back to -.002.
  const std::vector<std::string> history = {
    "Load steps/Times=0, 1, 2, 3, 3.5, 5",
    "Scene/Constants=L = 2; H = 1; d = 0.02; gap = 0; threshold = 0.028",
    "Scene/Definitions=p = (lambda + 2*mu)*d/H; side = -lambda*d/H; "
    "U = if(t < 0.5, 0, if(t < 1.5, 0.01, if(t < 2.5, 0.04, if(t < 4, 0.02, "
    "-0.03)))); "
    "slip = if(t < 1.5, 0, if(t < 4, 0.04 - threshold, threshold - 0.03)); "
    "q = mu*(U - slip)/H",
    "Refinement/Initial refinements=0",
    "Refinement/Levels=1",
    "Solver/Inner tolerance=1e-13"};



  std::vector<std::string>
  with(std::vector<std::string> entries, const std::vector<std::string> &more)
  {
    entries.insert(entries.end(), more.begin(), more.end());
    return entries;
  }



  // Quantities that only the first process has are those of a file.
  void
  read_files(const std::string &directory, const unsigned int n_steps)
  {
    std::ifstream csv(directory + "/levels.csv");
    std::string   header;
    std::getline(csv, header);
    check(header.compare(0, 26, "level,load_step,time,cells") == 0,
          "levels.csv has a column of times");
    dealii::HDF5::File file(directory + "/history.h5",
                            dealii::HDF5::File::FileAccessMode::open);
    const auto         times =
      file.open_dataset("steps/time").read<std::vector<double>>();
    const auto levels =
      file.open_dataset("steps/level").read<std::vector<unsigned int>>();
    const auto all_times =
      file.open_dataset("levels/time").read<std::vector<double>>();
    check(times == std::vector<double>({0, 1, 2, 3, 3.5, 5}) &&
            levels == std::vector<unsigned int>({1, 2, 3, 4, 5, 6}) &&
            all_times == std::vector<double>({0, 0, 1, 2, 3, 3.5, 5}),
          "history.h5 has a group of steps, with their last levels");
    for (const std::string name : {"body", "contact"})
      {
        std::ifstream     pvd(directory + "/" + name + ".pvd");
        std::stringstream text;
        text << pvd.rdbuf();
        std::size_t n = 0, place = 0;
        while ((place = text.str().find("timestep=", place) + 1) != 0)
          ++n;
        check(n == n_steps &&
                text.str().find("timestep=\"3.5\"") != std::string::npos &&
                text.str().find(name + "-01.pvtu") != std::string::npos &&
                text.str().find(name + "-00.pvtu") == std::string::npos,
              name + ".pvd lists each step once, with its time");
      }
  }



  void
  solve_history()
  {
    const std::string directory = "load-steps-" +
      std::to_string(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    const Parameters   parameters = without_safeguards(read_parameters(
      SCENES_DIR "/stick-slip.prm",
      with(history,
           {"Output/Directory=" + directory, "Output/Verbosity=quiet"})));
    NestedIteration<2> nest(parameters);
    std::ostringstream console;
    const bool first = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
    {
      RunOutput<2> output(
        parameters, nest.scene(), console, "test", MPI_COMM_WORLD);
      nest.begin();
      output.check_start(nest.discretization());
      double       worst_error = 0, worst_certificate = 0, held_change = 0;
      unsigned int n_converged = 0, n_levels = 0;
      std::string  states;
      VectorType   before;
      const auto   solve = [&]() {
        nest.solve();
        output.add_level(nest, nest.estimate());
        n_converged += nest.report().converged;
        ++n_levels;
        worst_certificate =
          std::max(worst_certificate, nest.report().certificate.largest());
        Vector<double> exact(2);
        const auto     points = node_points(nest.discretization());
        for (unsigned int i = 0;
             i < nest.discretization().constraints().n_owned_nodes();
             ++i)
          {
            nest.scene().exact_displacement()->vector_value(points[i], exact);
            for (unsigned int c = 0; c < 2; ++c)
              worst_error =
                std::max(worst_error,
                         std::abs(nest.displacement().local_element(2 * i + c) -
                                  exact[c]));
          }
      };
      solve();
      while (nest.advance())
        solve();
      do
        {
          if (nest.scene().load_step() > 0)
            {
              output.begin_load_step(nest.discretization());
              solve();
            }
          const unsigned int n_sticking =
            Utilities::MPI::sum(nest.state().n_sticking(), MPI_COMM_WORLD);
          const unsigned int n_contact =
            Utilities::MPI::sum(nest.state().n_contact(), MPI_COMM_WORLD);
          states += n_sticking == n_contact ? "sticks, "
            : n_sticking == 0               ? "slides, "
                                            : "neither, ";
          if (nest.scene().time() == 3.5)
            {
              VectorType change = nest.displacement();
              change -= before;
              held_change = change.linfty_norm();
            }
          before = nest.displacement();
      } while (nest.begin_next_load_step());
      check_everywhere(n_converged == n_levels && worst_certificate < 1e-9,
                       "all levels and steps are certified");
      check_everywhere(states ==
                         "sticks, sticks, slides, sticks, sticks, slides, ",
                       "the block sticks and slides as it should: " + states);
      check_everywhere(worst_error < 1e-12,
                       "displacements are those of the closed form");
      check_everywhere(held_change < 1e-13,
                       "where loads are held nothing changes");
      if (worst_error >= 1e-12 || held_change >= 1e-13)
        std::cout << "  " << worst_error << ' ' << held_change << std::endl;
    }
    if (first)
      {
        read_files(directory, 6);
        std::filesystem::remove_all(directory);
      }
  }



  // A block that is pressed and dragged, and then taken to where it was:
  // nothing touches, and what is left is rounding, of which no digits can be
  // asked for.
  void
  unload()
  {
    NestedIteration<2> nest(without_safeguards(read_parameters(
      SCENES_DIR "/block.prm",
      {"Load steps/Times=0, 1, 2, 3",
       "Boundary conditions/Displacement=3: if(t < 0.5, 0.02, 0), if(t < 1.5, "
       "-0.02, 0)",
       "Refinement/Initial refinements=4",
       "Refinement/Levels=0"})));
    nest.begin();
    unsigned int n_solved = nest.solve().converged;
    while (nest.begin_next_load_step())
      n_solved += nest.solve().converged;
    check_everywhere(
      n_solved == 4 && nest.displacement().linfty_norm() < 1e-12,
      "a block without loads in the end: no displacement is left");
  }



  // Times are nothing but the values of expressions.
  void
  solve_one_time()
  {
    const auto run = [](const std::vector<std::string> &entries) {
      auto nest = std::make_unique<NestedIteration<2>>(read_parameters(
        SCENES_DIR "/block.prm", with({"Refinement/Levels=1"}, entries)));
      nest->begin();
      do
        nest->solve();
      while (nest->advance());
      return nest;
    };
    const auto without = run({});
    const auto with_time =
      run({"Load steps/Times=2",
           "Boundary conditions/Displacement=3: 0.01*t, -0.02"});
    VectorType difference = with_time->displacement();
    difference -= without->displacement();
    check_everywhere(difference.linfty_norm() == 0 &&
                       with_time->report().cycles.size() ==
                         without->report().cycles.size() &&
                       !with_time->begin_next_load_step(),
                     "a single time: the scene at this time, to the last bit");
  }
} // namespace test_load_steps

TEST(load_steps)
{
  solve_history();
  unload();
  solve_one_time();
}

// The solvers that the benchmarks compare the product with solve the same
// problem: on small meshes in two and three dimensions their solutions are
// certified and are those of the product, displacements and numbers of nodes in
// contact and sticking. The linear solvers agree with each other.

#include <common/algorithms/nested_iteration.h>

#include <tests/benchmarks/baselines/contest.h>

#include <iostream>
#include <sstream>

#include <tests/support/check.h>
#include <tests/support/test.h>

using namespace Benchmark;

namespace test_baselines
{
  template <int dim>
  void
  compare(const std::string       &file,
          std::vector<std::string> overrides,
          const bool               both_phases)
  {
    // Gauss-Seidel is far from the solution when its increments are small.
    overrides.push_back("Solver/Inner tolerance=1e-12");
    NestedIteration<dim> nest(read_parameters(file, overrides));
    nest.begin();
    do
      nest.solve();
    while (nest.advance());
    std::cout << nest.parameters().name << ", dimension " << dim
              << ", F = " << nest.parameters().contact.friction_coefficient
              << std::endl;
    if (both_phases)
      check(nest.state().n_sticking() > 0 &&
              nest.state().n_sticking() < nest.state().n_contact(),
            "nodes stick and slide");

    Contest<dim> contest(nest, 0., 60.);
    VectorType   contact, linear;
    for (const std::string &name : solver_names())
      {
        const Result result = contest.run(name);
        VectorType  &other =
          name.compare(0, 6, "linear") == 0 ? linear : contact;
        if (other.size() == 0)
          other = contest.solution();
        // Values at hanging nodes do not count.
        const auto &constraints = nest.discretization().constraints();
        double      difference  = 0;
        for (unsigned int node = 0; node < constraints.n_owned_nodes(); ++node)
          if (!constraints.is_hanging(node))
            for (unsigned int i = dim * node; i < dim * (node + 1); ++i)
              difference =
                std::max(difference,
                         std::abs(other.local_element(i) -
                                  contest.solution().local_element(i)));
        check(result.converged &&
                result.n_contact == nest.state().n_contact() &&
                result.n_sticking == nest.state().n_sticking(),
              name + ": certified, and the same states");
        if (name.compare(0, 6, "newton") == 0)
          check_below(result.iterations, 12, name + ": few steps");
        check_below(difference / other.linfty_norm(),
                    1e-6,
                    name + ": displacements agree to 1e-6");
      }
  }



  // What is written starts with the initial guess, and errors fall.
  void
  history()
  {
    std::cout << "history" << std::endl;
    NestedIteration<2> nest(read_parameters(
      SCENES_DIR "/hertz.prm",
      {"Refinement/Maximum dofs=400", "Solver/Inner tolerance=1e-12"}));
    nest.begin();
    double n_coarser = 0;
    do
      {
        if (nest.level() > 0)
          n_coarser = nest.discretization().dof_handler().n_dofs();
        nest.solve();
    } while (nest.advance());
    Contest<2>         contest(nest, n_coarser, 60.);
    std::ostringstream out;
    contest.keep_history(out);
    for (const std::string &name : solver_names())
      {
        out.str("");
        contest.run(name);
        std::istringstream lines(out.str());
        std::string        line;
        unsigned int       n     = 0;
        double             first = 0, last = 0;
        bool               complete = true;
        while (std::getline(lines, line))
          {
            const auto columns = Utilities::split_string_list(line, ',');
            complete = complete && columns.size() == 4 && columns[0] == name &&
              columns[1] == Utilities::int_to_string(n++);
            last = Utilities::string_to_double(columns[3]);
            if (n == 1)
              first = last;
          }
        check(complete && n > 1, name + ": a line per iteration");
        check(first > 1e-4 && last < 1e-7, name + ": the error falls");
      }
  }
} // namespace test_baselines

TEST(baselines)
{
  compare<2>(SCENES_DIR "/hertz.prm", {"Refinement/Maximum dofs=1500"}, true);
  compare<2>(SCENES_DIR "/block.prm",
             {"Contact/Friction coefficient=0.05",
              "Material/Poisson ratio=0.45",
              "Refinement/Levels=2"},
             false);
  compare<3>(SCENES_3D_DIR "/block.prm", {"Refinement/Levels=1"}, true);
  compare<3>(
    SCENES_3D_DIR "/cylinder.prm",
    {"Refinement/Initial refinements=1", "Refinement/Maximum dofs=1500"},
    false);
  history();
}

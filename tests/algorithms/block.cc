// The scenes block and tresca against direct solutions of the same discrete
// laws, found by other means: displacements, nodal forces and states of all
// nodes must be the same, whatever the algorithm, the coarse correction and the
// cycle.

#include <common/algorithms/nested_iteration.h>

#include <functional>
#include <iostream>

#include <tests/support/check.h>

#include <tests/reference/solutions/scenes.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_block
{
  std::string
  override(const std::string &entry, const double value)
  {
    std::ostringstream text;
    text << entry << '=' << value;
    return text.str();
  }



  void
  compare(const unsigned int               refinements,
          const Reference::ContactProblem &problem,
          const std::string               &scene,
          std::vector<std::string>         overrides)
  {
    const Reference::ContactSolution exact = Reference::solve(problem);
    std::cout << exact.state.size() - exact.count(Reference::State::open)
              << " nodes in contact, "
              << exact.count(Reference::State::sticking) << " sticking"
              << std::endl;

    double length_scale = exact.displacement.cwiseAbs().maxCoeff(),
           force_scale  = exact.normal_force.cwiseAbs().maxCoeff();

    double       displacement_error = 0, force_error = 0, certificate = 0;
    unsigned int different_states = 0, not_converged = 0;

    overrides.insert(overrides.end(),
                     {override("Refinement/Initial refinements", refinements),
                      "Solver/Inner tolerance=1e-12",
                      "Solver/Outer tolerance=1e-11"});
    NestedIteration<2> iteration(without_safeguards(
      read_parameters(SCENES_DIR "/" + scene + ".prm", overrides)));
    iteration.begin();
    const Discretization<2> &d = iteration.discretization();

    // Which node of the reference each node is, and which of its contact
    // nodes: their order is that of the lower edge.
    std::vector<unsigned int> number(d.constraints().n_nodes());
    const auto                points = node_points(d);
    for (unsigned int i = 0; i < points.size(); ++i)
      number[i] =
        Reference::node_at(problem.mesh, {points[i][0], points[i][1]});

    for (const Algorithm algorithm :
         {Algorithm::gauss_seidel_like, Algorithm::fixed_point})
      for (const CoarseCorrection correction :
           {CoarseCorrection::truncated, CoarseCorrection::monotone})
        for (const Cycle cycle : {Cycle::V, Cycle::W})
          {
            SolverSettings settings    = iteration.parameters().solver;
            settings.algorithm         = algorithm;
            settings.coarse_correction = correction;
            settings.cycle             = cycle;
            VectorType         u;
            ContactState       state(0, false);
            const SolverReport report =
              iteration.solve_with(settings, u, state);
            not_converged += !report.converged;
            certificate = std::max(certificate, report.certificate.largest());
            for (unsigned int i = 0; i < number.size(); ++i)
              for (unsigned int c = 0; c < 2; ++c)
                {
                  displacement_error =
                    std::max(displacement_error,
                             std::abs(u.local_element(2 * i + c) -
                                      exact.displacement[2 * number[i] + c]));
                  force_error = std::max(
                    force_error,
                    std::abs(-report.residual.local_element(2 * i + c) -
                             exact.residual[2 * number[i] + c]));
                }
            for (unsigned int p = 0; p < d.contact().size(); ++p)
              {
                const Reference::State found = !state.in_contact(p)
                  ? Reference::State::open
                  : state.sticks(p) ? Reference::State::sticking
                                    : Reference::State::sliding;
                different_states +=
                  (found != exact.state[number[(d.contact())[p].node]]);
              }
          }
    displacement_error /= length_scale;
    force_error /= force_scale;

    check(not_converged == 0, "all eight variants converge");
    check(certificate < 1e-8, "certified to 1e-8");
    check(displacement_error < 1e-8, "displacements agree to 1e-8");
    check(force_error < 1e-8, "nodal forces agree to 1e-8");
    check(different_states == 0, "the states are the same");
    if (std::max({displacement_error, force_error, certificate}) >= 1e-8)
      std::cout << "  displacement " << displacement_error << ", force "
                << force_error << ", certificate " << certificate << std::endl;
  }



  void
  compare_coulomb(const unsigned int refinements,
                  const double       F,
                  const double       nu)
  {
    const unsigned int n = 1 << refinements;
    std::cout << n << "x" << n << " cells, F = " << F << ", nu = " << nu
              << ": ";
    compare(refinements,
            Reference::block(n, F, nu),
            "block",
            {override("Contact/Friction coefficient", F),
             override("Material/Poisson ratio", nu)});
  }



  // As a function, and as the scene says it.
  struct Coefficient
  {
    std::string                   text;
    std::function<double(double)> value;
  };



  void
  compare_varying(const unsigned int refinements, const Coefficient &F)
  {
    const unsigned int n = 1 << refinements;
    std::cout << n << "x" << n << " cells, F = " << F.text << ": ";
    Reference::ContactProblem problem = Reference::block(n, 1., 0.3);
    for (Reference::ContactNode &node : problem.contact)
      node.friction_coefficient = F.value(problem.mesh.nodes[node.node][0]);
    compare(refinements,
            problem,
            "block",
            {"Contact/Friction coefficient=" + F.text});
  }



  // The bound of a node is the stress times its part of the lower edge.
  void
  compare_tresca(const unsigned int refinements, const double bound)
  {
    const unsigned int n = 1 << refinements;
    std::cout << n << "x" << n << " cells, Tresca with the bound " << bound
              << ": ";
    Reference::ContactProblem problem = Reference::block(n, 0., 0.3);
    problem.friction                  = Reference::Friction::tresca;
    for (Reference::ContactNode &node : problem.contact)
      {
        const double x      = problem.mesh.nodes[node.node][0];
        node.friction_bound = bound / n * (x == 0. || x == 1. ? .5 : 1.);
      }
    compare(refinements,
            problem,
            "tresca",
            {override("Contact/Friction bound", bound)});
  }
} // namespace test_block

TEST(block)
{
  for (const unsigned int refinements : {3, 4})
    {
      for (const double F : {0., 0.05, 0.4, 1.})
        compare_coulomb(refinements, F, 0.3);
      compare_coulomb(refinements, 0.4, 0.45);
      compare_varying(refinements, {"if(x < 0.6, 0.8, 0.05)", [](double x) {
                                      return x < .6 ? .8 : .05;
                                    }});
      compare_varying(refinements, {"max(0, 0.3 - 0.5*x)", [](double x) {
                                      return std::max(0., .3 - .5 * x);
                                    }});
      for (const double bound : {0.003, 0.006, 0.1})
        compare_tresca(refinements, bound);
    }
}

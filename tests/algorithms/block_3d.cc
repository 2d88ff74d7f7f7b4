// The block scene in three dimensions against a direct solution of the same
// discrete law, found by other means: displacements, nodal forces and states of
// all nodes must be the same, whatever the algorithm, the coarse correction,
// the local solver and the truncation.

#include <common/algorithms/nested_iteration.h>

#include <functional>
#include <iostream>

#include <tests/support/check.h>

#include <tests/reference/solutions/scenes_3d.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_block_3d
{
  struct Variant
  {
    std::string       name;
    Algorithm         algorithm;
    CoarseCorrection  correction;
    LocalSolver       local_solver;
    TruncationVariant truncation;
  };

  /** How the top is moved: as the scene file says it, and for the reference. */
  struct Top
  {
    std::string                                             text;
    std::function<Eigen::Vector3d(const Eigen::Vector3d &)> displacement;
  };

  const Top as_in_scene = {"0.02, 0.01, -0.02", [](const Eigen::Vector3d &) {
                             return Eigen::Vector3d(.02, .01, -.02);
                           }};

  // Turned about the middle, so that directions of slip run in circles, and
  // tilted, so that a part of the bottom lifts off.
  const Top turned_and_tilted = {
    "-0.05*(y-0.5), 0.05*(x-0.5), -0.02+0.03*x+0.01*y",
    [](const Eigen::Vector3d &x) {
      return Eigen::Vector3d(
        -.05 * (x[1] - .5), .05 * (x[0] - .5), -.02 + .03 * x[0] + .01 * x[1]);
    }};

  /** The coefficient of friction: likewise. */
  struct Coefficient
  {
    std::string                                    text;
    std::function<double(const Eigen::Vector3d &)> value;
  };

  Coefficient
  constant(const double F)
  {
    std::ostringstream text;
    text << F;
    return {text.str(), [F](const Eigen::Vector3d &) { return F; }};
  }

  // Smooth along x, and with a jump along y.
  const Coefficient varying = {
    "if(y < 0.7, 0.4 + 0.5*x, 0)",
    [](const Eigen::Vector3d &x) { return x[1] < .7 ? .4 + .5 * x[0] : 0.; }};

  Reference::ContactProblem3D
  make_reference(const unsigned int n,
                 const Coefficient &F,
                 const double       nu,
                 const Top         &top)
  {
    // What has friction somewhere has Coulomb's law.
    Reference::ContactProblem3D problem =
      Reference::block_3d(n, F.text == "0" ? 0. : 1., nu);
    for (Reference::ContactNode3D &node : problem.contact)
      node.friction_coefficient = F.value(problem.mesh.nodes[node.node]);
    for (Reference::PrescribedDisplacement &d : problem.dirichlet)
      d.value = top.displacement(problem.mesh.nodes[d.node])[d.component];
    return problem;
  }



  /** By how much a solution differs from the direct one, in the largest
   * displacement and the largest normal force. */
  struct Difference
  {
    double       displacement = 0, force = 0, certificate = 0;
    unsigned int states    = 0;
    bool         converged = false;

    bool
    is_small() const
    {
      return converged && states == 0 &&
        std::max({displacement, force, certificate}) < 1e-9;
    }
  };



  class Block
  {
  public:
    Block(const unsigned int refinements,
          const Coefficient &F,
          const double       nu,
          const Top         &top = as_in_scene)
      : n(1 << refinements)
      , problem(make_reference(n, F, nu, top))
      , exact(Reference::solve(problem))
      , iteration(without_safeguards(read_parameters(
          SCENES_3D_DIR "/block.prm",
          {"Contact/Friction coefficient=" + F.text,
           override("Material/Poisson ratio", nu),
           override("Refinement/Initial refinements", refinements),
           "Boundary conditions/Displacement=5: " + top.text,
           "Solver/Inner tolerance=1e-12",
           "Solver/Outer tolerance=1e-11"})))
    {
      iteration.begin();

      // Which node of the reference each node is. Contact nodes of the
      // reference have numbers of their own.
      for (const Point<3> &p : node_points(iteration.discretization()))
        number.push_back(Reference::node_at(problem.mesh, {p[0], p[1], p[2]}));
      state_at.resize(problem.mesh.nodes.size());
      for (unsigned int p = 0; p < problem.contact.size(); ++p)
        state_at[problem.contact[p].node] = exact.state[p];

      std::cout << n << "^3 cells, F = " << F.text << ", nu = " << nu << ": "
                << exact.state.size() - exact.count(Reference::State::open)
                << " of " << exact.state.size() << " nodes in contact, "
                << exact.count(Reference::State::sticking) << " sticking"
                << std::endl;
    }

    Difference
    solve(const Variant &variant)
    {
      const Discretization<3> &d        = iteration.discretization();
      SolverSettings           settings = iteration.parameters().solver;
      settings.algorithm                = variant.algorithm;
      settings.coarse_correction        = variant.correction;
      settings.local_solver             = variant.local_solver;
      settings.truncation               = variant.truncation;
      VectorType         u;
      ContactState       state(0, false);
      const SolverReport report = iteration.solve_with(settings, u, state);

      Difference result;
      result.converged   = report.converged;
      result.certificate = report.certificate.largest();
      for (unsigned int i = 0; i < number.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          {
            result.displacement =
              std::max(result.displacement,
                       std::abs(u.local_element(3 * i + c) -
                                exact.displacement[3 * number[i] + c]));
            result.force =
              std::max(result.force,
                       std::abs(-report.residual.local_element(3 * i + c) -
                                exact.residual[3 * number[i] + c]));
          }
      result.displacement /= exact.displacement.cwiseAbs().maxCoeff();
      result.force /= exact.normal_force.cwiseAbs().maxCoeff();
      result.states = (d.contact().size() == exact.state.size() ? 0 : 1);
      for (unsigned int p = 0; p < d.contact().size(); ++p)
        {
          const Reference::State found = !state.in_contact(p)
            ? Reference::State::open
            : state.sticks(p) ? Reference::State::sticking
                              : Reference::State::sliding;
          result.states += (found != state_at[number[(d.contact())[p].node]]);
        }
      return result;
    }

    /** One line for all of them, and one for each that fails. */
    void
    check_all(const std::vector<Variant> &variants, const std::string &what)
    {
      std::vector<std::string> failures;
      for (const Variant &variant : variants)
        {
          const Difference difference = solve(variant);
          if (difference.is_small())
            continue;
          std::ostringstream text;
          text << "  " << variant.name << ": converged " << difference.converged
               << ", displacement " << difference.displacement << ", force "
               << difference.force << ", certificate " << difference.certificate
               << ", states that differ " << difference.states;
          failures.push_back(text.str());
        }
      check(failures.empty(), what);
      for (const std::string &line : failures)
        std::cout << line << std::endl;
    }

  private:
    const unsigned int                 n;
    const Reference::ContactProblem3D  problem;
    const Reference::ContactSolution3D exact;
    NestedIteration<3>                 iteration;
    std::vector<unsigned int>          number;
    std::vector<Reference::State>      state_at;

    static std::string
    override(const std::string &entry, const double value)
    {
      std::ostringstream text;
      text << entry << '=' << value;
      return text.str();
    }
  };



  const std::pair<std::string, Algorithm> algorithms[] = {
    {"Algorithm 3", Algorithm::gauss_seidel_like},
    {"Algorithm 2", Algorithm::fixed_point}};
  const std::pair<std::string, CoarseCorrection> corrections[] = {
    {"truncated", CoarseCorrection::truncated},
    {"monotone", CoarseCorrection::monotone}};
  const std::pair<std::string, LocalSolver> local_solvers[] = {
    {"secular equation", LocalSolver::secular_equation},
    {"Uzawa", LocalSolver::uzawa}};
  const std::pair<std::string, TruncationVariant> truncations[] = {
    {"phases", TruncationVariant::phases},
    {"contact", TruncationVariant::contact},
    {"phases without second order",
     TruncationVariant::phases_without_second_order}};
} // namespace test_block_3d

TEST(block_3d)
{
  // Algorithms, coarse corrections and local solvers.
  const auto compare = [](const unsigned int refinements,
                          const Coefficient &F,
                          const double       nu,
                          const Top         &top = as_in_scene) {
    std::vector<Variant> variants;
    for (const auto &a : algorithms)
      for (const auto &c : corrections)
        for (const auto &l : local_solvers)
          variants.push_back({a.first + ", " + c.first + ", " + l.first,
                              a.second,
                              c.second,
                              l.second,
                              TruncationVariant::phases});
    Block(refinements, F, nu, top)
      .check_all(variants, "all eight variants agree");
  };
  for (const unsigned int refinements : {2, 3})
    {
      for (const double F : {0., .05, .4, 1.})
        compare(refinements, constant(F), .3);
      compare(refinements, constant(.4), .45);
      compare(refinements, varying, .3);
    }

  std::cout << "The top turned and tilted" << std::endl;
  compare(2, constant(0.), .3, turned_and_tilted);
  for (const unsigned int refinements : {2, 3})
    compare(refinements, constant(.2), .3, turned_and_tilted);

  std::cout << "What is truncated" << std::endl;
  Block block(3, constant(.2), .3, turned_and_tilted);
  for (const auto &c : corrections)
    for (const auto &t : truncations)
      block.check_all({{"",
                        Algorithm::gauss_seidel_like,
                        c.second,
                        LocalSolver::secular_equation,
                        t.second}},
                      c.first + ", " + t.first);
}

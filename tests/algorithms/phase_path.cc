// PhasePath against all solutions of small problems with random matrices, found
// by trying all phases of all nodes:
// - their number is odd, also where there are several, whatever the coefficient
//   of friction: the equations have degree one;
// - from whatever contact zone, with whatever normal forces, the path leads to
//   one of them; with Coulomb's law, given bounds, no friction, tangents that
//   cannot move, and unknowns that belong to no node.
// In problems of many nodes, on whose way the inverse is found anew, what it
// leads to fulfils equations and law. A matrix that is singular where nothing
// touches, and a limit of multiplications, are noticed.

#include <common/algorithms/phase_path.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <utility>
#include <vector>

#include <tests/support/check.h>
#include <tests/support/dense.h>
#include <tests/support/random.h>
#include <tests/support/test.h>

using namespace Friction;
using namespace Tests;

namespace test_phase_path
{
  using Node = PhasePath::Node;

  struct Problem
  {
    Eigen::MatrixXd   S;
    Eigen::VectorXd   f;
    std::vector<Node> nodes;
  };

  // Each node has two unknowns, and one at the end belongs to none.
  Problem
  random_problem(Random &random, const unsigned int n_nodes, const double F)
  {
    Problem            result;
    const unsigned int n = 2 * n_nodes + 1;
    Eigen::MatrixXd    G(n, n);
    result.f.resize(n);
    for (unsigned int j = 0; j < n; ++j)
      {
        for (unsigned int i = 0; i < n; ++i)
          G(i, j) = random(-1, 1);
        result.f(j) = random(-1, 1);
      }
    result.S = congruence(G, Eigen::MatrixXd::Identity(n, n)) +
      .01 * Eigen::MatrixXd::Identity(n, n);
    for (unsigned int p = 0; p < n_nodes; ++p)
      {
        Node node{2 * p, 2 * p + 1, random(-.3, .3), random(-.1, .1), F, 0.};
        const unsigned int kind = random.below(8);
        if (kind < 2)
          node.coefficient = 0;
        if (kind == 0)
          node.bound = .2;
        if (kind == 2)
          node.tangential = PhasePath::nowhere;
        result.nodes.push_back(node);
      }
    return result;
  }



  // What a phase prescribes of displacements u and forces r at a node, and
  // whether they are as it allows. All phases are tried of all nodes, also
  // those that their laws do not have.
  struct Phase
  {
    bool touches;
    int  slides; // to which side; 0: sticks or has no friction

    static constexpr unsigned int n = 6;

    explicit Phase(const unsigned int number)
      : touches(number / 3 == 1)
      , slides(int(number % 3) - 1)
    {}

    bool
    exists(const Node &node) const
    {
      const bool rubs = node.tangential != PhasePath::nowhere &&
        (node.bound > 0 || (node.coefficient > 0 && touches));
      return slides == 0 || rubs;
    }

    // Two rows for a matrix of equations in (u, r).
    void
    prescribe(const Node        &node,
              Eigen::MatrixXd   &M,
              Eigen::VectorXd   &b,
              const unsigned int row) const
    {
      const unsigned int n_u                            = M.rows() / 2;
      M(row, touches ? node.normal : n_u + node.normal) = 1;
      b(row)                    = touches ? node.gap : 0.;
      const unsigned int second = row + 1;
      if (node.tangential == PhasePath::nowhere)
        {
          // Held at the origin; its number is that after the normal one.
          M(second, node.normal + 1) = 1;
          b(second)                  = node.slip_origin;
          return;
        }
      const bool rubs = node.bound > 0 || (node.coefficient > 0 && touches);
      if (rubs && slides == 0)
        {
          M(second, node.tangential) = 1;
          b(second)                  = node.slip_origin;
          return;
        }
      M(second, n_u + node.tangential) = 1;
      if (rubs)
        {
          M(second, n_u + node.normal) = -slides * node.coefficient;
          b(second)                    = slides * node.bound;
        }
    }
  };



  // By how much the law is violated at a node.
  double
  violation(const Node            &node,
            const Eigen::VectorXd &u,
            const Eigen::VectorXd &r)
  {
    const double distance = node.gap - u(node.normal), N = r(node.normal);
    double       wrong =
      std::max({0., -distance, -N, std::min(std::abs(distance), std::abs(N))});
    if (node.tangential == PhasePath::nowhere)
      return wrong;
    const double bound   = node.bound + node.coefficient * std::max(0., N),
                 T       = r(node.tangential),
                 slip    = u(node.tangential) - node.slip_origin;
    const double against = slip < 0 ? -T : T;
    return std::max({wrong,
                     std::abs(T) - bound,
                     std::min(std::abs(slip), std::abs(against - bound))});
  }



  double
  violation(const Problem         &problem,
            const Eigen::VectorXd &u,
            const Eigen::VectorXd &r)
  {
    double largest = 0;
    for (const Node &node : problem.nodes)
      largest = std::max(largest, violation(node, u, r));
    return largest;
  }



  // Pairs (u, r), one after another.
  std::vector<Eigen::VectorXd>
  all_solutions(const Problem &problem)
  {
    const unsigned int           n = problem.f.size();
    std::vector<Eigen::VectorXd> result;
    unsigned int                 n_trials = 1;
    for (unsigned int p = 0; p < problem.nodes.size(); ++p)
      n_trials *= Phase::n;
    for (unsigned int trial = 0; trial < n_trials; ++trial)
      {
        Eigen::MatrixXd M      = Eigen::MatrixXd::Zero(2 * n, 2 * n);
        Eigen::VectorXd b      = Eigen::VectorXd::Zero(2 * n);
        M.topLeftCorner(n, n)  = problem.S;
        M.topRightCorner(n, n) = Eigen::MatrixXd::Identity(n, n);
        b.head(n)              = problem.f;
        bool         all_exist = true;
        unsigned int row = n, rest = trial;
        for (const Node &node : problem.nodes)
          {
            const Phase phase(rest % Phase::n);
            rest /= Phase::n;
            all_exist = all_exist && phase.exists(node);
            phase.prescribe(node, M, b, row);
            row += 2;
          }
        M(row, 2 * n - 1) = 1;
        if (!all_exist)
          continue;
        const Eigen::VectorXd x = solve(M, b);
        if (x.allFinite() && violation(problem, x.head(n), x.tail(n)) < 1e-9)
          result.push_back(x);
      }
    return result;
  }



  std::vector<double>
  values_of(const Eigen::MatrixXd &A)
  {
    return std::vector<double>(A.data(), A.data() + A.size());
  }



  // Tangents that cannot move are no unknowns: their rows and columns are left
  // out, and their displacement is a part of the load.
  struct Reduced
  {
    std::vector<unsigned int> kept;
    std::vector<double>       matrix, load;
    std::vector<Node>         nodes;

    explicit Reduced(const Problem &problem)
      : nodes(problem.nodes)
    {
      const unsigned int        n = problem.f.size();
      std::vector<unsigned int> number(n, PhasePath::nowhere);
      std::vector<char>         is_held(n, false);
      Eigen::VectorXd           f = problem.f;
      for (const Node &node : problem.nodes)
        if (node.tangential == PhasePath::nowhere)
          {
            is_held[node.normal + 1] = true;
            f -= problem.S.col(node.normal + 1) * node.slip_origin;
          }
      for (unsigned int k = 0; k < n; ++k)
        if (!is_held[k])
          {
            number[k] = kept.size();
            kept.push_back(k);
          }
      for (const unsigned int k : kept)
        {
          load.push_back(f(k));
          for (const unsigned int i : kept)
            matrix.push_back(problem.S(i, k));
        }
      for (Node &node : nodes)
        {
          node.normal = number[node.normal];
          if (node.tangential != PhasePath::nowhere)
            node.tangential = number[node.tangential];
        }
    }
  };



  // From a random start; the difference to the nearest of the solutions, as a
  // part of it, infinite if it does not arrive.
  double
  distance_of_arrival(const Problem                      &problem,
                      const std::vector<Eigen::VectorXd> &solutions,
                      Random                             &random)
  {
    Reduced   reduced(problem);
    PhasePath path(std::move(reduced.matrix), reduced.load, reduced.nodes);
    std::vector<char> touches;
    for (unsigned int p = 0; p < problem.nodes.size(); ++p)
      touches.push_back(random.chance(.5));
    std::vector<double> u, r;
    for (unsigned int k = 0; k < reduced.kept.size(); ++k)
      {
        u.push_back(random(-.2, .2));
        r.push_back(random(-.2, 1));
      }
    path.begin(touches, u, r);
    double nearest = std::numeric_limits<double>::infinity();
    if (!path.follow(1e6))
      return nearest;
    u = path.displacement();
    r = path.force();
    for (const Eigen::VectorXd &x : solutions)
      {
        double difference = 0;
        for (unsigned int i = 0; i < reduced.kept.size(); ++i)
          difference =
            std::max({difference,
                      std::abs(x(reduced.kept[i]) - u[i]),
                      std::abs(x(problem.f.size() + reduced.kept[i]) - r[i])});
        nearest = std::min(nearest, difference / (1 + x.cwiseAbs().maxCoeff()));
      }
    return nearest;
  }



  void
  small_problems(const double F)
  {
    constexpr unsigned int n_problems = 100, n_starts = 5;
    Random                 random(1);
    unsigned int           n_even = 0, n_several = 0;
    double                 largest = 0;
    for (unsigned int i = 0; i < n_problems; ++i)
      {
        const Problem problem   = random_problem(random, 1 + i % 3, F);
        const auto    solutions = all_solutions(problem);
        n_even += solutions.size() % 2 == 0;
        n_several += solutions.size() > 1;
        for (unsigned int j = 0; j < n_starts; ++j)
          largest =
            std::max(largest, distance_of_arrival(problem, solutions, random));
      }
    std::cout << "F = " << F << std::endl;
    check(n_even == 0, "the number of solutions is odd");
    if (F > 1)
      check(n_several > 0, "there may be several");
    check_below(largest, 1e-6, "every path leads to one of them");
  }



  void
  large_problem(const double F)
  {
    constexpr unsigned int n_nodes = 60;
    Random                 random(2);
    double                 wrong = 0, left = 0;
    unsigned int           most = 0;
    for (unsigned int i = 0; i < 5; ++i)
      {
        Problem problem = random_problem(random, n_nodes, F);
        for (Node &node : problem.nodes)
          node.tangential = node.normal + 1;
        PhasePath path(
          values_of(problem.S), values_of(problem.f), problem.nodes);
        const std::vector<double> zero(problem.f.size(), 0.);
        path.begin(std::vector<char>(n_nodes, i % 2), zero, zero);
        if (!path.follow(1e9))
          {
            check(false, "the path leads to its end");
            continue;
          }
        const std::vector<double> u = path.displacement(), r = path.force();
        const Eigen::VectorXd     x =
          Eigen::Map<const Eigen::VectorXd>(u.data(), u.size());
        const Eigen::VectorXd y =
          Eigen::Map<const Eigen::VectorXd>(r.data(), r.size());
        wrong = std::max(wrong, violation(problem, x, y));
        left  = std::max(
          left, (product(problem.S, x) + y - problem.f).cwiseAbs().maxCoeff());
        most = std::max(most, path.n_changes_of_phase());
      }
    std::cout << n_nodes << " nodes, F = " << F << std::endl;
    if (F > 1)
      check(most > 50 + n_nodes, "the inverse has been found anew on the way");
    check_below(wrong, 1e-9, "the law holds");
    check_below(left, 1e-9, "equations hold");
  }



  void
  failures()
  {
    Random  random(3);
    Problem problem = random_problem(random, 3, 1.);
    for (Node &node : problem.nodes)
      {
        node.tangential  = node.normal + 1;
        node.coefficient = 1;
        node.bound       = 0;
      }
    const std::vector<double> zero(problem.f.size(), 0.);
    const std::vector<char>   none(3, 0);
    PhasePath path(values_of(problem.S), values_of(problem.f), problem.nodes);
    path.begin(none, zero, zero);
    check(!path.follow(10.), "there are too many multiplications");

    // A motion that costs nothing.
    const Eigen::VectorXd motion  = Eigen::VectorXd::Ones(problem.f.size());
    const Eigen::VectorXd image   = product(problem.S, motion);
    const Eigen::MatrixXd without = problem.S -
      product(image, image.transpose()) / (motion.transpose() * image)(0);
    PhasePath loose(values_of(without), values_of(problem.f), problem.nodes);
    loose.begin(none, zero, zero);
    check(!loose.follow(1e6), "nothing holds the body");
  }
} // namespace test_phase_path



TEST(phase_path)
{
  for (const double F : {.3, 3., 100., 1e4})
    small_problems(F);
  for (const double F : {.5, 10., 100.})
    large_problem(F);
  failures();
}

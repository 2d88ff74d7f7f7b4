// The linear equations of a step of Newton's method, with laws of all kinds at
// random nodes of random meshes with hanging nodes. What is known of the step,
// and what DenseNewtonStep finds for the rest, together fulfil what
// SemismoothLaw says of a step, node by node, with the stiffness as a dense
// matrix. NewtonEquations and DenseNewtonStep agree on the left hand side.

#include <common/iteration/dense_newton_step.h>
#include <common/iteration/newton_equations.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_newton_equations
{
  // An open node, one that sticks, one without friction, or one that slides,
  // whose bound is given or follows the normal force.
  template <int dim>
  SemismoothLaw<dim>
  random_law(const ContactNode<dim> &node, const double F, Random &random)
  {
    using Tangent = typename SemismoothLaw<dim>::Tangent;
    SemismoothLaw<dim> law;
    const double       dice = random(0., 1.);
    law.in_contact          = dice > .3;
    if (law.in_contact)
      law.known_step[0] = random(-1., 1.);
    if (dice < .2 || node.n_free_tangents == 0)
      return law;
    law.tangent = dice > .7 ? Tangent::sticks
      : dice > .6           ? Tangent::free
                            : Tangent::slides;
    double size = 0, e[dim - 1] = {};
    for (unsigned int t = 0; t < node.n_free_tangents; ++t)
      {
        if (law.tangent == Tangent::sticks)
          law.known_step[t + 1] = random(-1., 1.);
        e[t] = random(-1., 1.);
        size += e[t] * e[t];
      }
    if (law.tangent == Tangent::slides)
      for (unsigned int s = 0; s < node.n_free_tangents; ++s)
        {
          law.slope[s] = dice > .5 ? 0. : F * e[s] / std::sqrt(size);
          law.rhs[s]   = random(-1., 1.);
          if (node.n_free_tangents > 1)
            for (unsigned int t = 0; t < node.n_free_tangents; ++t)
              law.curvature[t * (dim - 1) + s] =
                .3 * ((s == t ? 1. : 0.) - e[s] * e[t] / size);
        }
    return law;
  }



  template <int dim>
  double
  along(const Eigen::VectorXd  &v,
        const ContactNode<dim> &node,
        const unsigned int      e)
  {
    double sum = 0;
    for (unsigned int d = 0; d < dim; ++d)
      sum += v(dim * node.node + d) * node.frame[e][d];
    return sum;
  }



  template <int dim>
  void
  test()
  {
    using Tangent = typename SemismoothLaw<dim>::Tangent;
    std::cout << dim << "D" << std::endl;
    constexpr double   F = 3.;
    Random             random(dim);
    RandomProblem<dim> whole(block_parameters<dim>(FrictionLaw::coulomb, F),
                             dim == 2 ? 3 : 2,
                             .5,
                             random);
    const DiscreteProblem<dim> problem = whole.discretization.problem();
    check(whole.n_hanging() > 0, "some nodes hang");
    std::vector<SemismoothLaw<dim>> laws;
    unsigned int                    n_sliding = 0, n_sticking = 0;
    for (const ContactNode<dim> &node : problem.contact)
      {
        laws.push_back(random_law(node, F, random));
        n_sliding += laws.back().tangent == Tangent::slides;
        n_sticking += laws.back().tangent == Tangent::sticks;
      }
    check(n_sliding > 0 && n_sticking > 0, "some slide, and some stick");

    const unsigned int n = dim * problem.constraints.n_owned_nodes();
    Eigen::VectorXd    r(n);
    for (unsigned int i = 0; i < n; ++i)
      r(i) = problem.constraints.is_hanging(i / dim) ? 0. : random(-1., 1.);
    NewtonEquations<dim> equations(problem);
    equations.update(laws);
    VectorType step = whole.leaf_vector(), rhs = step, v = step, image = step;
    equations.eliminate_known(laws, to_vector(r, step), step, rhs);
    DenseNewtonStep<dim> solver;
    solver.update(equations);
    check(solver.solve(v, rhs, 0., 1).accuracy < 1e-6, "solved");
    equations.vmult(image, v);
    check_below((to_eigen(image) - to_eigen(rhs)).norm() / r.norm(),
                1e-10,
                "the equations hold");

    const Eigen::VectorXd du = to_eigen(step) + to_eigen(v);
    const Eigen::VectorXd w =
      to_dense<dim>(problem.stiffness.blocks()) * du - r;
    // By how much they are violated.
    double elsewhere = 0, open = 0, touching = 0, sticking = 0, sliding = 0;
    std::vector<char> is_contact(n / dim, 0);
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        const ContactNode<dim>   &node = problem.contact[p];
        const SemismoothLaw<dim> &law  = laws[p];
        const auto larger = [](double &largest, const double value) {
          largest = std::max(largest, std::abs(value));
        };
        is_contact[node.node] = 1;
        if (law.in_contact)
          larger(touching, along(du, node, 0) - law.known_step[0]);
        else
          larger(open, along(w, node, 0));
        for (unsigned int t = 0; t < node.n_free_tangents; ++t)
          {
            const double wrong = along(w, node, t + 1);
            if (law.tangent == Tangent::free)
              larger(open, wrong);
            else if (law.tangent == Tangent::sticks)
              larger(sticking, along(du, node, t + 1) - law.known_step[t + 1]);
            else
              {
                // w_T - F e w_n + omega P du_T = b.
                double left = wrong + along(r, node, t + 1) - law.rhs[t] -
                  law.slope[t] * (along(w, node, 0) + along(r, node, 0));
                for (unsigned int s = 0; s < node.n_free_tangents; ++s)
                  left +=
                    law.curvature[t * (dim - 1) + s] * along(du, node, s + 1);
                larger(sliding, left);
              }
          }
      }
    for (unsigned int i = 0; i < n; ++i)
      if (!is_contact[i / dim] && !problem.constraints.is_hanging(i / dim))
        elsewhere = std::max(elsewhere,
                             problem.constraints.is_prescribed(i / dim, i % dim)
                               ? std::abs(du(i))
                               : std::abs(w(i)));
    check_below(elsewhere, 1e-9, "equilibrium elsewhere");
    check_below(open, 1e-9, "and where nodes are open or free");
    check_below(touching, 1e-9, "contact");
    check_below(sticking, 1e-9, "stick");
    check_below(sliding, 1e-9, "slip");
  }
} // namespace test_newton_equations



TEST(newton_equations)
{
  test<2>();
  test<3>();
}

// The linear problem of a step of Newton's method, with sliding nodes whose
// bound of friction follows the normal force, written out as a dense matrix
// that is not symmetric, on random meshes with hanging nodes and random phases:
// - in a strip of any depth what ContactStrip adds solves the equations of all
//   nodes of the strip, with all others held, and changes no others. The nodes
//   are counted by couplings of the dense matrix;
// - a strip that is the whole body solves all equations;
// - without sliding nodes there is no strip;
// - LeafRelaxation leaves the solution alone, and knows
//   the residual of these equations.

#include <common/iteration/contact_strip.h>
#include <common/iteration/contact_truncation.h>
#include <common/iteration/leaf_relaxation.h>

#include <iostream>
#include <set>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_contact_strip
{
  template <int dim>
  struct Step
  {
    const DiscreteProblem<dim>   &problem;
    ContactTruncation<dim>        truncation;
    std::vector<NodeValue<dim>>   slopes;
    Eigen::MatrixXd               matrix, T;
    std::vector<std::vector<int>> neighbours;

    // Phases at random; with sliding nodes or without.
    Step(const DiscreteProblem<dim> &problem,
         const bool                  sliding,
         Random                     &random)
      : problem(problem)
      , truncation(problem)
      , slopes(problem.contact.size())
    {
      const unsigned int n = problem.constraints.n_owned_nodes();
      const auto         A = to_dense<dim>(problem.stiffness.blocks());
      Eigen::MatrixXd    W = A, left = Eigen::MatrixXd::Zero(dim * n, dim * n);
      for (unsigned int p = 0; p < problem.contact.size(); ++p)
        {
          const ContactNode<dim> &node    = problem.contact[p];
          const double            dice    = random(0., 1.);
          const bool              slides  = sliding && dice < .6;
          NodeBlock<dim>          turning = zero_block<dim>();
          if (slides)
            {
              // In three dimensions the slip may turn, at a cost.
              const Tensor<1, dim> e =
                random(0., 1.) < .5 ? node.frame[1] : -node.frame[1];
              for (unsigned int d = 0; d < dim; ++d)
                slopes[p][d] = 7. * e[d];
              if (dim == 3)
                for (unsigned int c = 0; c < dim; ++c)
                  for (unsigned int r = 0; r < dim; ++r)
                    turning[c * dim + r] =
                      .1 * node.frame[dim - 1][r] * node.frame[dim - 1][c];
            }
          truncation.set(
            p,
            truncation.projector(p, dice > .8, dice < .6 || dice > .8),
            turning);
          for (unsigned int r = 0; r < dim; ++r)
            for (unsigned int c = 0; c < dim; ++c)
              {
                left(dim * node.node + r, dim * node.node + c) =
                  slopes[p][r] * node.normal()[c];
                W(dim * node.node + r, dim * node.node + c) +=
                  turning[c * dim + r];
              }
        }
      truncation.exchange();
      T = Eigen::MatrixXd::Zero(dim * n, dim * n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int r = 0; r < dim; ++r)
          for (unsigned int c = 0; c < dim; ++c)
            if (!problem.constraints.is_hanging(i))
              T(dim * i + r, dim * i + c) =
                truncation.truncation().projector(i)[c * dim + r];
      matrix = T * W * T - left * A * T;
      neighbours.resize(n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          if (A.block(dim * i, dim * j, dim, dim).norm() > 0)
            neighbours[i].push_back(j);
    }

    std::set<int>
    strip(const unsigned int n_layers) const
    {
      std::set<int> result;
      for (unsigned int p = 0; p < slopes.size(); ++p)
        if (slopes[p] != NodeValue<dim>{})
          result.insert(problem.contact[p].node);
      for (unsigned int layer = 0; layer < n_layers; ++layer)
        {
          const std::set<int> before = result;
          for (const int i : before)
            result.insert(neighbours[i].begin(), neighbours[i].end());
        }
      return result;
    }
  };



  // The equations hold in the strip, and nothing has changed outside.
  template <int dim>
  double
  wrong_in_strip(const Step<dim>       &step,
                 const std::set<int>   &nodes,
                 const Eigen::VectorXd &v,
                 const Eigen::VectorXd &r)
  {
    const Eigen::VectorXd defect = r - step.matrix * v;
    double                wrong  = 0;
    for (unsigned int i = 0; i < step.neighbours.size(); ++i)
      wrong = std::max(wrong,
                       nodes.count(i) ? defect.segment(dim * i, dim).norm()
                                      : v.segment(dim * i, dim).norm());
    return wrong / r.norm();
  }



  template <int dim>
  void
  test()
  {
    std::cout << dim << "D" << std::endl;
    Random             random(dim);
    RandomProblem<dim> problem(block_parameters<dim>(FrictionLaw::coulomb, 7.),
                               dim == 2 ? 3 : 2,
                               .5,
                               random);
    const DiscreteProblem<dim> discrete = problem.discretization.problem();
    check(problem.n_hanging() > 0, "some nodes hang");
    const Step<dim>    step(discrete, true, random);
    const unsigned int n = step.T.rows();
    Eigen::VectorXd    r(n);
    for (unsigned int i = 0; i < n; ++i)
      r(i) = random(-1., 1.);
    r                        = step.T * r;
    const VectorType  defect = to_vector(r, problem.leaf_vector());
    ContactStrip<dim> strip(discrete);
    double            wrong = 0;
    for (const unsigned int n_layers : {0u, 1u, 2u, 3u})
      {
        strip.update(step.truncation.truncation(), step.slopes, n_layers);
        VectorType v = problem.leaf_vector();
        strip.add_solution(v, defect);
        wrong = std::max(
          wrong, wrong_in_strip(step, step.strip(n_layers), to_eigen(v), r));
      }
    check_below(wrong, 1e-10, "equations hold in the strip");

    const unsigned int more_layers_than_nodes = 1000;
    strip.update(
      step.truncation.truncation(), step.slopes, more_layers_than_nodes);
    VectorType v = problem.leaf_vector();
    strip.add_solution(v, defect);
    const Eigen::VectorXd solution = to_eigen(v);
    check_below((r - step.matrix * solution).norm() / r.norm(),
                1e-10,
                "in a strip that is the whole body all equations hold");

    const MonotoneSmoother<dim> smoother(discrete);
    LeafRelaxation<dim>         relaxation(discrete, smoother);
    relaxation.update(step.truncation.truncation(), step.slopes);
    VectorType left = problem.leaf_vector();
    relaxation.run(v, defect, 2, &left);
    check_below((to_eigen(v) - solution).norm() / solution.norm(),
                1e-10,
                "relaxation leaves the solution alone");
    v.local_element(dim * discrete.contact[0].node) = 0.;
    v.local_element(dim * discrete.contact[1].node) = 0.;
    relaxation.run(v, defect, 1, &left);
    check_below((r - step.matrix * to_eigen(v) - to_eigen(left)).norm() /
                  r.norm(),
                1e-10,
                "and knows its residual");

    const Step<dim> sticking(discrete, false, random);
    strip.update(sticking.truncation.truncation(), sticking.slopes, 2);
    check(strip.is_empty(), "without slip there is no strip");
  }
} // namespace test_contact_strip



TEST(contact_strip)
{
  test<2>();
  test<3>();
}

// Levels that are made of the matrix, on random meshes with hanging nodes,
// random phases and a stiff layer that no cell knows of, against dense
// matrices:
// - the matrix of each level is that of the level above between its functions,
//   B_k = P^T B_{k-1} P, with the truncated leaf matrix as the first;
// - so it is after an update, which computes less than everything anew;
// - the motions of a rigid body are among the functions of each level, if the
//   body is free and of one material;
// - the cycle is symmetric, and with relaxation of the leaf mesh it converges.

#include <common/iteration/contact_truncation.h>
#include <common/levels/aggregate_levels.h>

#include <deal.II/dofs/dof_tools.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/dense.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_aggregate_levels
{
  // Random phases. With few of them changed if there are some already.
  template <int dim>
  void
  set_phases(ContactTruncation<dim>     &truncation,
             const DiscreteProblem<dim> &problem,
             const double                share,
             Random                     &random)
  {
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      {
        const ContactNode<dim> &node    = problem.contact[p];
        const double            dice    = random(0., 1.);
        NodeBlock<dim>          turning = zero_block<dim>();
        if (random(0., 1.) > share)
          continue;
        if (dim == 3 && dice < .6)
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int r = 0; r < dim; ++r)
              turning[c * dim + r] =
                .1 * node.frame[dim - 1][r] * node.frame[dim - 1][c];
        truncation.set(
          p,
          truncation.projector(p, dice > .8, dice < .6 || dice > .8),
          turning);
      }
    truncation.exchange();
  }

  template <int dim>
  Eigen::MatrixXd
  truncated_matrix(const DiscreteProblem<dim> &problem,
                   const Truncation<dim>      &truncation)
  {
    const unsigned int n = problem.constraints.n_owned_nodes();
    Eigen::MatrixXd    W = to_dense<dim>(problem.stiffness.blocks());
    Eigen::MatrixXd    T = Eigen::MatrixXd::Zero(dim * n, dim * n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int r = 0; r < dim; ++r)
        for (unsigned int c = 0; c < dim; ++c)
          if (!problem.constraints.is_hanging(i))
            {
              T(dim * i + r, dim * i + c) =
                truncation.projector(i)[c * dim + r];
              W(dim * i + r, dim * i + c) +=
                truncation.curvature(i)[c * dim + r];
            }
    return congruence(T, W); // T is symmetric
  }

  // A linear map, column by column.
  template <typename Map>
  Eigen::MatrixXd
  columns_of(const unsigned int n_rows,
             const unsigned int n_columns,
             const Map         &map)
  {
    Eigen::MatrixXd result(n_rows, n_columns);
    for (unsigned int c = 0; c < n_columns; ++c)
      {
        const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n_columns, c);
        map(result.col(c).data(), unit.data());
      }
    return result;
  }

  // P of a level, and its matrix.
  template <int dim>
  Eigen::MatrixXd
  prolongation(const AggregateLevels<dim> &levels,
               const unsigned int          k,
               const unsigned int          n_fine)
  {
    return columns_of(n_fine,
                      levels.n_motions * levels.n_nodes(k),
                      [&](double *fine, const double *coarse) {
                        levels.prolongate(k, fine, coarse);
                      });
  }

  template <int dim>
  Eigen::MatrixXd
  matrix(const AggregateLevels<dim> &levels, const unsigned int k)
  {
    const unsigned int n = levels.n_motions * levels.n_nodes(k);
    return columns_of(
      n, n, [&](double *y, const double *x) { levels.vmult(k, y, x); });
  }

  // The largest relative difference to products of dense matrices.
  template <int dim>
  double
  wrong_products(const AggregateLevels<dim> &levels, Eigen::MatrixXd B)
  {
    double wrong = 0;
    for (unsigned int k = 0; k < levels.n_levels(); ++k)
      {
        const Eigen::MatrixXd P = prolongation(levels, k, B.rows());
        B                       = congruence(P, B);
        wrong = std::max(wrong, (B - matrix(levels, k)).norm() / B.norm());
      }
    return wrong;
  }

  // A body that nothing holds, of one material: all motions of a rigid body are
  // among the functions of each level, and nothing jumps.
  template <int dim>
  void
  test_free_body(Random &random)
  {
    RandomProblem<dim> body(block_parameters<dim>(FrictionLaw::coulomb, 7.),
                            dim == 2 ? 6 : 4,
                            .6,
                            random);
    const DiscreteProblem<dim> problem     = body.discretization.problem();
    const DoFHandler<dim>     &dof_handler = body.discretization.dof_handler();
    // The stiffness matrix knows nothing of prescribed values.
    AffineConstraints<double> hanging, nothing;
    DoFTools::make_hanging_node_constraints(dof_handler, hanging);
    hanging.close();
    nothing.close();
    const NodalConstraints<dim>   free(dof_handler, hanging, nothing);
    const std::vector<Point<dim>> positions =
      node_positions<dim>(dof_handler, free);
    const AggregateLevels<dim> levels(
      problem.stiffness.blocks(), free, positions);
    check(levels.n_levels() > 1, "free body: there are several levels");
    check(!materials_jump(problem.stiffness.blocks(), MPI_COMM_WORLD),
          "no material jumps");

    std::vector<unsigned int> nodes;
    for (unsigned int i = 0; i < positions.size(); ++i)
      if (!free.is_hanging(i))
        nodes.push_back(i);
    Eigen::MatrixXd motions =
      Eigen::MatrixXd::Zero(dim * nodes.size(), dim * (dim + 1) / 2);
    for (unsigned int k = 0; k < nodes.size(); ++k)
      {
        unsigned int column = dim;
        for (unsigned int c = 0; c < dim; ++c)
          {
            motions(dim * k + c, c) = 1.;
            for (unsigned int d = 0; d < c; ++d)
              {
                motions(dim * k + c, column) = positions[nodes[k]][d];
                motions(dim * k + d, column) = -positions[nodes[k]][c];
                ++column;
              }
          }
      }

    double          wrong = 0;
    Eigen::MatrixXd P     = prolongation(levels, 0, dim * positions.size());
    for (unsigned int k = 0; k < levels.n_levels(); ++k)
      {
        if (k > 0)
          P = product(P, prolongation(levels, k, P.cols()));
        Eigen::MatrixXd Q(dim * nodes.size(), P.cols());
        for (unsigned int i = 0; i < nodes.size(); ++i)
          Q.middleRows(dim * i, dim) = P.middleRows(dim * nodes[i], dim);
        const Eigen::MatrixXd nearest = product(Q, least_squares(Q, motions));
        wrong = std::max(wrong, (nearest - motions).norm() / motions.norm());
      }
    check_below(wrong, 1e-10, "rigid motions are among the functions of all");
  }



  template <int dim>
  void
  test()
  {
    std::cout << dim << "D" << std::endl;
    Random     random(dim);
    Parameters parameters   = block_parameters<dim>(FrictionLaw::coulomb, 7.);
    const std::string layer = dim == 2 ? "where abs(y - 0.4 - 0.2*x) < 0.1"
                                       : "where abs(z - 0.4 - 0.2*x) < 0.1";
    parameters.regions.push_back({layer, Material(1e6, .3)});
    RandomProblem<dim>         body(parameters, dim == 2 ? 4 : 2, .5, random);
    const DiscreteProblem<dim> problem = body.discretization.problem();
    check(body.n_hanging() > 0, "some nodes hang");

    const std::vector<Point<dim>> positions = node_positions<dim>(
      body.discretization.dof_handler(), problem.constraints);
    AggregateLevels<dim> levels(
      problem.stiffness.blocks(), problem.constraints, positions);
    check(materials_jump(problem.stiffness.blocks(), MPI_COMM_WORLD),
          "materials jump");

    ContactTruncation<dim> truncation(problem);
    set_phases(truncation, problem, 1., random);
    levels.update(truncation.truncation());
    check_below(wrong_products(
                  levels, truncated_matrix(problem, truncation.truncation())),
                1e-12,
                "their matrices are Galerkin's");
    set_phases(truncation, problem, dim == 2 ? .1 : .5, random);
    const std::size_t rows = levels.update(truncation.truncation());
    check_below(wrong_products(
                  levels, truncated_matrix(problem, truncation.truncation())),
                1e-12,
                "and after a change");
    std::size_t everything = 0;
    for (unsigned int k = 0; k < levels.n_levels(); ++k)
      everything += levels.n_nodes(k);
    check(dim == 3 ? rows > 0 : rows > 0 && rows < everything,
          "which takes some rows, and in two dimensions not all");
    check(levels.update(truncation.truncation()) == 0,
          "and none if there is no change");

    // The cycle, and with three sweeps of Gauss-Seidel before and after it.
    const Eigen::MatrixXd A =
      truncated_matrix(problem, truncation.truncation());
    const unsigned int    n = A.rows();
    const Eigen::MatrixXd M =
      columns_of(n, n, [&](double *v, const double *r) { levels.apply(v, r); });
    // On truncated arguments, which is all that it is for.
    Eigen::MatrixXd TM = M.transpose();
    for (unsigned int c = 0; c < n; ++c)
      truncation.truncation().apply(TM.col(c).data());
    check_below(
      (TM - TM.transpose()).norm() / TM.norm(), 1e-8, "the cycle is symmetric");
    Eigen::MatrixXd lower = A.triangularView<Eigen::Lower>();
    for (unsigned int i = 0; i < n; ++i)
      if (A(i, i) <= 0)
        lower(i, i) = 1.;
    const Eigen::MatrixXd I        = Eigen::MatrixXd::Identity(n, n);
    const Eigen::MatrixXd forward  = I - solve(lower, A);
    const Eigen::MatrixXd backward = I - solve(lower.transpose(), A);
    const Eigen::MatrixXd before = product(forward, product(forward, forward));
    const Eigen::MatrixXd after =
      product(backward, product(backward, backward));
    // The ratio of errors in the energy norm, in which the null space does not
    // count.
    const auto ratio = [&](const Eigen::MatrixXd &E) {
      Eigen::VectorXd x(n);
      for (unsigned int i = 0; i < n; ++i)
        x(i) = random(-1., 1.);
      double result = 0;
      for (unsigned int step = 0; step < 100; ++step)
        {
          const Eigen::VectorXd next = product(E, x);
          result = std::sqrt(next.dot(product(A, next).col(0)) /
                             x.dot(product(A, x).col(0)));
          x      = next / next.norm();
        }
      return result;
    };
    const double with =
      ratio(product(after, product(I - product(M, A), before)));
    check(with < 1., "with relaxation the cycle converges");
    // On so few cells in three dimensions the layer is nearly all there is.
    check_below((dim == 2 ? 20. : 1.5) *
                  std::log(ratio(product(after, before))) / std::log(with),
                1.,
                "and faster than relaxation alone");
  }
} // namespace test_aggregate_levels



TEST(aggregate_levels)
{
  test<2>();
  test<3>();
  Random random(5);
  test_free_body<2>(random);
  test_free_body<3>(random);
}

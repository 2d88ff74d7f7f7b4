// Levels that are made of the matrix, on random meshes with hanging nodes,
// random phases and a stiff layer that no cell knows of, against dense
// matrices:
// - the matrix of each level is that of the level above between its functions,
//   B_k = P^T B_{k-1} P, with the truncated leaf matrix as the first;
// - so it is after an update, which computes less than everything anew;
// - away from what is held the motions of a rigid body are among the functions
//   of the first level;
// - the cycle is symmetric, and with relaxation of the leaf mesh it converges.

#include <common/iteration/contact_truncation.h>
#include <common/levels/aggregate_levels.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>

using namespace Tests;

namespace
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
    return T * W * T;
  }

  // P of a level, and its matrix, column by column.
  template <int dim>
  Eigen::MatrixXd
  prolongation(const AggregateLevels<dim> &levels,
               const unsigned int          k,
               const unsigned int          n_fine)
  {
    const unsigned int n = levels.n_motions * levels.n_nodes(k);
    Eigen::MatrixXd    P(n_fine, n);
    for (unsigned int c = 0; c < n; ++c)
      {
        const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, c);
        levels.prolongate(k, P.col(c).data(), unit.data());
      }
    return P;
  }

  template <int dim>
  Eigen::MatrixXd
  matrix(const AggregateLevels<dim> &levels, const unsigned int k)
  {
    const unsigned int n = levels.n_motions * levels.n_nodes(k);
    Eigen::MatrixXd    B(n, n);
    for (unsigned int c = 0; c < n; ++c)
      {
        const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, c);
        levels.vmult(k, B.col(c).data(), unit.data());
      }
    return B;
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
        B                       = (P.transpose() * B * P).eval();
        wrong = std::max(wrong, (B - matrix(levels, k)).norm() / B.norm());
      }
    return wrong;
  }

  // How far the motions of a rigid body are from the functions of the first
  // level, at nodes all of whose neighbours are free.
  template <int dim>
  double
  wrong_motions(const AggregateLevels<dim>    &levels,
                const DiscreteProblem<dim>    &problem,
                const std::vector<Point<dim>> &positions)
  {
    const NodeBlockMatrix<dim> &A = problem.stiffness.blocks();
    std::vector<unsigned int>   inner;
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      {
        bool is_inner = A.row_begin(i) < A.row_end(i);
        for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
          is_inner = is_inner && problem.constraints.is_free(A.column(e));
        if (is_inner)
          inner.push_back(i);
      }
    check(inner.size() > 0, "there are such nodes");
    const Eigen::MatrixXd P = prolongation(levels, 0, dim * A.n_rows());
    Eigen::MatrixXd       Q(dim * inner.size(), P.cols());
    for (unsigned int k = 0; k < inner.size(); ++k)
      Q.middleRows(dim * k, dim) = P.middleRows(dim * inner[k], dim);
    // A rotation in one plane, of which others are nothing else, and a
    // translation.
    Eigen::VectorXd motion(dim * inner.size());
    motion.setConstant(1.);
    for (unsigned int k = 0; k < inner.size(); ++k)
      {
        motion(dim * k) -= 3. * positions[inner[k]][dim - 1];
        motion(dim * k + dim - 1) += 3. * positions[inner[k]][0];
      }
    const Eigen::VectorXd nearest =
      Q.completeOrthogonalDecomposition().solve(motion);
    return (Q * nearest - motion).norm() / motion.norm();
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
    if (dim == 2)
      check(levels.n_levels() > 1, "there are several levels");
    check_below(wrong_motions(levels, problem, positions),
                1e-10,
                "rigid motions are among their functions");

    ContactTruncation<dim> truncation(problem);
    set_phases(truncation, problem, 1., random);
    const std::size_t everything = levels.update(truncation.truncation());
    check_below(wrong_products(
                  levels, truncated_matrix(problem, truncation.truncation())),
                1e-12,
                "their matrices are Galerkin's");
    set_phases(truncation, problem, .3, random);
    const std::size_t rows = levels.update(truncation.truncation());
    check_below(wrong_products(
                  levels, truncated_matrix(problem, truncation.truncation())),
                1e-12,
                "and after a change");
    check(rows > 0 && rows <= everything, "which takes no more rows");
    check(levels.update(truncation.truncation()) == 0,
          "and none if there is no change");

    // The cycle, and with three sweeps of Gauss-Seidel before and after it.
    const Eigen::MatrixXd A =
      truncated_matrix(problem, truncation.truncation());
    const unsigned int n = A.rows();
    Eigen::MatrixXd    M(n, n);
    for (unsigned int c = 0; c < n; ++c)
      {
        const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n, c);
        levels.apply(M.col(c).data(), unit.data());
      }
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
    const Eigen::MatrixXd forward = Eigen::MatrixXd::Identity(n, n) -
      lower.triangularView<Eigen::Lower>().solve(A);
    const Eigen::MatrixXd backward = Eigen::MatrixXd::Identity(n, n) -
      lower.transpose().triangularView<Eigen::Upper>().solve(A);
    const Eigen::MatrixXd before = forward * forward * forward,
                          after  = backward * backward * backward;
    // The ratio of errors in the energy norm, in which the null space does not
    // count.
    const auto ratio = [&](const Eigen::MatrixXd &E) {
      Eigen::VectorXd x(n);
      for (unsigned int i = 0; i < n; ++i)
        x(i) = random(-1., 1.);
      double result = 0;
      for (unsigned int step = 0; step < 100; ++step)
        {
          const Eigen::VectorXd next = E * x;
          result = std::sqrt(next.dot(A * next) / x.dot(A * x));
          x      = next / next.norm();
        }
      return result;
    };
    const double with =
      ratio(after * (Eigen::MatrixXd::Identity(n, n) - M * A) * before);
    check(with < 1., "with relaxation the cycle converges");
    // On so few cells in three dimensions the layer is nearly all there is.
    check_below((dim == 2 ? 20. : 1.5) * std::log(ratio(after * before)) /
                  std::log(with),
                1.,
                "and faster than relaxation alone");
  }
} // namespace



int
main(int argc, char *argv[])
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test<2>();
  test<3>();
}

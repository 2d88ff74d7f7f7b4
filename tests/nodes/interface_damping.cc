// What processes that relax at the same time may do to each other, without any
// process: a symmetric positive definite matrix of blocks is cut into parts at
// random, and all parts are relaxed at once by Gauss-Seidel, each with the
// values of the others as they were, with an obstacle and friction at every
// node:
//
//   minimise x.Ax/2 - b.x + sum_i s_i |x_i|  over  x_i <= 1 in each component.
//
// With the damping of interface_damping() the energy falls by at least a
// quarter of what the diagonal alone gives, sum_i d_i.D_i d_i/8 for steps d;
// without it, it rises for some matrices. There is not much to be left out:
// where every node is a part of its own, half of the damping is too little for
// some.

#include <common/nodes/interface_damping.h>

#include <deal.II/base/mpi.h>

#include <Eigen/Core>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/dense.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_interface_damping
{
  template <int dim>
  using Matrix = Eigen::Matrix<double, dim, dim>;
  template <int dim>
  using Value = Eigen::Matrix<double, dim, 1>;

  // A few elements, each coupling some nodes, and some more stiffness on the
  // diagonal than they have. Few and strong couplings are the hard case.
  template <int dim>
  Eigen::MatrixXd
  random_matrix(const unsigned int n, Random &random)
  {
    Eigen::MatrixXd A =
      Eigen::MatrixXd::Identity(dim * n, dim * n) * random(1e-3, .1);
    for (unsigned int e = 0; e < n; ++e)
      {
        Eigen::VectorXd v = Eigen::VectorXd::Zero(dim * n);
        for (unsigned int i = 0; i < n; ++i)
          if (random.chance(.5))
            for (unsigned int d = 0; d < dim; ++d)
              v(dim * i + d) = random(-1., 1.);
        A += v * v.transpose();
      }
    return A;
  }



  // The rows of one part: its nodes come first, the others are ghosts.
  template <int dim>
  NodeBlockMatrix<dim>
  rows_of_part(const Eigen::MatrixXd           &A,
               const std::vector<unsigned int> &own,
               const std::vector<unsigned int> &all)
  {
    auto pattern = std::make_shared<NodePattern>();
    for (unsigned int i = 0; i < own.size(); ++i)
      {
        std::vector<unsigned int> columns;
        for (unsigned int j = 0; j < all.size(); ++j)
          columns.push_back(j);
        pattern->append_row(columns);
      }
    NodeBlockMatrix<dim> rows(pattern);
    for (unsigned int i = 0; i < own.size(); ++i)
      for (std::size_t e = rows.row_begin(i); e < rows.row_end(i); ++e)
        {
          NodeBlock<dim> block;
          Eigen::Map<Matrix<dim>>(block.data()) =
            A.template block<dim, dim>(dim * own[i], dim * all[rows.column(e)]);
          rows.set(i, e, block);
        }
    return rows;
  }



  // Minimises z.Dz/2 - r.z + s|x + z| over x + z <= 1, with an accuracy far
  // beyond what is tested here.
  template <int dim>
  Value<dim>
  local_step(const Matrix<dim> &D,
             const Value<dim>  &r,
             const Value<dim>  &x,
             const double       s)
  {
    // Proximal gradient steps, projected by alternation (Dykstra).
    const double L = Tests::eigenvalues(D).maxCoeff();
    Value<dim>   y = x;
    for (unsigned int step = 0; step < 5000; ++step)
      {
        const Value<dim> target = y - (D * (y - x) - r) / L;
        Value<dim> p = target, q1 = Value<dim>::Zero(), q2 = Value<dim>::Zero();
        for (unsigned int k = 0; k < 200; ++k)
          {
            const Value<dim> before = p;
            Value<dim>       t      = p + q1;
            const double     norm   = t.norm();
            p  = norm > s / L ? Value<dim>(t * (1. - s / L / norm))
                              : Value<dim>(Value<dim>::Zero());
            q1 = t - p;
            t  = p + q2;
            p  = t.cwiseMin(1.);
            q2 = t - p;
            if ((p - before).norm() < 1e-15)
              break;
          }
        const double change = (p - y).norm();
        y                   = p;
        if (change < 1e-14)
          break;
      }
    return y - x;
  }



  enum class Damping
  {
    none,
    half,
    full
  };

  // The largest rise of the energy, and the smallest decrease relative to what
  // is promised, over some sweeps of some random problems.
  template <int dim>
  std::pair<double, double>
  relax(const unsigned int n_parts,
        const Damping      damping,
        const unsigned int n_problems)
  {
    double rise = 0, promise_kept = 1e300;
    for (unsigned int seed = 0; seed < n_problems; ++seed)
      {
        Random             random(seed);
        const unsigned int n = 6;
        Eigen::MatrixXd    A = random_matrix<dim>(n, random);
        std::vector<std::vector<unsigned int>> parts(n_parts);
        for (unsigned int i = 0; i < n; ++i)
          parts[n_parts == n ? i : random.below(n_parts)].push_back(i);

        std::vector<double> s(n);
        for (double &bound : s)
          bound = random.chance(.5) ? 0. : random(0., .5);
        Eigen::VectorXd b(dim * n), x(dim * n);
        for (unsigned int i = 0; i < dim * n; ++i)
          {
            b(i) = random(-2., 2.);
            x(i) = random(-1., 1.);
          }
        const auto energy = [&]() {
          double sum = .5 * x.dot(A * x) - b.dot(x);
          for (unsigned int i = 0; i < n; ++i)
            sum += s[i] * x.template segment<dim>(dim * i).norm();
          return sum;
        };

        double last = energy();
        for (unsigned int sweep = 0; sweep < 5; ++sweep)
          {
            Eigen::VectorXd next    = x;
            double          promise = 0;
            for (const auto &own : parts)
              {
                std::vector<unsigned int> all = own;
                for (const auto &other : parts)
                  if (&other != &own)
                    all.insert(all.end(), other.begin(), other.end());
                const NodeBlockMatrix<dim> rows =
                  rows_of_part<dim>(A, own, all);
                Eigen::VectorXd mine = x;
                for (unsigned int i = 0; i < own.size(); ++i)
                  {
                    const NodeBlock<dim> E      = interface_damping(rows, i);
                    const double         factor = damping == Damping::none ? 0.
                              : damping == Damping::half                   ? .5
                                                                           : 1.;
                    const Matrix<dim>    D =
                      A.template block<dim, dim>(dim * own[i], dim * own[i]);
                    const Value<dim> step = local_step<dim>(
                      D + factor * Eigen::Map<const Matrix<dim>>(E.data()),
                      (b - A * mine).template segment<dim>(dim * own[i]),
                      mine.template segment<dim>(dim * own[i]),
                      s[own[i]]);
                    mine.template segment<dim>(dim * own[i]) += step;
                    promise += .125 * step.dot(D * step);
                  }
                for (const unsigned int i : own)
                  next.template segment<dim>(dim * i) =
                    mine.template segment<dim>(dim * i);
              }
            x                = next;
            const double now = energy();
            rise             = std::max(rise, now - last);
            if (promise > 1e-8)
              promise_kept = std::min(promise_kept, (last - now) / promise);
            last = now;
          }
      }
    return {rise, promise_kept};
  }



  template <int dim>
  void
  test()
  {
    for (const unsigned int n_parts : {2, 3, 6})
      {
        const auto result = relax<dim>(n_parts, Damping::full, 20);
        std::cout << dim << "D, " << n_parts << " parts" << std::endl;
        check_below(result.first, 1e-12, "the energy does not rise");
        check(result.second >= 1. - 1e-6, "and falls as much as promised");
        check(relax<dim>(n_parts, Damping::none, 40).first > 1e-3,
              "without damping it rises for some matrices");
      }
    check(relax<dim>(6, Damping::half, 20).first > 1e-3,
          "and with half of it, too, if each node is a part of its own");
  }
} // namespace test_interface_damping

TEST(interface_damping)
{
  test<2>();
  test<3>();
}

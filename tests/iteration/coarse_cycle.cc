// The coarse cycle as a linear operator r -> v, written out as a dense matrix
// on small meshes with hanging nodes and random truncation.
//
// All steps of a cycle minimise the energy over some functions of the exact
// Galerkin problem. Hence no error becomes larger in the energy product: with
// C the cycle and Z an orthonormal basis of the free subspace, the norm that
// belongs to it of I - (Z^T C Z)(Z^T A Z) is at most one. It is one, since the
// finest functions are left to the relaxation of the leaf mesh. Together with
// one such sweep before and one after it is smaller, which bounds the
// contraction. A correction is a direction of descent: r.Cr > 0 unless it
// vanishes. All of this holds on stretched cells, too, where lines, or planes,
// are relaxed on levels and leaf mesh.
//
// With two levels only, the cycle is but the direct solution on the coarser
// one. Then it is a projection, whose eigenvalues are zero and one and nothing
// in between, and the energy falls by exactly what was predicted.
//
// With bounds the cycle is not linear any more, but its correction stays within
// them, its energy is not positive, and where they are infinite it is the same
// cycle as without.

#include <common/iteration/monotone_correction.h>

#include <Eigen/SparseCore>

#include <iostream>
#include <limits>

#include <tests/support/check.h>
#include <tests/support/dense.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_coarse_cycle
{
  constexpr double infinity = std::numeric_limits<double>::infinity();

  const char *
  name(const Cycle cycle)
  {
    return cycle == Cycle::V ? "V" : "W";
  }



  // Levels with the discrete problem that they refer to.
  template <int dim>
  struct TestLevels : DiscreteProblem<dim>, Levels<dim>
  {
    TestLevels(const RandomProblem<dim> &problem)
      : DiscreteProblem<dim>(problem.discretization.problem())
      , Levels<dim>(problem.discretization.dof_handler(),
                    static_cast<const DiscreteProblem<dim> &>(*this))
    {}
  };



  // An orthonormal basis of the free subspace of all nodes.
  template <int dim>
  Eigen::MatrixXd
  free_basis(const Truncation<dim> &truncation, const unsigned int n_nodes)
  {
    std::vector<Eigen::VectorXd> columns;
    for (unsigned int i = 0; i < n_nodes; ++i)
      {
        const Eigen::MatrixXd basis =
          eigenvectors_above(Eigen::Map<const Eigen::MatrixXd>(
                               truncation.projector(i).data(), dim, dim),
                             .5);
        for (unsigned int c = 0; c < basis.cols(); ++c)
          {
            columns.emplace_back(Eigen::VectorXd::Zero(dim * n_nodes));
            columns.back().segment(dim * i, dim) = basis.col(c);
          }
      }
    Eigen::MatrixXd Z(dim * n_nodes, columns.size());
    for (unsigned int c = 0; c < columns.size(); ++c)
      Z.col(c) = columns[c];
    return Z;
  }



  // Truncations of different kinds, from what is common to what is rare.
  template <int dim>
  Truncation<dim>
  make_truncation(const RandomProblem<dim> &problem,
                  const std::string        &kind,
                  Random                   &random)
  {
    const auto &constraints = problem.constraints();
    if (kind == "random at contact")
      return random_truncation<dim>(constraints, problem.contact(), .1, random);
    Truncation<dim> truncation(constraints);
    if (kind == "all stick")
      for (const auto &p : problem.contact())
        truncation.set(p.node, zero_block<dim>(), zero_block<dim>());
    else if (kind == "large patches")
      // Nothing moves on the left, so that coarse functions vanish altogether;
      // on the right everything moves in one direction only, so that blocks of
      // the coarse matrices have rank one.
      for (const auto &cell :
           problem.discretization.dof_handler().active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          {
            const unsigned int node =
              constraints.node_of_dof(cell->vertex_dof_index(v, 0));
            const double x = cell->vertex(v)[0];
            if (!constraints.is_free(node))
              continue;
            if (x < (dim == 2 ? .8 : .5))
              truncation.set(node, zero_block<dim>(), zero_block<dim>());
            else if (x > 1.2)
              {
                const NodeValue<2> in_plane = {{.6, .8}};
                NodeValue<dim>     d        = {};
                d[0]                        = in_plane[0];
                d[1]                        = in_plane[1];
                truncation.set(node, outer<dim>(d, d), zero_block<dim>());
              }
          }
    return truncation;
  }



  template <int dim>
  unsigned int
  n_hanging_at_curvature(const RandomProblem<dim> &problem,
                         const Truncation<dim>    &truncation)
  {
    return problem.n_hanging_at_contact([&](const unsigned int p) {
      const unsigned int node = problem.contact()[p].node;
      return trace<dim>(truncation.curvature(node).data()) > 0 &&
        truncation.projector(node) != identity_block<dim>();
    });
  }



  template <int dim>
  struct Setup
  {
    Setup(const RandomProblem<dim> &problem, const Truncation<dim> &truncation)
      : truncation(truncation)
      , Z(free_basis<dim>(truncation, problem.constraints().n_nodes()))
    {
      const auto T_omega =
        to_dense(truncation, problem.constraints().n_nodes());
      A       = to_dense(problem.matrix()) + T_omega.second;
      reduced = congruence(Z, A);
    }

    const Truncation<dim> &truncation;
    Eigen::MatrixXd        Z, A, reduced;
  };



  // Z^T C Z, column by column.
  template <int dim>
  Eigen::MatrixXd
  to_dense_operator(TruncatedCorrection<dim> &cycle,
                    const RandomProblem<dim> &problem,
                    const Eigen::MatrixXd    &Z)
  {
    Eigen::MatrixXd                   C(Z.cols(), Z.cols());
    VectorType                        v = problem.leaf_vector();
    const Eigen::SparseMatrix<double> S = Z.sparseView();
    for (unsigned int c = 0; c < Z.cols(); ++c)
      {
        v = 17.; // whatever is in v must not matter
        cycle.apply(v, to_vector(Z.col(c), v));
        C.col(c) = S.transpose() * to_eigen(v);
      }
    return C;
  }



  // Flat cells are in lines, and long ones, in three dimensions, in planes.
  enum class Cells
  {
    cubes,
    flat,
    elongated
  };

  // Cells that are ten times as long as wide, and on the left a roller, so that
  // the lines or the plane there have components that are prescribed.
  template <int dim>
  Parameters
  cell_parameters(const Cells cells)
  {
    Parameters p = block_parameters<dim>(FrictionLaw::coulomb, .4);
    if (cells == Cells::cubes)
      return p;
    p.scene.size          = std::vector<double>(dim, 1.);
    p.scene.distortion    = 0.;
    p.scene.subdivisions  = std::vector<unsigned int>(dim, 1);
    p.scene.size[dim - 1] = .2;
    if (cells == Cells::flat)
      {
        p.scene.subdivisions[0]       = (dim == 2 ? 3 : 1);
        p.scene.subdivisions[dim - 1] = (dim == 2 ? 6 : 4);
      }
    else
      {
        p.scene.size[1]               = .2;
        p.scene.subdivisions[1]       = 2;
        p.scene.subdivisions[dim - 1] = 2;
      }
    std::vector<std::string> roller(dim, "free");
    roller[0] = "0";
    p.boundary_conditions.displacement.push_back({"0", roller});
    return p;
  }



  template <int dim>
  void
  test_linear(const unsigned int seed, const Cells cells)
  {
    const bool               is_stretched = cells != Cells::cubes;
    Random                   random(seed);
    const RandomProblem<dim> problem(cell_parameters<dim>(cells),
                                     dim == 2 ? (is_stretched ? 2 : 4) : 2,
                                     dim == 2 ? .45 : .5,
                                     random);
    for (const std::string kind :
         {"none", "random at contact", "all stick", "large patches"})
      {
        const Truncation<dim> truncation =
          make_truncation<dim>(problem, kind, random);
        const Setup<dim> setup(problem, truncation);
        std::cout << dim << "D, "
                  << (cells == Cells::flat          ? "stretched, "
                        : cells == Cells::elongated ? "long cells, "
                                                    : "")
                  << "truncation: " << kind << "; "
                  << problem.constraints().n_nodes() << " nodes, "
                  << problem.hierarchy().n_levels() << " levels, "
                  << problem.n_hanging_with_truncated_master(truncation)
                  << " hanging nodes have a truncated master" << std::endl;
        if (kind == "random at contact")
          check((n_hanging_at_curvature<dim>(problem, truncation) > 0) ==
                  (dim == 3),
                "in 3D nodes hang at contact nodes with a second derivative");

        // The leaf relaxation, one forward sweep: L is the lower triangle of
        // the matrix, node by node.
        const Eigen::MatrixXd     factor = cholesky_factor(setup.reduced);
        std::vector<unsigned int> node_of(setup.Z.cols());
        for (unsigned int c = 0; c < node_of.size(); ++c)
          {
            unsigned int row;
            setup.Z.col(c).cwiseAbs().maxCoeff(&row);
            node_of[c] = row / dim;
          }
        Eigen::MatrixXd lower = setup.reduced;
        for (unsigned int r = 0; r < lower.rows(); ++r)
          for (unsigned int c = 0; c < lower.cols(); ++c)
            if (node_of[c] > node_of[r])
              lower(r, c) = 0.;

        double contraction_of_V = 1.;
        for (const Cycle type : {Cycle::V, Cycle::W})
          {
            TestLevels<dim>          levels(problem);
            TruncatedCorrection<dim> cycle(levels, type, 1);
            levels.update(truncation);
            if (type == Cycle::V)
              {
                const unsigned int n            = levels.n_correction_levels();
                unsigned int       n_with_lines = 0, n_with_planes = 0;
                for (unsigned int k = 1; k <= n; ++k)
                  {
                    const double share = levels.share_in_lines(k);
                    n_with_lines += share > 0;
                    n_with_planes += levels.share_relaxed_together(k) > share;
                  }
                check(n > 1 && n_with_lines == (cells == Cells::flat ? n : 0),
                      cells == Cells::flat ? "levels and leaf mesh have lines"
                                           : "there are no lines");
                if (dim == 3)
                  check(n_with_planes == (cells == Cells::elongated ? n : 0),
                        cells == Cells::elongated
                          ? "levels and leaf mesh have planes"
                          : "there are no planes");
              }
            const Eigen::MatrixXd C =
              to_dense_operator(cycle, problem, setup.Z);
            const std::string which = std::string(name(type)) + "-cycle: ";
            check(eigenvalues(.5 * (C + C.transpose())).minCoeff() >
                    -1e-12 * C.cwiseAbs().maxCoeff(),
                  which + "no correction leads uphill");

            // In the coordinates y = L^T x, with A = L L^T, the energy product
            // is the Euclidean one.
            const Eigen::MatrixXd I =
              Eigen::MatrixXd::Identity(C.rows(), C.rows());
            const Eigen::MatrixXd E      = congruence(factor, C);
            const auto            values = [](const Eigen::MatrixXd &M) {
              return Eigen::VectorXd(eigenvalues(product(M.transpose(), M))
                                       .cwiseMax(0.)
                                       .cwiseSqrt());
            };
            check_below(
              values(I - E).maxCoeff(), 1 + 1e-10, which + "no error grows");
            const unsigned int n_coarse = (values(E).array() > 1e-6).count();
            // Lines and planes of the leaf mesh are relaxed as well.
            check(n_coarse > 0 && (n_coarse < C.rows() || is_stretched),
                  which + "acts on the coarse functions");

            // Error propagation of: sweep, cycle, sweep.
            const Eigen::MatrixXd S = I - solve(lower, setup.reduced);
            const Eigen::MatrixXd G = product(
              factor.transpose(), product(S, inverse(factor.transpose())));
            const double contraction =
              values(product(G, product(I - E, G))).maxCoeff();
            check_below(contraction,
                        cells == Cells::cubes    ? .8
                          : cells == Cells::flat ? .93
                                                 : .94,
                        which + "contraction with one leaf sweep each way");
            if (type == Cycle::V)
              contraction_of_V = contraction;
            else
              check(contraction < contraction_of_V - 1e-6,
                    which + "contracts faster than the V-cycle");
          }
      }
  }



  // The leaf level and one below it.
  template <int dim>
  void
  test_two_levels(const unsigned int seed)
  {
    Random                   random(seed);
    const RandomProblem<dim> problem(
      block_parameters<dim>(FrictionLaw::coulomb, .4), 1, .6, random);
    const Truncation<dim> truncation =
      make_truncation<dim>(problem, "random at contact", random);
    const Setup<dim>         setup(problem, truncation);
    TestLevels<dim>          levels(problem);
    TruncatedCorrection<dim> cycle(levels, Cycle::V, 1);
    levels.update(truncation);
    const Eigen::MatrixXd C = to_dense_operator(cycle, problem, setup.Z);
    const Eigen::VectorXd spectrum =
      eigenvalues(congruence(cholesky_factor(setup.reduced), C));
    double deviation = 0;
    for (const double value : spectrum)
      deviation =
        std::max(deviation, std::min(std::abs(value), std::abs(value - 1)));
    double energy = 0;
    for (unsigned int sample = 0; sample < 10; ++sample)
      {
        VectorType r = problem.leaf_vector(), v(r);
        for (auto &value : r)
          value = random(-1., 1.);
        truncation.apply(r.begin());
        cycle.apply(v, r);
        const Eigen::VectorXd x        = to_eigen(v);
        const double          decrease = r * v - .5 * x.dot(setup.A * x);
        energy = std::max(energy, std::abs(decrease / (.5 * (r * v)) - 1));
      }
    std::cout << dim << "D, " << problem.hierarchy().n_levels() << " levels, "
              << problem.n_hanging_with_truncated_master(truncation)
              << " hanging nodes have a truncated master" << std::endl;
    check_below(deviation, 1e-10, "eigenvalues are zero or one");
    check((spectrum.array() > .5).any() && (spectrum.array() < .5).any(),
          "and both occur");
    check_below(energy, 1e-10, "the energy falls by half of r.v");
  }



  // One level, and all that could move sticks.
  template <int dim>
  void
  test_nothing_free()
  {
    Random                   random(1);
    const RandomProblem<dim> problem(
      block_parameters<dim>(FrictionLaw::coulomb, .4), 0, 0., random);
    Truncation<dim> truncation(problem.constraints());
    for (unsigned int i = 0; i < problem.constraints().n_nodes(); ++i)
      truncation.set(i, zero_block<dim>(), zero_block<dim>());
    TestLevels<dim>          levels(problem);
    TruncatedCorrection<dim> cycle(levels, Cycle::V, 1);
    levels.update(truncation);
    VectorType r = problem.leaf_vector(), v(r);
    v            = 17.;
    cycle.apply(v, r);
    check_below(v.linfty_norm(),
                0.,
                std::to_string(dim) + "D, nothing moves where all sticks");
  }



  template <int dim>
  void
  test_bounds(const unsigned int seed)
  {
    Random                   random(seed);
    const RandomProblem<dim> problem(
      block_parameters<dim>(FrictionLaw::coulomb, .4),
      dim == 2 ? 4 : 2,
      dim == 2 ? .45 : .5,
      random);
    const auto &constraints = problem.constraints();
    for (const std::string kind :
         {"none", "random at contact", "all stick", "large patches"})
      {
        const Truncation<dim> truncation =
          make_truncation<dim>(problem, kind, random);
        const Eigen::SparseMatrix<double> A =
          (to_dense(problem.matrix()) +
           to_dense(truncation, constraints.n_nodes()).second)
            .sparseView();
        std::cout << dim << "D, bounds, truncation: " << kind << std::endl;

        for (const Cycle type : {Cycle::V, Cycle::W})
          {
            TestLevels<dim>          levels(problem);
            TruncatedCorrection<dim> unbounded(levels, type, 2);
            MonotoneCorrection<dim>  cycle(levels, type, 2);
            levels.update(truncation);
            const std::string which = std::string(name(type)) + "-cycle: ";

            double       excess = 0, largest_energy = -infinity, deviation = 0;
            unsigned int n_active = 0, n_moved = 0;
            for (unsigned int sample = 0; sample < 40; ++sample)
              {
                VectorType r = problem.leaf_vector();
                for (auto &value : r)
                  value = random(-1., 1.);
                // Pushed or pulled as a whole, mostly: else the sum over the
                // support of a coarse function is small.
                if (sample % 2 == 0)
                  r.add(sample % 4 == 0 ? 1. : -1.);
                truncation.apply(r.begin());

                VectorType lower = r, upper = r, v = r, free = r;
                lower = -infinity;
                upper = infinity;
                unbounded.apply(free, r);
                cycle.set_bounds(lower, upper);
                cycle.apply(v, r);
                free -= v;
                deviation =
                  std::max(deviation, free.linfty_norm() / v.linfty_norm());

                // Bounds in the middle of the mesh and at its bottom: some
                // infinite, some zero, others of about the size of what is
                // wanted. At a node that is free in one direction only, the
                // bounds are such that they hold for the projection as well.
                const double size  = v.linfty_norm();
                const bool   dense = sample % 3 == 0;
                for (unsigned int i = 0; i < constraints.n_nodes(); ++i)
                  if (random.chance(dense ? .8 : .1))
                    {
                      const double b = random.chance(.2)
                        ? 0.
                        : size * std::pow(10., random(-4., 0.));
                      for (unsigned int d = 0; d < dim; ++d)
                        if (truncation.is_identity(i))
                          {
                            if (random.chance(.7))
                              lower(dim * i + d) = -b * random(0., 1.);
                            if (random.chance(.7))
                              upper(dim * i + d) = b * random(0., 1.);
                          }
                        else
                          {
                            lower(dim * i + d) = -b;
                            upper(dim * i + d) = b;
                          }
                    }
                v = 17.;
                cycle.set_bounds(lower, upper);
                cycle.apply(v, r);
                for (unsigned int i = 0; i < constraints.n_nodes(); ++i)
                  {
                    double square = 0, allowed = 0;
                    for (unsigned int d = 0; d < dim; ++d)
                      {
                        const double value = v(dim * i + d);
                        square += value * value;
                        allowed += std::pow(upper(dim * i + d), 2);
                        if (!truncation.is_identity(i))
                          continue;
                        excess = std::max({excess,
                                           value - upper(dim * i + d),
                                           lower(dim * i + d) - value});
                        if (std::abs(value) > 0 &&
                            (value > upper(dim * i + d) - 1e-14 ||
                             value < lower(dim * i + d) + 1e-14))
                          ++n_active;
                      }
                    // A projection is not longer than what is projected.
                    if (!truncation.is_identity(i))
                      excess = std::max(excess,
                                        std::sqrt(square) - std::sqrt(allowed));
                    if (square > 0)
                      ++n_moved;
                  }
                const Eigen::VectorXd x = to_eigen(v);
                largest_energy          = std::max(
                  largest_energy, .5 * x.dot(A * x) - x.dot(to_eigen(r)));
              }
            check_below(deviation, 1e-10, which + "infinite bounds are none");
            check_below(
              excess, 1e-14, which + "corrections stay within bounds");
            check(n_active > 20 && n_moved > n_active,
                  which + "which are often reached");
            check_below(largest_energy, 0., which + "the energy is lowered");
          }
      }
  }
} // namespace test_coarse_cycle

TEST(coarse_cycle)
{
  for (const Cells cells : {Cells::cubes, Cells::flat})
    {
      test_linear<2>(1, cells);
      test_linear<3>(1, cells);
    }
  test_linear<3>(1, Cells::elongated);
  test_two_levels<2>(1);
  test_two_levels<3>(1);
  test_nothing_free<2>();
  test_nothing_free<3>();
  test_bounds<2>(2);
  test_bounds<3>(2);
}

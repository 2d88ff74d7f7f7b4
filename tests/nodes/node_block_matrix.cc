// Matrices of node blocks do what dense matrices do: products, residuals,
// look-ups, Gauss-Seidel sweeps. Several sweeps chased
// through the matrix in chunks give the same as one after the other, to the
// last bit. The pseudo-inverse of a singular block and the projector onto what
// is lost satisfy the four conditions of Moore and Penrose.
//
// The leaf matrix is C^T A C: C extends the values of free nodes to hanging
// ones, A is the stiffness of the elements, assembled here without any
// constraints.
//
// Truncation multiplies by the projectors that it was given, and by nothing
// where none was given.

#include <common/discretization/leaf_matrix.h>
#include <common/nodes/gauss_seidel.h>
#include <common/nodes/node_block_matrix.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_values.h>

#include <cstring>
#include <iostream>

#include <tests/support/check.h>
#include <tests/support/dense.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_node_block_matrix
{
  // A symmetric, diagonally dominant matrix with a random pattern of small
  // bandwidth; a few rows are empty, as those of hanging nodes are.
  template <int dim>
  NodeBlockMatrix<dim>
  make_random_matrix(const unsigned int n,
                     const unsigned int bandwidth,
                     Random            &random)
  {
    std::vector<std::vector<unsigned int>> pattern(n);
    std::vector<char>                      empty(n);
    for (unsigned int i = 0; i < n; ++i)
      empty[i] = random.chance(.1);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = i + 1; j < std::min(n, i + bandwidth); ++j)
        if (!empty[i] && !empty[j] && random.chance(.5))
          {
            pattern[i].push_back(j);
            pattern[j].push_back(i);
          }
    auto blocks = std::make_shared<NodePattern>();
    for (unsigned int i = 0; i < n; ++i)
      {
        if (!empty[i])
          pattern[i].push_back(i);
        blocks->append_row(pattern[i]);
      }
    blocks->template complete<dim>();
    NodeBlockMatrix<dim> A(blocks);
    for (unsigned int i = 0; i < n; ++i)
      for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
        {
          const unsigned int j = A.column(e);
          NodeBlock<dim>     block;
          if (i < j)
            {
              for (double &value : block)
                value = random(-1., 1.);
              set_symmetric(A, i, e, block);
            }
          if (i == j)
            {
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int r = 0; r <= c; ++r)
                  block[c * dim + r] = block[r * dim + c] =
                    (c == r ? 2. * dim * bandwidth : random(-1., 1.));
              A.set(i, e, block);
            }
        }
    return A;
  }



  template <int dim>
  void
  test_matrix()
  {
    std::cout << dim << "D, matrix" << std::endl;
    Random                     random(1);
    const unsigned int         n     = 60;
    const NodeBlockMatrix<dim> A     = make_random_matrix<dim>(n, 8, random);
    const Eigen::MatrixXd      dense = to_dense(A);

    bool         found = true, diagonal_first = true, in_order = true;
    unsigned int n_empty = 0;
    for (unsigned int i = 0; i < n; ++i)
      {
        n_empty += A.row_begin(i) == A.row_end(i);
        for (unsigned int j = 0; j < n; ++j)
          {
            // Every entry of a block in the pattern is nonzero.
            const std::size_t e = A.find(i, j);
            found =
              found && (e != A.row_end(i)) == (dense(dim * i, dim * j) != 0);
            found = found && (e == A.row_end(i) || A.column(e) == j);
          }
        if (A.row_begin(i) < A.row_end(i))
          diagonal_first = diagonal_first && A.column(A.row_begin(i)) == i;
        // How many columns to the right, with the first one after the last.
        for (std::size_t e = A.row_begin(i) + 1; e < A.row_end(i); ++e)
          in_order = in_order &&
            (A.column(e - 1) + n - i) % n < (A.column(e) + n - i) % n;
      }
    check(n_empty > 0 && found, "find() finds what is there, and only that");
    check(diagonal_first && in_order, "the diagonal comes first");
    check(A.n_stored_blocks() ==
            (dim == 2 ? A.n_blocks() : (A.n_blocks() + n - n_empty) / 2),
          dim == 2 ? "all blocks are stored" : "half of the blocks is stored");
    double difference = (dense - dense.transpose()).cwiseAbs().maxCoeff();
    for (unsigned int i = 0; i < n; ++i)
      {
        std::size_t e = A.row_begin(i);
        A.for_each_block(
          i, [&](const unsigned int column, const double *block) {
            difference =
              std::max(difference,
                       column == A.column(e)
                         ? std::abs(A.trace_of(i, e) - trace<dim>(block))
                         : 1.);
            for (unsigned int r = 0; r < dim; ++r)
              for (unsigned int c = 0; c < dim; ++c)
                difference =
                  std::max(difference,
                           std::abs(block[r * dim + c] -
                                    dense(dim * i + r, dim * column + c)));
            ++e;
          });
        difference = std::max(difference, e == A.row_end(i) ? 0. : 1.);
      }
    check_below(difference, 1e-300, "each row has all of its blocks");

    Eigen::VectorXd x(dim * n), b(dim * n), y(dim * n), r(dim * n);
    for (unsigned int i = 0; i < dim * n; ++i)
      {
        x(i) = random(-1., 1.);
        b(i) = random(-1., 1.);
      }
    A.vmult(y.data(), x.data());
    A.residual(r.data(), b.data(), x.data());
    check_below(
      (y - product(dense, x)).cwiseAbs().maxCoeff(), 1e-13, "product");
    check_below(
      (r - (b - product(dense, x))).cwiseAbs().maxCoeff(), 1e-13, "residual");

    // Sweeps over some of the nodes, compared with the definition: solve for
    // one node, given all others.
    std::vector<NodeBlock<dim>> inverses(n, zero_block<dim>());
    NodeRanges                  nodes;
    const unsigned int          some[][2] = {{0, 7}, {9, 10}, {15, 58}};
    for (const auto &range : some)
      nodes.emplace_back(range[0], range[1]);
    for (unsigned int i = 0; i < n; ++i)
      if (A.row_begin(i) != A.row_end(i))
        {
          NodeBlock<dim> block;
          std::copy_n(A.diagonal(i), dim * dim, block.begin());
          inverses[i] = pseudo_inverse<dim>(block, 0.);
        }
    const auto sweep = [&](Eigen::VectorXd &x) {
      for (unsigned int i = 0; i < n; ++i)
        {
          const bool relaxed = !A.is_empty(i);
          bool       in_some = false;
          for (const auto &range : nodes)
            in_some = in_some || (i >= range.first && i < range.second);
          if (!relaxed || !in_some)
            continue;
          const Eigen::MatrixXd block = dense.block(dim * i, dim * i, dim, dim);
          const Eigen::VectorXd defect = b.segment(dim * i, dim) -
            product(dense.middleRows(dim * i, dim), x);
          x.segment(dim * i, dim) += product(Tests::inverse(block), defect);
        }
    };
    GhostExchange          no_ghosts;
    const GaussSeidel<dim> one_after_the_other(A, inverses, nodes);
    Eigen::VectorXd        expected = x, got = x;
    for (unsigned int step = 0; step < 3; ++step)
      {
        sweep(expected);
        one_after_the_other.run(1, b.data(), got.data(), no_ghosts);
      }
    check_below((expected - got).cwiseAbs().maxCoeff(), 1e-14, "three sweeps");

    // Chunks from one node to more than there are, and all sweeps at once or in
    // groups.
    bool same = true;
    for (const unsigned int n_sweeps : {3, 10})
      {
        for (unsigned int step = 3; step < n_sweeps; ++step)
          one_after_the_other.run(1, b.data(), got.data(), no_ghosts);
        A.residual(r.data(), b.data(), got.data());
        for (const unsigned int chunk_size : {1, 3, 8, 17, 59, 60, 1000})
          {
            const GaussSeidel<dim> relaxation(A, inverses, nodes, chunk_size);
            Eigen::VectorXd        chased = x, defect(dim * n);
            relaxation.run(
              n_sweeps, b.data(), chased.data(), no_ghosts, defect.data());
            same = same &&
              std::memcmp(
                chased.data(), got.data(), dim * n * sizeof(double)) == 0 &&
              std::memcmp(defect.data(), r.data(), dim * n * sizeof(double)) ==
                0;
          }
      }
    check(same, "sweeps that follow each other closely, to the last bit");
  }



  template <int dim>
  void
  test_pseudo_inverse()
  {
    std::cout << dim << "D, pseudo-inverse" << std::endl;
    using Matrix = Eigen::MatrixXd;
    Random random(2);
    double worst = 0;
    for (unsigned int i = 0; i < 1000; ++i)
      {
        // Eigenvalues in [1,10], some of them replaced by rounding noise.
        Matrix root(dim, dim);
        for (unsigned int e = 0; e < dim * dim; ++e)
          root(e) = random(-1., 1.);
        const Matrix Q = orthogonal_factor(root);
        Matrix       D = Matrix::Zero(dim, dim), lost = D;
        for (unsigned int d = 0; d < dim; ++d)
          if (random.chance(.5))
            D(d, d) = random(1., 10.);
          else
            {
              D(d, d)    = random(-1e-14, 1e-14);
              lost(d, d) = 1.;
            }
        const Matrix   A = congruence(Q.transpose(), D);
        NodeBlock<dim> block, null_space;
        for (unsigned int e = 0; e < dim * dim; ++e)
          block[e] = A(e);
        const NodeBlock<dim> inverse =
          pseudo_inverse<dim>(block, 1e-10, &null_space);
        const Matrix B  = Eigen::Map<const Matrix>(inverse.data(), dim, dim);
        const Matrix N  = Eigen::Map<const Matrix>(null_space.data(), dim, dim);
        const Matrix AB = product(A, B), BA = product(B, A);
        const auto   compare = [&](const Matrix &is, const Matrix &should_be) {
          worst = std::max(worst, (is - should_be).cwiseAbs().maxCoeff());
        };
        compare(product(AB, A), A);
        compare(product(BA, B), B);
        compare(AB, AB.transpose());
        compare(BA, BA.transpose());
        compare(AB + N, Matrix::Identity(dim, dim));
        compare(N, congruence(Q.transpose(), lost));
      }
    check_below(worst, 1e-12, "the conditions of Moore and Penrose");
  }



  template <int dim>
  void
  test_leaf_matrix()
  {
    Random                   random(3);
    const RandomProblem<dim> problem(
      block_parameters<dim>(FrictionLaw::none, 0.), 3, .3, random);
    const auto        &disc        = problem.discretization;
    const auto        &constraints = problem.constraints();
    const unsigned int n_dofs      = disc.dof_handler().n_dofs();
    std::cout << dim << "D, leaf matrix, " << constraints.n_nodes()
              << " nodes, " << problem.n_hanging() << " hang" << std::endl;

    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n_dofs, n_dofs), C = A;
    FEValues<dim>   fe_values(disc.mapping(),
                            disc.dof_handler().get_fe(),
                            QGauss<dim>(2),
                            update_gradients | update_JxW_values);
    std::vector<types::global_dof_index> indices(
      disc.dof_handler().get_fe().n_dofs_per_cell());
    const FEValuesExtractors::Vector displacement(0);
    const double lambda = problem.scene.materials().base().lambda();
    const double mu     = problem.scene.materials().base().mu();
    for (const auto &cell : disc.dof_handler().active_cell_iterators())
      {
        fe_values.reinit(cell);
        cell->get_dof_indices(indices);
        for (unsigned int i = 0; i < indices.size(); ++i)
          for (unsigned int j = 0; j < indices.size(); ++j)
            {
              double sum = 0;
              for (const unsigned int q : fe_values.quadrature_point_indices())
                sum += (2 * mu *
                          (fe_values[displacement].symmetric_gradient(i, q) *
                           fe_values[displacement].symmetric_gradient(j, q)) +
                        lambda * fe_values[displacement].divergence(i, q) *
                          fe_values[displacement].divergence(j, q)) *
                  fe_values.JxW(q);
              A(indices[i], indices[j]) += sum;
            }
      }
    for (unsigned int i = 0; i < n_dofs; ++i)
      if (const auto *masters = disc.hanging_nodes().get_constraint_entries(i))
        for (const auto &master : *masters)
          C(i, master.first) += master.second;
      else
        C(i, i) = 1.;
    const Eigen::MatrixXd expected = congruence(C, A);

    // On one process local numbers are global ones.
    const Eigen::MatrixXd got = to_dense(problem.matrix());
    check_below((got - expected).cwiseAbs().maxCoeff() /
                  expected.cwiseAbs().maxCoeff(),
                1e-14,
                "hanging nodes are condensed");
    bool empty = true;
    for (unsigned int i = 0; i < constraints.n_nodes(); ++i)
      empty = empty &&
        constraints.is_hanging(i) ==
          (problem.matrix().row_begin(i) == problem.matrix().row_end(i));
    check(empty, "exactly the rows of hanging nodes are empty");
  }



  template <int dim>
  void
  test_truncation()
  {
    std::cout << dim << "D, truncation" << std::endl;
    Random     random(4);
    Parameters parameters = block_parameters<dim>(FrictionLaw::none, 0.);
    parameters.boundary_conditions.displacement.push_back(
      {"0", std::vector<std::string>(dim, "free")});
    parameters.boundary_conditions.displacement.back().components[0] = "0";
    const RandomProblem<dim> problem(parameters, 2, .4, random);
    const auto              &constraints = problem.constraints();

    // What is prescribed, or hangs.
    const Truncation<dim> plain(constraints);
    double                difference = 0;
    for (unsigned int i = 0; i < constraints.n_nodes(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int r = 0; r < dim; ++r)
          difference += std::abs(plain.projector(i)[c * dim + r] -
                                 (r == c && !constraints.is_prescribed(i, c) &&
                                      !constraints.is_hanging(i)
                                    ? 1.
                                    : 0.));
    check_below(difference, 0., "prescribed components and hanging nodes");
    check_below(
      plain.n_truncated_components(), 0., "which are not counted as truncated");

    Truncation<dim> truncation(constraints);
    double          n_held = 0;
    for (const ContactNode<dim> &p : problem.contact())
      if (p.n_free_tangents == dim - 1)
        {
          const unsigned int rank = random.below(dim + 1);
          n_held += dim - rank;
          truncate_at_random<dim>(truncation, p.node, rank, 1., random);
        }
    check_below(std::abs(truncation.n_truncated_components() - n_held),
                1e-12,
                "the number of truncated components");

    const auto T_omega       = to_dense(truncation, constraints.n_nodes());
    const Eigen::MatrixXd &T = T_omega.first, A = to_dense(problem.matrix());
    Eigen::VectorXd        v(T.rows());
    for (unsigned int i = 0; i < v.size(); ++i)
      v(i) = random(-1., 1.);
    Eigen::VectorXd w = v;
    truncation.apply(w.data());
    check_below((w - product(T, v)).cwiseAbs().maxCoeff(), 1e-15, "apply()");

    const Eigen::MatrixXd TAT = congruence(T, A); // T is symmetric
    difference                = 0;
    for (unsigned int i = 0; i < constraints.n_nodes(); ++i)
      for (std::size_t e = problem.matrix().row_begin(i);
           e < problem.matrix().row_end(i);
           ++e)
        {
          const unsigned int   j     = problem.matrix().column(e);
          const NodeBlock<dim> block = truncation.truncated_block(
            i, problem.matrix().value(i, e).data(), j);
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int r = 0; r < dim; ++r)
              difference = std::max(
                difference,
                std::abs(block[c * dim + r] - TAT(dim * i + r, dim * j + c)));
        }
    check_below(difference, 1e-14, "truncated_block()");

    // Agreement is a matter of both projector and curvature.
    Truncation<dim>    other = truncation;
    const unsigned int node =
      problem.contact()[problem.contact().size() / 2].node;
    bool all_agree = true;
    for (unsigned int i = 0; i < constraints.n_nodes(); ++i)
      all_agree = all_agree && truncation.agrees(other, i);
    check(all_agree, "a copy agrees");
    other.set(node, identity_block<dim>(), zero_block<dim>());
    NodeBlock<dim> curvature = zero_block<dim>();
    curvature[0]             = 1.;
    Truncation<dim> third    = other;
    third.set(node, identity_block<dim>(), curvature);
    check(!third.agrees(other, node) && third.agrees(third, node),
          "another curvature does not");
    third.set(node, zero_block<dim>(), zero_block<dim>());
    check(!third.agrees(other, node), "another projector does not");
    check(!other.is_identity(node) || other.agrees(plain, node),
          "the identity agrees with a node never truncated");
  }
} // namespace test_node_block_matrix

TEST(node_block_matrix)
{
  test_matrix<2>();
  test_matrix<3>();
  test_pseudo_inverse<2>();
  test_pseudo_inverse<3>();
  test_leaf_matrix<2>();
  test_leaf_matrix<3>();
  test_truncation<2>();
  test_truncation<3>();
}

// The kernels do what a plain loop does, up to rounding: products, residuals,
// and Gauss-Seidel sweeps, with each kind of instructions that the processor
// has; on meshes
// with hanging nodes, whose rows are empty and whose neighbours have rows of
// all lengths, and for rows with no block, with one, two, and so on. They read
// nothing outside of the matrix and the vectors, and write nothing but the rows
// that they were told to (the former is for the address sanitizer to say).
//
// The memory that is asked for in large pages is like any other.

#include <common/nodes/gauss_seidel.h>
#include <common/nodes/instructions.h>
#include <common/nodes/node_block_matrix.h>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_row_kernels
{
  // One entry after the other, in the order of the columns. Those from n_rows()
  // on are nodes of other processes.
  template <int dim>
  std::vector<double>
  plain_product(const NodeBlockMatrix<dim> &A,
                const unsigned int          row,
                const std::vector<double>  &x)
  {
    std::vector<double> product(dim, 0.);
    for (unsigned int j = 0; j < x.size() / dim; ++j)
      if (const std::size_t e = A.find(row, j); e != A.row_end(row))
        {
          const NodeBlock<dim> block = A.value(row, e);
          for (unsigned int r = 0; r < dim; ++r)
            for (unsigned int c = 0; c < dim; ++c)
              product[r] += block[c * dim + r] * x[dim * j + c];
        }
    return product;
  }



  template <int dim>
  void
  plain_relaxation(const NodeBlockMatrix<dim>        &A,
                   const std::vector<NodeBlock<dim>> &inverses,
                   const unsigned int                 row,
                   const std::vector<double>         &b,
                   std::vector<double>               &x)
  {
    const std::vector<double> product = plain_product(A, row, x);
    for (unsigned int r = 0; r < dim; ++r)
      for (unsigned int c = 0; c < dim; ++c)
        x[dim * row + r] +=
          inverses[row][c * dim + r] * (b[dim * row + c] - product[c]);
  }



  double
  relative_difference(const std::vector<double> &a,
                      const std::vector<double> &b)
  {
    double difference = 0, largest = 0;
    for (unsigned int i = 0; i < a.size(); ++i)
      {
        difference = std::max(difference, std::abs(a[i] - b[i]));
        largest    = std::max(largest, std::abs(a[i]));
      }
    return difference / largest;
  }



  std::vector<double>
  random_vector(const unsigned int n, Random &random)
  {
    std::vector<double> result(n);
    for (double &value : result)
      value = random(-1., 1.);
    return result;
  }



  template <int dim>
  void
  test(const NodeBlockMatrix<dim> &A,
       const NodeRanges           &nodes,
       const unsigned int          n_ghosts,
       Random                     &random)
  {
    const unsigned int          n = A.n_rows();
    std::vector<NodeBlock<dim>> inverses(n, zero_block<dim>());
    for (unsigned int i = 0; i < n; ++i)
      if (A.row_begin(i) < A.row_end(i))
        {
          NodeBlock<dim> block;
          std::copy_n(A.diagonal(i), dim * dim, block.begin());
          inverses[i] =
            pseudo_inverse<dim>(block, 1e-10 * trace<dim>(block.data()));
        }
    const GaussSeidel<dim>    relaxation(A, inverses, nodes, 16);
    GhostExchange             no_ghosts;
    const std::vector<double> b = random_vector(dim * n, random),
                              start =
                                random_vector(dim * (n + n_ghosts), random);

    double energy_error = 0, product_error = 0, residual_error = 0,
           sweep_error = 0, row_error = 0, left_over = 0;
    for (const auto instructions : available_instructions())
      {
        instructions_in_use = instructions;
        std::vector<double> Ax(dim * n), r(dim * n), expected(dim * n);
        for (unsigned int i = 0; i < n; ++i)
          {
            const std::vector<double> product = plain_product(A, i, start);
            std::copy_n(product.begin(), dim, &expected[dim * i]);
          }
        A.vmult(Ax.data(), start.data());
        product_error =
          std::max(product_error, relative_difference(expected, Ax));
        for (unsigned int i = 0; i < n; ++i)
          {
            const NodeValue<dim> product = A.row_times(i, start.data());
            std::copy_n(product.begin(), dim, &Ax[dim * i]);
          }
        product_error =
          std::max(product_error, relative_difference(expected, Ax));
        double energy = 0., all = 0.;
        for (unsigned int i = 0; i < n; ++i)
          for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
            {
              const unsigned int   j     = A.column(e);
              const NodeBlock<dim> block = A.value(i, e);
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int q = 0; q < dim; ++q)
                  {
                    const double term = start[dim * i + q] *
                      block[c * dim + q] * start[dim * j + c];
                    energy += (j < i ? 0. : j == i || j >= n ? 1. : 2.) * term;
                    all += std::abs(term);
                  }
            }
        energy_error =
          std::max(energy_error,
                   std::abs(energy - A.energy_product(start.data())) / all);
        A.residual(r.data(), b.data(), start.data());
        for (unsigned int i = 0; i < dim * n; ++i)
          expected[i] = b[i] - expected[i];
        residual_error =
          std::max(residual_error, relative_difference(expected, r));

        std::vector<double> x = start, plain = start;
        for (unsigned int sweep = 0; sweep < 3; ++sweep)
          for (const RowRange &range : nodes)
            for (unsigned int i = range.first; i < range.second; ++i)
              plain_relaxation(A, inverses, i, b, plain);
        relaxation.run(3, b.data(), x.data(), no_ghosts, r.data());
        const auto residual_at = [&](const std::vector<double> &where) {
          for (unsigned int i = 0; i < n; ++i)
            {
              const std::vector<double> product = plain_product(A, i, where);
              for (unsigned int d = 0; d < dim; ++d)
                expected[dim * i + d] = b[dim * i + d] - product[d];
            }
        };
        residual_at(plain);
        sweep_error = std::max({sweep_error,
                                relative_difference(plain, x),
                                relative_difference(expected, r)});

        // Row by row, as contact nodes are relaxed.
        x = plain                       = start;
        double                    *sums = A.partial_sums();
        const RowKernels::LeftSums left{sums, true, true};
        for (unsigned int i = 0; i < n; ++i)
          {
            if (A.is_empty(i))
              continue;
            const NodeValue<dim> product =
              RowKernels::times<dim>(A.rows(), i, x.data(), left);
            for (unsigned int q = 0; q < dim; ++q)
              for (unsigned int c = 0; c < dim; ++c)
                x[dim * i + q] +=
                  inverses[i][c * dim + q] * (b[dim * i + c] - product[c]);
            RowKernels::add_share<dim>(A.rows(), i, x.data(), left);
            plain_relaxation(A, inverses, i, b, plain);
          }
        row_error = std::max(row_error, relative_difference(plain, x));

        // Each loop over all rows leaves the sums as it has found them, also
        // one of several groups.
        for (const NodeRanges &some : {nodes, NodeRanges()})
          for (const unsigned int n_sweeps : {0, 1, 2, 6})
            for (const bool with_residual : {false, true})
              {
                GaussSeidel<dim>(A, inverses, some, 16)
                  .run(n_sweeps,
                       b.data(),
                       x.data(),
                       no_ghosts,
                       with_residual ? r.data() : nullptr);
                residual_at(x);
                if (with_residual)
                  row_error =
                    std::max(row_error, relative_difference(expected, r));
                for (unsigned int s = 0;
                     stores_half<dim> && s < RowKernels::n_partial_sums * n;
                     ++s)
                  left_over = std::max(left_over, std::abs(sums[s]));
              }
      }
    check_below(product_error, 1e-13, "products");
    check_below(energy_error, 1e-13, "energies of half the matrix");
    check_below(residual_error, 1e-13, "residuals");
    check_below(sweep_error, 1e-13, "sweeps, and residuals after them");
    check_below(row_error, 1e-13, "sweeps by single rows, and none at all");
    check_below(left_over, 1e-300, "no sums are left over");
  }



  template <int dim>
  void
  test_hanging_nodes()
  {
    std::cout << dim << "D, hanging nodes" << std::endl;
    Random                   random(3);
    const RandomProblem<dim> problem(
      block_parameters<dim>(FrictionLaw::none, 0.), 3, .3, random);
    check(problem.n_hanging() > 0, "there are such");
    const NodeBlockMatrix<dim> &A = problem.matrix();
    test(A, {{0, A.n_rows()}}, 0, random);

    const std::vector<double> x = random_vector(dim * A.n_rows(), random);
    std::vector<double>       Ax(x);
    A.vmult(Ax.data(), x.data());
    double xAx = 0.;
    for (unsigned int i = 0; i < x.size(); ++i)
      xAx += x[i] * Ax[i];
    check_below(std::abs(A.energy_product(x.data()) / xAx - 1.),
                1e-13,
                "half of a symmetric matrix is enough");
  }



  // Row i couples to some of the next i%12 nodes, unless it is empty, and these
  // to it; and every fifth one to some nodes of other processes.
  template <int dim>
  void
  test_lengths()
  {
    std::cout << dim << "D, rows of all lengths" << std::endl;
    Random                                 random(2);
    const unsigned int                     n = 100, n_ghosts = 6;
    std::vector<std::vector<unsigned int>> columns(n);
    for (unsigned int i = 0; i < n; ++i)
      if (i % 7 != 3)
        {
          columns[i].push_back(i);
          for (unsigned int j = i + 1; j < std::min(n, i + i % 12); ++j)
            if (j % 7 != 3 && random.chance(.7))
              {
                columns[i].push_back(j);
                columns[j].push_back(i);
              }
          for (unsigned int g = 0; g < n_ghosts; ++g)
            if (i % 5 == 0 && random.chance(.5))
              columns[i].push_back(n + g);
        }
    auto                  pattern = std::make_shared<NodePattern>();
    std::vector<unsigned> lengths(12, 0);
    for (auto &row : columns)
      {
        ++lengths[std::min<std::size_t>(row.size(), lengths.size() - 1)];
        pattern->append_row(row);
      }
    check(*std::min_element(lengths.begin(), lengths.begin() + 8) > 0,
          "from 0 to 7 blocks");
    pattern->template complete<dim>();
    NodeBlockMatrix<dim> A(pattern);
    for (unsigned int i = 0; i < n; ++i)
      for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
        if (A.column(e) >= i)
          {
            NodeBlock<dim> block;
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int r = 0; r < dim; ++r)
                block[c * dim + r] = A.column(e) == i && r < c
                  ? block[r * dim + c]
                  : random(-1., 1.) +
                    (A.column(e) == i && c == r ? 40. * dim : 0.);
            set_symmetric(A, i, e, block);
          }
    test(A, {{0, 1}, {2, 30}, {31, 33}, {40, 99}}, n_ghosts, random);
  }



  void
  test_huge_pages()
  {
    std::cout << "large pages" << std::endl;
    bool zero = true;
    for (const std::size_t n : {0, 1, 1000, 262143, 262144, 1000000})
      {
        HugePageVector<double> v(n, 0.);
        for (const double x : v)
          zero = zero && x == 0.;
        v.push_back(1.);
        HugePageVector<double> w = v;
        v.clear();
        v.shrink_to_fit();
        zero = zero && w.size() == n + 1 && w.back() == 1. && v.empty();
      }
    check(zero, "vectors of all sizes");
  }
} // namespace test_row_kernels

TEST(row_kernels)
{
  test_hanging_nodes<2>();
  test_hanging_nodes<3>();
  test_lengths<2>();
  test_lengths<3>();
  test_huge_pages();
}

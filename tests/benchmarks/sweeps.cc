// What does a Gauss-Seidel sweep cost? Nanoseconds per node and sweep over the
// leaf matrix of a scene's first mesh, for a plain loop, which the library
// used to have and is kept here for comparison, and for the library's kernels
// with each kind of instructions that the processor has; one sweep, three that
// follow each other through the cache, and three and six with the residual, as
// the iteration has them. And a product with the matrix, A x, and x.Ax. In
// three dimensions the library stores half of the matrix, and the plain loop
// all of it. All are measured in turn, many times, and the least is printed.
//
// Beside it what part that is of what the machine can do: of memory, as
// measured by a triad a = b + s c, and of arithmetic, as measured by products
// and sums of numbers in registers.
//
// Usage: benchmark-sweeps 2|3 scene.prm [Section/Entry=value ...]

#include <common/algorithms/nested_iteration.h>
#include <common/nodes/gauss_seidel.h>
#include <common/nodes/instructions.h>

#include <deal.II/base/timer.h>

#include <tests/benchmarks/benchmark.h>
#include <tests/benchmarks/machine.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

namespace benchmark_sweeps
{
  using namespace Benchmark;
  using namespace dealii;
  using namespace Friction;

  // A matrix as one would store it without further thought: columns ascend, the
  // diagonal comes first. The sweep is the definition.
  template <int dim>
  class Plain
  {
  public:
    Plain(const NodeBlockMatrix<dim>        &A,
          const std::vector<NodeBlock<dim>> &inverses)
      : inverses(inverses)
    {
      for (unsigned int i = 0; i < A.n_rows(); ++i)
        {
          std::vector<std::size_t> order(A.row_end(i) - A.row_begin(i));
          std::iota(order.begin(), order.end(), A.row_begin(i));
          if (!order.empty())
            std::sort(order.begin() + 1,
                      order.end(),
                      [&](const std::size_t e, const std::size_t f) {
                        return A.column(e) < A.column(f);
                      });
          for (const std::size_t e : order)
            {
              columns.push_back(A.column(e));
              const NodeBlock<dim> block = A.value(i, e);
              values.insert(values.end(), block.begin(), block.end());
            }
          starts.push_back(columns.size());
        }
      values.shrink_to_fit();
    }

    NodeValue<dim>
    row_times(const unsigned int i, const double *x) const
    {
      typedef double Pair __attribute__((vector_size(16), aligned(8)));
      const double  *a = &values[dim * dim * starts[i]];
      NodeValue<dim> y;
      if constexpr (dim == 2)
        {
          Pair sum0 = {0., 0.}, sum1 = {0., 0.};
          for (std::size_t e = starts[i]; e < starts[i + 1]; ++e, a += 4)
            {
              const double *xe = &x[2 * static_cast<std::size_t>(columns[e])];
              sum0 += *reinterpret_cast<const Pair *>(a) * Pair{xe[0], xe[0]};
              sum1 +=
                *reinterpret_cast<const Pair *>(a + 2) * Pair{xe[1], xe[1]};
            }
          sum0 += sum1;
          y[0] = sum0[0];
          y[1] = sum0[1];
        }
      else
        {
          Pair   sum0 = {0., 0.}, sum1 = {0., 0.}, sum2 = {0., 0.};
          double last0 = 0., last1 = 0., last2 = 0.;
          for (std::size_t e = starts[i]; e < starts[i + 1]; ++e, a += 9)
            {
              const double *xe = &x[3 * static_cast<std::size_t>(columns[e])];
              sum0 += *reinterpret_cast<const Pair *>(a) * Pair{xe[0], xe[0]};
              sum1 +=
                *reinterpret_cast<const Pair *>(a + 3) * Pair{xe[1], xe[1]};
              sum2 +=
                *reinterpret_cast<const Pair *>(a + 6) * Pair{xe[2], xe[2]};
              last0 += a[2] * xe[0];
              last1 += a[5] * xe[1];
              last2 += a[8] * xe[2];
            }
          sum0 += sum1 + sum2;
          y[0] = sum0[0];
          y[1] = sum0[1];
          y[2] = last0 + last1 + last2;
        }
      return y;
    }

    void
    vmult(double *y, const double *x) const
    {
      for (unsigned int i = 0; i + 1 < starts.size(); ++i)
        {
          const NodeValue<dim> product = row_times(i, x);
          std::copy_n(product.begin(), dim, y + dim * i);
        }
    }

    double
    energy_product(const double *x) const
    {
      double sum = 0.;
      for (unsigned int i = 0; i + 1 < starts.size(); ++i)
        {
          const NodeValue<dim> product = row_times(i, x);
          for (int d = 0; d < dim; ++d)
            sum += x[dim * i + d] * product[d];
        }
      return sum;
    }

    void
    relax(const RowRange &rows, const double *b, double *x) const
    {
      for (unsigned int i = rows.first; i < rows.second; ++i)
        {
          NodeValue<dim> defect = row_times(i, x);
          for (int d = 0; d < dim; ++d)
            defect[d] = b[dim * i + d] - defect[d];
          const NodeValue<dim> correction =
            times<dim>(inverses[i].data(), defect.data());
          for (int d = 0; d < dim; ++d)
            x[dim * i + d] += correction[d];
        }
    }

    void
    residual(const RowRange &rows,
             double         *r,
             const double   *b,
             const double   *x) const
    {
      for (unsigned int i = rows.first; i < rows.second; ++i)
        {
          const NodeValue<dim> product = row_times(i, x);
          for (int d = 0; d < dim; ++d)
            r[dim * i + d] = b[dim * i + d] - product[d];
        }
    }

  private:
    const std::vector<NodeBlock<dim>> &inverses;
    std::vector<std::size_t>           starts = {0};
    std::vector<unsigned int>          columns;
    std::vector<double>                values;
  };



  template <int dim>
  void
  run(const Parameters &parameters)
  {
    NestedIteration<dim> nest(parameters);
    nest.begin();
    const NodeBlockMatrix<dim> &A = nest.discretization().stiffness().blocks();
    const unsigned int          n = A.n_rows();

    std::vector<NodeBlock<dim>> inverses(n, zero_block<dim>());
    for (unsigned int i = 0; i < n; ++i)
      if (!A.is_empty(i))
        {
          NodeBlock<dim> block;
          std::copy_n(A.diagonal(i), dim * dim, block.begin());
          inverses[i] =
            pseudo_inverse<dim>(block, 1e-10 * trace<dim>(block.data()));
        }
    const GaussSeidel<dim>    relaxation(A, inverses, {{0, n}});
    const SweepSchedule<dim> &schedule = relaxation.schedule();
    const Plain<dim>          plain(A, inverses);
    std::vector<double>       b(dim * n, 1.), x(dim * n, 0.), r(dim * n);
    GhostExchange             no_ghosts;

    // The program of each column, and of each row.
    const std::vector<Instructions> instructions = available_instructions();
    const unsigned int              n_columns    = 1 + instructions.size();
    const auto                      sweep = [&](const unsigned int column,
                           const unsigned int n_sweeps,
                           const bool         with_residual) {
      if (column > 0)
        {
          relaxation.run(n_sweeps,
                         b.data(),
                         x.data(),
                         no_ghosts,
                         with_residual ? r.data() : nullptr);
          return;
        }
      schedule.run(
        n_sweeps,
        with_residual,
        [&](const Stage &stage, RowRange) {
          const RowRange rows = schedule.chunk(stage.chunk);
          if (stage.computes_residual)
            plain.residual(rows, r.data(), b.data(), x.data());
          else
            plain.relax(rows, b.data(), x.data());
        },
        no_ghosts,
        x.data());
    };
    const auto product = [&](const unsigned int column) {
      if (column > 0)
        A.vmult(r.data(), x.data());
      else
        plain.vmult(r.data(), x.data());
    };
    double     energy         = 0.;
    const auto energy_product = [&](const unsigned int column) {
      energy += column > 0 ? A.energy_product(x.data())
                           : plain.energy_product(x.data());
    };
    // What a pass must read and write at least: what is stored of the matrix,
    // row starts, the sums of the left, and the vector twice; sweeps also read
    // inverse diagonals and the right hand side, and an energy product has no
    // second vector, no sums, and needs half of a matrix. And the blocks that
    // are multiplied.
    const double bytes_of_matrix = A.n_stored_blocks() *
      (dim * dim * sizeof(double) + sizeof(unsigned int)),
                 bytes_of_vector = n * dim * sizeof(double),
                 bytes_of_starts =
                   (stores_half<dim> ? 2. : 1.) * n * sizeof(std::size_t),
                 bytes_of_sums  = stores_half<dim>
       ? 2. * n * RowKernels::n_partial_sums * sizeof(double)
       : 0.;
    const double bytes_of_sweep = bytes_of_matrix + bytes_of_starts +
      bytes_of_sums + 3 * bytes_of_vector + n * dim * dim * sizeof(double);
    struct Row
    {
      std::string                             name;
      unsigned int                            n_passes;
      double                                  bytes, n_blocks;
      std::function<void(const unsigned int)> run;
      std::vector<double>                     seconds;
    };
    std::vector<Row>          rows;
    const std::vector<double> never(n_columns, 1e300);
    const auto                add_sweeps = [&](const unsigned int n_sweeps,
                                const bool         with_residual) {
      rows.push_back(
        {std::to_string(n_sweeps) + (n_sweeps == 1 ? " sweep" : " sweeps") +
           (with_residual ? ", and residual" : ""),
         n_sweeps + with_residual,
         bytes_of_sweep,
         (n_sweeps + with_residual) * (1. * A.n_blocks() + n),
         [&sweep, n_sweeps, with_residual](const unsigned int column) {
           sweep(column, n_sweeps, with_residual);
         },
         never});
    };
    for (const unsigned int n_sweeps : {1, 3})
      add_sweeps(n_sweeps, false);
    for (const unsigned int n_sweeps : {3, 6})
      add_sweeps(n_sweeps, true);
    rows.push_back(
      {"A x",
       1,
       bytes_of_matrix + bytes_of_starts + bytes_of_sums + 2 * bytes_of_vector,
       1. * A.n_blocks(),
       product,
       never});
    rows.push_back({"x.Ax",
                    1,
                    (stores_half<dim> ? 1. : .5) * bytes_of_matrix +
                      bytes_of_starts + bytes_of_vector,
                    .5 * (A.n_blocks() + n),
                    energy_product,
                    never});

    // A large matrix is measured less often than a small one.
    const unsigned int n_times = 20 + 200000 / (A.n_blocks() / 100 + 1);
    for (unsigned int time = 0; time < n_times; ++time)
      for (Row &row : rows)
        for (unsigned int column = 0; column < n_columns; ++column)
          {
            if (column > 0)
              instructions_in_use = instructions[column - 1];
            Timer timer;
            row.run(column);
            row.seconds[column] =
              std::min(row.seconds[column], timer.wall_time());
          }

    const double triad = triad_bandwidth(), peak = peak_arithmetic();
    std::printf("scene %s, %u dofs, %.1f blocks per row, %.0f MB\n",
                parameters.name.c_str(),
                dim * n,
                1. * A.n_blocks() / n,
                1e-6 * bytes_of_sweep);
    std::printf(
      "triad %.1f GB/s, arithmetic %.1f Gflop/s\n", 1e-9 * triad, 1e-9 * peak);
    std::printf(
      "                             |   ns per node and sweep |       "
      "  |     last column\n"
      "sweeps                       |  plain  common   avx2   | faster "
      " | of triad  of peak\n");
    for (const Row &row : rows)
      {
        std::printf("%-28s |", row.name.c_str());
        for (const double seconds : row.seconds)
          std::printf(" %6.1f ", 1e9 * seconds / row.n_passes / n);
        for (unsigned int column = n_columns; column < 3; ++column)
          std::printf("      - ");
        const double best = row.seconds.back();
        std::printf("| %6.2f  | %6.0f%% %7.0f%%\n",
                    row.seconds.front() / best,
                    100. * row.bytes / best / triad,
                    100. * 2. * row.n_blocks * dim * dim / best / peak);
      }
    std::printf("\n");
    AssertThrow(energy >= 0., ExcMessage("The matrix is not positive."));
  }
} // namespace benchmark_sweeps



BENCHMARK(sweeps)
{
  try
    {
      const std::string dimension = argc < 3 ? "" : argv[1];
      if (dimension != "2" && dimension != "3")
        {
          std::cerr << "Usage: benchmark-sweeps 2|3 scene.prm "
                       "[Section/Entry=value ...]\n";
          return 2;
        }
      const Friction::Parameters parameters = Friction::read_parameters(
        argv[2], std::vector<std::string>(argv + 3, argv + argc));
      if (dimension == "2")
        run<2>(parameters);
      else
        run<3>(parameters);
    }
  catch (const std::exception &error)
    {
      std::cerr << error.what() << std::endl;
      return 1;
    }
  return 0;
}

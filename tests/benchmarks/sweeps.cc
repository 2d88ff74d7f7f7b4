// What does a Gauss-Seidel sweep cost? Nanoseconds per node and sweep over the
// leaf matrix of a scene's first mesh, for a plain loop, which the library
// used to have and is kept here for comparison, and for the library's kernels
// with each kind of instructions that the processor has; one sweep, three that
// follow each other through the cache, and three with the residual, forwards
// and backwards. All are measured in turn, many times, and the least is
// printed.
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
              values.insert(values.end(), A.block(e), A.block(e) + dim * dim);
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
    relax(const RowRange &rows,
          const double   *b,
          double         *x,
          const bool      backwards) const
    {
      for (unsigned int n = 0; n < rows.second - rows.first; ++n)
        {
          const unsigned int i =
            backwards ? rows.second - 1 - n : rows.first + n;
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
      if (A.row_begin(i) < A.row_end(i))
        {
          NodeBlock<dim> block;
          std::copy_n(A.block(A.row_begin(i)), dim * dim, block.begin());
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
                           const Sweeps      &sweeps,
                           const bool         with_residual) {
      if (column > 0)
        {
          instructions_in_use = instructions[column - 1];
          relaxation.run(sweeps,
                         b.data(),
                         x.data(),
                         no_ghosts,
                         with_residual ? r.data() : nullptr);
          return;
        }
      schedule.run(
        sweeps,
        with_residual,
        [&](const unsigned int stage, const unsigned int chunk, RowRange) {
          if (stage == sweeps.number)
            plain.residual(schedule.chunk(chunk), r.data(), b.data(), x.data());
          else
            plain.relax(
              schedule.chunk(chunk), b.data(), x.data(), sweeps.backwards);
        },
        no_ghosts,
        x.data());
    };
    struct Row
    {
      const char         *name;
      Sweeps              sweeps;
      bool                with_residual;
      std::vector<double> seconds;
    };
    std::vector<Row> rows;
    for (const bool backwards : {false, true})
      for (const unsigned int number : {1, 3})
        rows.push_back({backwards ? "backwards" : "forwards",
                        {number, backwards},
                        false,
                        std::vector<double>(n_columns, 1e300)});
    rows.push_back({"forwards, and residual",
                    {3, false},
                    true,
                    std::vector<double>(n_columns, 1e300)});

    // A large matrix is measured less often than a small one.
    const unsigned int n_times = 20 + 200000 / (A.n_blocks() / 100 + 1);
    for (unsigned int time = 0; time < n_times; ++time)
      for (Row &row : rows)
        for (unsigned int column = 0; column < n_columns; ++column)
          {
            Timer timer;
            sweep(column, row.sweeps, row.with_residual);
            row.seconds[column] =
              std::min(row.seconds[column], timer.wall_time());
          }

    // What a pass must read and write at least: blocks and column numbers, row
    // starts and inverse diagonals, right hand side, and the vector twice.
    const double bytes =
      A.n_blocks() * (dim * dim * sizeof(double) + sizeof(unsigned int)) +
      n * (sizeof(std::size_t) + (dim * dim + 3 * dim) * sizeof(double));
    const double triad = triad_bandwidth(), peak = peak_arithmetic();
    std::printf("scene %s, %u dofs, %.1f blocks per row, %.0f MB\n",
                parameters.name.c_str(),
                dim * n,
                1. * A.n_blocks() / n,
                1e-6 * bytes);
    std::printf(
      "triad %.1f GB/s, arithmetic %.1f Gflop/s\n", 1e-9 * triad, 1e-9 * peak);
    std::printf(
      "                             |   ns per node and sweep |       "
      "  |     last column\n"
      "sweeps                       |  plain  common   avx2   | faster "
      " | of triad  of peak\n");
    for (const Row &row : rows)
      {
        const unsigned int n_sweeps = row.sweeps.number + row.with_residual;
        std::printf("%u %-26s |", row.sweeps.number, row.name);
        for (const double seconds : row.seconds)
          std::printf(" %6.1f ", 1e9 * seconds / n_sweeps / n);
        for (unsigned int column = n_columns; column < 3; ++column)
          std::printf("      - ");
        const double best = row.seconds.back();
        std::printf("| %6.2f  | %6.0f%% %7.0f%%\n",
                    row.seconds.front() / best,
                    100. * bytes / best / triad,
                    100. * 2. * n_sweeps * (A.n_blocks() + n) * dim * dim /
                      best / peak);
      }
    std::printf("\n");
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

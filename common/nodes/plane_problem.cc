#include <common/nodes/dense_kernels.h>
#include <common/nodes/interface_damping.h>
#include <common/nodes/plane_problem.h>

#include <deal.II/base/exceptions.h>

#include <Eigen/Core>

#include <algorithm>
#include <utility>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    // In parts of the trace of a diagonal block: eigenvalues that count as
    // zero, and what is added to a diagonal if pivots are zero, because
    // truncated functions of several nodes have become dependent. Each addition
    // is a hundred times the one before, and no semidefinite matrix needs more
    // than the first few.
    constexpr double vanishing = 1e-10, first_shift = 1e-8, next_shift = 100,
                     largest_shift = 1e4;

    DeclExceptionMsg(ExcIndefinitePlane,
                     "The matrix of a plane of nodes is not positive "
                     "semidefinite.");
  } // namespace



  template <int dim>
  PlaneProblem<dim>::PlaneProblem(const NodeBlockMatrix<dim> &A,
                                  const std::vector<Node>    &nodes)
  {
    std::vector<char> is_kept, is_absent;
    for (const Node &node : nodes)
      {
        numbers.push_back(node.number);
        positions.push_back(node.position);
        is_held.insert(is_held.end(), node.is_held.begin(), node.is_held.end());
        traces.push_back(trace<dim>(A.diagonal(node.number)));
        is_kept.push_back(node.may_be_truncated);
        is_absent.push_back(std::all_of(node.is_held.begin(),
                                        node.is_held.end(),
                                        [](const bool held) { return held; }));
      }
    NodePattern               mine;
    std::vector<unsigned int> columns;
    for (const unsigned int i : numbers)
      {
        columns.clear();
        for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
          {
            const auto place =
              std::lower_bound(numbers.begin(), numbers.end(), A.column(e));
            if (place != numbers.end() && *place == A.column(e))
              columns.push_back(place - numbers.begin());
          }
        mine.append_row(columns);
      }
    pattern = std::make_shared<const NodePattern>(std::move(mine));
    tree    = std::make_unique<EliminationTree>(
      *pattern, positions, is_kept, is_absent);
    factors = std::make_unique<Condensation<dim>>(*tree, is_held);
  }



  template <int dim>
  NodeBlockMatrix<dim>
  PlaneProblem<dim>::matrix_of(const NodeBlockMatrix<dim> &A) const
  {
    NodeBlockMatrix<dim> matrix(pattern);
    for (unsigned int i = 0; i < numbers.size(); ++i)
      {
        for (std::size_t e = matrix.row_begin(i); e < matrix.row_end(i); ++e)
          matrix.set(
            i,
            e,
            A.value(numbers[i], A.find(numbers[i], numbers[matrix.column(e)])));
        double        *diagonal = matrix.diagonal(i);
        NodeBlock<dim> block, null_space;
        std::copy_n(diagonal, dim * dim, block.begin());
        pseudo_inverse<dim>(block, vanishing * traces[i], &null_space);
        const NodeBlock<dim> majorant = interface_majorant(A, numbers[i]);
        for (unsigned int e = 0; e < dim * dim; ++e)
          diagonal[e] += .5 * majorant[e] + stiffness(i) * null_space[e];
      }
    return matrix;
  }



  template <int dim>
  void
  PlaneProblem<dim>::factorise(const NodeBlockMatrix<dim> &A,
                               const bool                  keeps_copy)
  {
    NodeBlockMatrix<dim> matrix = matrix_of(A);
    if (copy.n_blocks() > 0 && matrix.has_values_of(copy))
      return;
    copy = keeps_copy ? matrix : NodeBlockMatrix<dim>();
    // What has been truncated was another matrix.
    projectors.clear();
    curvatures.clear();
    for (double shift = first_shift; !factors->factorize(matrix);
         shift *= next_shift)
      {
        AssertThrow(shift < largest_shift, ExcIndefinitePlane());
        for (unsigned int i = 0; i < numbers.size(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            matrix.diagonal(i)[d * dim + d] += shift * traces[i];
      }
  }



  template <int dim>
  void
  PlaneProblem<dim>::truncate(const Truncation<dim> &truncation)
  {
    const std::vector<unsigned int> &last = kept();
    const unsigned int               n    = dim * last.size();
    std::vector<NodeBlock<dim>>      new_projectors, new_curvatures;
    for (const unsigned int i : last)
      {
        new_projectors.push_back(truncation.projector(numbers[i]));
        new_curvatures.push_back(truncation.curvature(numbers[i]));
      }
    if (new_projectors == projectors && new_curvatures == curvatures)
      return;
    projectors = std::move(new_projectors);
    curvatures = std::move(new_curvatures);

    // A block $T_a(S_{ab}+\omega'')T_b$, which keeps what is held.
    const auto block = [&](const unsigned int a, const unsigned int b) {
      const unsigned int i = numbers[last[a]], j = numbers[last[b]];
      NodeBlock<dim>     result =
        truncation.linearized_block(i, factors->block(a, b).data(), j);
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int r = 0; r < dim; ++r)
          {
            double    &entry = result[c * dim + r];
            const bool is_mobile =
              !is_held[dim * last[a] + r] && !is_held[dim * last[b] + c];
            if (!is_mobile)
              entry = 0.;
            if (a == b)
              entry += stiffness(last[a]) *
                (is_mobile ? (r == c) - projectors[a][c * dim + r]
                           : double(r == c));
          }
      return result;
    };
    const auto fill = [&](const double shift) {
      dense_factor.assign(n * n, 0.);
      for (unsigned int b = 0; b < last.size(); ++b)
        for (unsigned int a = b; a < last.size(); ++a)
          {
            const NodeBlock<dim> entries = block(a, b);
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int r = 0; r < dim; ++r)
                dense_factor[(dim * b + c) * n + dim * a + r] =
                  entries[c * dim + r] +
                  (a == b && r == c ? shift * traces[last[a]] : 0.);
          }
    };
    fill(0.);
    for (double shift = first_shift;
         !DenseKernels::eliminate(dense_factor.data(), n, n);
         shift *= next_shift)
      {
        AssertThrow(shift < largest_shift, ExcIndefinitePlane());
        fill(shift);
      }
  }



  template <int dim>
  void
  PlaneProblem<dim>::solve(std::vector<double> &values) const
  {
    factors->reduce(values);
    if (!kept().empty())
      {
        Assert(projectors.size() == kept().size(), ExcInvalidState());
        solve_kept(values);
      }
    factors->expand(values);
    for (std::size_t dof = 0; dof < values.size(); ++dof)
      if (is_held[dof])
        values[dof] = 0.;
  }



  template <int dim>
  void
  PlaneProblem<dim>::solve_kept(std::vector<double> &values) const
  {
    const std::vector<unsigned int> &last    = kept();
    const auto                       project = [&](double *v) {
      for (unsigned int a = 0; a < last.size(); ++a)
        {
          const NodeValue<dim> projected =
            times<dim>(projectors[a].data(), v + dim * a);
          for (unsigned int d = 0; d < dim; ++d)
            v[dim * a + d] = is_held[dim * last[a] + d] ? 0. : projected[d];
        }
    };
    std::vector<double> y;
    for (const unsigned int i : last)
      y.insert(
        y.end(), values.begin() + dim * i, values.begin() + dim * (i + 1));
    project(y.data());
    const Eigen::Map<const Eigen::MatrixXd> L(
      dense_factor.data(), y.size(), y.size());
    Eigen::Map<Eigen::VectorXd> x(y.data(), y.size());
    L.triangularView<Eigen::Lower>().solveInPlace(x);
    L.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
    project(y.data());
    for (unsigned int a = 0; a < last.size(); ++a)
      std::copy_n(y.data() + dim * a, dim, values.begin() + dim * last[a]);
  }



  template <int dim>
  std::size_t
  PlaneProblem<dim>::memory_consumption() const
  {
    return factors->memory_consumption() +
      copy.n_blocks() * sizeof(NodeBlock<dim>) + pattern->memory_consumption() +
      (dense_factor.capacity() + traces.capacity()) * sizeof(double) +
      numbers.capacity() * (sizeof(unsigned int) + sizeof(positions[0])) +
      is_held.capacity();
  }



  template class PlaneProblem<2>;
  template class PlaneProblem<3>;
} // namespace Friction

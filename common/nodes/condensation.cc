#include <common/nodes/condensation.h>
#include <common/nodes/dense_kernels.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Friction
{
  // Of each front but the last one the columns of its own unknowns in the
  // Cholesky factor: a lower triangle, and below it the rows of the border.
  template <int dim>
  struct Condensation<dim>::Factors
  {
    std::vector<Eigen::MatrixXd> columns;
    Eigen::MatrixXd              kept; // S, its lower triangle
  };



  template <int dim>
  Condensation<dim>::Condensation(const EliminationTree   &tree,
                                  const std::vector<char> &is_held)
    : tree(tree)
    , is_held(is_held)
    , factors(std::make_unique<Factors>())
  {}



  template <int dim>
  Condensation<dim>::~Condensation() = default;



  template <int dim>
  bool
  Condensation<dim>::factorize(const NodeBlockMatrix<dim> &matrix)
  {
    const auto                  &fronts = tree.fronts();
    std::vector<Eigen::MatrixXd> borders(fronts.size());
    std::vector<unsigned int>    place(matrix.n_rows());
    factors->columns.assign(fronts.size(), {});
    // Pivots that are smaller than this, in parts of the diagonal entry of the
    // matrix, are rounding errors: nothing holds the body. Each elimination may
    // leave one.
    const double rounding = std::max(
      1e-14, std::numeric_limits<double>::epsilon() * dim * matrix.n_rows());

    for (std::size_t f = 0; f < fronts.size(); ++f)
      {
        const EliminationTree::Front &front = fronts[f];
        const unsigned int            n_own = dim * front.nodes.size(),
                           n                = n_own + dim * front.border.size();
        for (unsigned int k = 0; k < front.nodes.size(); ++k)
          place[front.nodes[k]] = dim * k;
        for (unsigned int k = 0; k < front.border.size(); ++k)
          place[front.border[k]] = n_own + dim * k;

        // Its own columns of the matrix: blocks of the lower triangle, and of
        // diagonal blocks all.
        Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n);
        for (unsigned int k = 0; k < front.nodes.size(); ++k)
          {
            const unsigned int i = front.nodes[k];
            for (std::size_t e = matrix.row_begin(i); e < matrix.row_end(i);
                 ++e)
              {
                const unsigned int j = matrix.column(e);
                // Of a node that has been eliminated before, or is absent, the
                // place is that in another front.
                const unsigned int at = place[j];
                const bool is_own    = at < n_own && front.nodes[at / dim] == j,
                           is_border = at >= n_own && at < n &&
                  front.border[(at - n_own) / dim] == j;
                if (!is_own && !is_border)
                  continue;
                const NodeBlock<dim> block = matrix.value(i, e);
                for (unsigned int c = 0; c < dim; ++c)
                  for (unsigned int r = 0; r < dim; ++r)
                    if (!is_held[dim * i + r] && !is_held[dim * j + c])
                      F(at + c, dim * k + r) = block[c * dim + r];
              }
            const double *diagonal = matrix.diagonal(i);
            for (unsigned int d = 0; d < dim; ++d)
              if (is_held[dim * i + d])
                F(dim * k + d, dim * k + d) = trace<dim>(diagonal) / dim;
          }
        const Eigen::VectorXd diagonal = F.diagonal().head(n_own);
        for (const unsigned int child : front.children)
          {
            const std::vector<unsigned int> &border = fronts[child].border;
            const Eigen::MatrixXd           &S      = borders[child];
            for (unsigned int b = 0; b < border.size(); ++b)
              for (unsigned int a = b; a < border.size(); ++a)
                // The order of both is that of elimination.
                F.template block<dim, dim>(place[border[a]],
                                           place[border[b]]) +=
                  S.template block<dim, dim>(dim * a, dim * b);
            borders[child].resize(0, 0);
          }

        if (f + 1 == fronts.size())
          {
            factors->kept = std::move(F);
            break;
          }
        if (!DenseKernels::eliminate(F.data(), n, n_own) ||
            (F.diagonal().head(n_own).array().square() <
             rounding * diagonal.array())
              .any())
          return false;
        borders[f]          = F.bottomRightCorner(n - n_own, n - n_own);
        factors->columns[f] = F.leftCols(n_own);
      }
    return true;
  }



  template <int dim>
  NodeBlock<dim>
  Condensation<dim>::block(const unsigned int i, const unsigned int j) const
  {
    NodeBlock<dim> result;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int r = 0; r < dim; ++r)
        {
          const unsigned int a = dim * i + r, b = dim * j + c;
          result[c * dim + r] = factors->kept(std::max(a, b), std::min(a, b));
        }
    return result;
  }



  template <int dim>
  void
  Condensation<dim>::reduce(std::vector<double> &f) const
  {
    const auto     &fronts = tree.fronts();
    Eigen::VectorXd own, below;
    for (std::size_t k = 0; k + 1 < fronts.size(); ++k)
      {
        const EliminationTree::Front &front = fronts[k];
        const Eigen::MatrixXd        &L     = factors->columns[k];
        const unsigned int            n_own = dim * front.nodes.size();
        own.resize(n_own);
        for (unsigned int i = 0; i < n_own; ++i)
          {
            const unsigned int dof = dim * front.nodes[i / dim] + i % dim;
            own[i]                 = is_held[dof] ? 0. : f[dof];
          }
        L.topRows(n_own).template triangularView<Eigen::Lower>().solveInPlace(
          own);
        for (unsigned int i = 0; i < n_own; ++i)
          f[dim * front.nodes[i / dim] + i % dim] = own[i];
        below.noalias() = L.bottomRows(L.rows() - n_own) * own;
        for (unsigned int i = 0; i < below.size(); ++i)
          f[dim * front.border[i / dim] + i % dim] -= below[i];
      }
  }



  template <int dim>
  void
  Condensation<dim>::expand(std::vector<double> &u) const
  {
    const auto     &fronts = tree.fronts();
    Eigen::VectorXd own, below;
    for (std::size_t k = fronts.size() - 1; k-- > 0;)
      {
        const EliminationTree::Front &front = fronts[k];
        const Eigen::MatrixXd        &L     = factors->columns[k];
        const unsigned int            n_own = dim * front.nodes.size();
        own.resize(n_own);
        below.resize(L.rows() - n_own);
        for (unsigned int i = 0; i < n_own; ++i)
          own[i] = u[dim * front.nodes[i / dim] + i % dim];
        for (unsigned int i = 0; i < below.size(); ++i)
          below[i] = u[dim * front.border[i / dim] + i % dim];
        own.noalias() -= L.bottomRows(L.rows() - n_own).transpose() * below;
        L.topRows(n_own)
          .transpose()
          .template triangularView<Eigen::Upper>()
          .solveInPlace(own);
        for (unsigned int i = 0; i < n_own; ++i)
          u[dim * front.nodes[i / dim] + i % dim] = own[i];
      }
  }



  template <int dim>
  std::size_t
  Condensation<dim>::memory_consumption() const
  {
    std::size_t n = factors->kept.size();
    for (const Eigen::MatrixXd &L : factors->columns)
      n += L.size();
    return n * sizeof(double);
  }



  template class Condensation<2>;
  template class Condensation<3>;
} // namespace Friction

#include <common/dense_algebra.h>
#include <common/levels/aggregate_levels.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace Friction
{
  namespace
  {
    // Couplings are strong above this part of the geometric mean of the
    // diagonal blocks, and half of it on each coarser level.
    constexpr double strong = .04;

    // Relaxation of the levels, before and after the next coarser one.
    constexpr unsigned int n_sweeps = 2;

    // Levels with that many nodes are solved.
    constexpr unsigned int coarsest_size = 12, most_levels = 10;

    // Directions with less than that part of their share of the diagonal are
    // none.
    constexpr double relative_cut = 1e-10;



    // out += a b, with R rows, K columns of a, and C columns of b.
    template <int R, int K, int C>
    inline DEAL_II_ALWAYS_INLINE void
    add_product(double *out, const double *a, const double *b)
    {
      for (int c = 0; c < C; ++c)
        for (int k = 0; k < K; ++k)
          for (int r = 0; r < R; ++r)
            out[c * R + r] += a[k * R + r] * b[c * K + k];
    }

    // out += a^T b, where a has K rows and R columns.
    template <int R, int K, int C>
    inline DEAL_II_ALWAYS_INLINE void
    add_transposed_product(double *out, const double *a, const double *b)
    {
      for (int c = 0; c < C; ++c)
        for (int r = 0; r < R; ++r)
          {
            double sum = 0;
            for (int k = 0; k < K; ++k)
              sum += a[r * K + k] * b[c * K + k];
            out[c * R + r] += sum;
          }
    }

    double
    frobenius(const double *block, const int size)
    {
      double sum = 0;
      for (int i = 0; i < size; ++i)
        sum += block[i] * block[i];
      return std::sqrt(sum);
    }



    // Rows of the leaf matrix, truncated, and of that of a level.
    template <int dim>
    struct LeafRows
    {
      static constexpr int n = dim;

      const NodeBlockMatrix<dim> &matrix;
      const Truncation<dim>      &truncation;

      unsigned int
      n_rows() const
      {
        return matrix.n_rows();
      }

      template <typename Visitor>
      void
      visit(const unsigned int i, const Visitor &visitor) const
      {
        for (std::size_t e = matrix.row_begin(i); e < matrix.row_end(i); ++e)
          {
            const unsigned int j = matrix.column(e);
            if (j >= matrix.n_rows())
              continue;
            if (truncation.is_identity(i) && truncation.is_identity(j))
              {
                visitor(j, matrix.value(i, e).data());
                continue;
              }
            visitor(j,
                    truncation.linearized_block(i, matrix.value(i, e).data(), j)
                      .data());
          }
      }
    };

    template <int m>
    struct LevelRows
    {
      static constexpr int n = m;

      const BlockRowMatrix<m, m> &matrix;

      unsigned int
      n_rows() const
      {
        return matrix.n_rows();
      }

      template <typename Visitor>
      void
      visit(const unsigned int i, const Visitor &visitor) const
      {
        for (std::size_t e = matrix.starts[i]; e < matrix.starts[i + 1]; ++e)
          visitor(matrix.columns[e], matrix.block(e));
      }
    };



    // The pseudo-inverse of a symmetric positive semidefinite matrix, scaled so
    // that translations and rotations, stiff parts and soft ones are the same.
    // One function for blocks and whole matrices: for each size of its own the
    // compiler would take ten seconds, and a block's eigenvalues take longer
    // than its memory.
    Eigen::MatrixXd
    scaled_pseudo_inverse(Eigen::MatrixXd a)
    {
      const int           n = a.rows();
      std::vector<double> s(n);
      for (int i = 0; i < n; ++i)
        s[i] = a(i, i) > 0 ? 1. / std::sqrt(a(i, i)) : 0.;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          a(i, j) *= s[i] * s[j];
      const Eigenpairs eigen = eigenpairs(a);
      a.setZero();
      for (int k = 0; k < n; ++k)
        if (eigen.values[k] > relative_cut)
          for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
              a(i, j) +=
                eigen.vectors(i, k) * eigen.vectors(j, k) / eigen.values[k];
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          a(i, j) *= s[i] * s[j];
      return a;
    }

    template <int n>
    std::array<double, n * n>
    inverse_block(const double *block)
    {
      const Eigen::MatrixXd inverse =
        scaled_pseudo_inverse(Eigen::Map<const Eigen::MatrixXd>(block, n, n));
      std::array<double, n * n> result;
      std::copy_n(inverse.data(), n * n, result.begin());
      return result;
    }



    // Where a level's nodes are, and the length that makes an angle a
    // displacement.
    template <int dim>
    struct Geometry
    {
      std::vector<Point<dim>> positions;
      double                  length = 1.;
    };

    // The motion at a node of n unknowns that is the motion of its group.
    template <int dim, int n>
    std::array<double, n *(dim *(dim + 1) / 2)>
    rigid_motions(const Tensor<1, dim> &d,
                  const double          length,
                  const double          finer_length)
    {
      constexpr int              m = dim * (dim + 1) / 2;
      std::array<double, n *(m)> block{};
      for (int c = 0; c < dim; ++c)
        block[c * n + c] = 1.;
      if constexpr (dim == 2)
        {
          block[2 * n]     = -d[1] / length;
          block[2 * n + 1] = d[0] / length;
        }
      else
        for (int a = 0; a < dim; ++a)
          {
            const int b = (a + 1) % dim, c = (a + 2) % dim;
            block[(dim + a) * n + b] = -d[c] / length;
            block[(dim + a) * n + c] = d[b] / length;
          }
      for (int a = dim; a < n; ++a)
        block[a * n + a] = finer_length / length;
      return block;
    }



    template <typename Rows>
    StrongCouplings
    strong_couplings(const Rows &rows, const double threshold)
    {
      constexpr int       size = Rows::n * Rows::n;
      std::vector<double> diagonal(rows.n_rows());
      for (unsigned int i = 0; i < rows.n_rows(); ++i)
        rows.visit(i, [&](const unsigned int j, const double *block) {
          if (i == j)
            diagonal[i] = frobenius(block, size);
        });
      StrongCouplings result;
      for (unsigned int i = 0; i < rows.n_rows(); ++i)
        {
          rows.visit(i, [&](const unsigned int j, const double *block) {
            if (i != j &&
                frobenius(block, size) >
                  threshold * std::sqrt(diagonal[i] * diagonal[j]))
              result.neighbours.push_back(j);
          });
          result.starts.push_back(result.neighbours.size());
        }
      return result;
    }



    // The largest eigenvalue of D^{-1} A, nearly.
    template <typename Rows, typename Inverses>
    double
    largest_eigenvalue(const Rows &rows, const Inverses &inverses)
    {
      constexpr int       n = Rows::n;
      std::vector<double> x(n * rows.n_rows()), y(x.size());
      std::mt19937        random(1);
      for (double &value : x)
        value = random() / 4294967296. - .5;
      double lambda = 0;
      for (unsigned int step = 0; step < 10; ++step)
        {
          double square = 0;
          for (unsigned int i = 0; i < rows.n_rows(); ++i)
            {
              std::array<double, n> sum{};
              rows.visit(i, [&](const unsigned int j, const double *block) {
                add_product<n, n, 1>(sum.data(), block, x.data() + n * j);
              });
              std::fill_n(y.begin() + n * i, n, 0.);
              add_product<n, n, 1>(
                y.data() + n * i, inverses[i].data(), sum.data());
            }
          for (const double value : y)
            square += value * value;
          lambda = std::sqrt(square);
          if (lambda == 0)
            return 1.;
          for (std::size_t k = 0; k < x.size(); ++k)
            x[k] = y[k] / lambda;
        }
      return lambda;
    }



    // P of one level, and where the nodes of the next one are.
    template <int dim, typename Rows, typename Prolongation>
    void
    make_prolongation(Prolongation        &P,
                      const Rows          &rows,
                      const Geometry<dim> &finer,
                      const double         threshold,
                      Geometry<dim>       &coarse)
    {
      constexpr int     n = Rows::n, m = dim * (dim + 1) / 2;
      const Aggregation groups = aggregate(strong_couplings(rows, threshold));

      coarse.positions.assign(groups.n_groups, Point<dim>());
      std::vector<unsigned int> n_members(groups.n_groups);
      for (unsigned int i = 0; i < rows.n_rows(); ++i)
        if (groups.group_of[i] != Aggregation::none)
          {
            coarse.positions[groups.group_of[i]] += finer.positions[i];
            ++n_members[groups.group_of[i]];
          }
      for (unsigned int g = 0; g < groups.n_groups; ++g)
        coarse.positions[g] /= n_members[g];
      double       squares = 0;
      unsigned int count   = 0;
      for (unsigned int i = 0; i < rows.n_rows(); ++i)
        if (groups.group_of[i] != Aggregation::none)
          {
            squares +=
              (finer.positions[i] - coarse.positions[groups.group_of[i]])
                .norm_square();
            ++count;
          }
      coarse.length = squares > 0 ? std::sqrt(squares / count) : finer.length;

      using Diagonal = std::array<double, n * n>;
      using Motions  = std::array<double, n * m>;
      std::vector<Diagonal> inverses(rows.n_rows());
      for (unsigned int i = 0; i < rows.n_rows(); ++i)
        rows.visit(i, [&](const unsigned int j, const double *block) {
          if (i == j)
            inverses[i] = inverse_block<n>(block);
        });
      const double omega = 4. / 3 / (1.1 * largest_eigenvalue(rows, inverses));

      const auto motions = [&](const unsigned int j) {
        const unsigned int g = groups.group_of[j];
        return rigid_motions<dim, n>(finer.positions[j] - coarse.positions[g],
                                     coarse.length,
                                     finer.length);
      };
      std::vector<Motions> hat(rows.n_rows());
      for (unsigned int i = 0; i < rows.n_rows(); ++i)
        if (groups.group_of[i] != Aggregation::none)
          hat[i] = motions(i);

      std::vector<unsigned int> slot(groups.n_groups, Aggregation::none);
      std::vector<unsigned int> columns;
      std::vector<Motions>      sums;
      for (unsigned int i = 0; i < rows.n_rows(); ++i)
        {
          columns.clear();
          sums.clear();
          bool       is_free = false;
          const auto sum_of  = [&](const unsigned int g) -> Motions  &{
            if (slot[g] == Aggregation::none)
              {
                slot[g] = columns.size();
                columns.push_back(g);
                sums.emplace_back();
                sums.back().fill(0.);
              }
            return sums[slot[g]];
          };
          for (const double value : inverses[i])
            is_free = is_free || value != 0;
          if (is_free)
            {
              if (groups.group_of[i] != Aggregation::none)
                sum_of(groups.group_of[i]);
              rows.visit(i, [&](const unsigned int j, const double *block) {
                if (groups.group_of[j] != Aggregation::none)
                  add_product<n, n, m>(
                    sum_of(groups.group_of[j]).data(), block, hat[j].data());
              });
            }
          for (unsigned int c = 0; c < columns.size(); ++c)
            {
              Motions block{};
              add_product<n, n, m>(
                block.data(), inverses[i].data(), sums[c].data());
              for (double &value : block)
                value *= -omega;
              if (columns[c] == groups.group_of[i])
                for (int k = 0; k < n * m; ++k)
                  block[k] += hat[i][k];
              P.rows.columns.push_back(columns[c]);
              P.rows.values.insert(
                P.rows.values.end(), block.begin(), block.end());
            }
          for (const unsigned int g : columns)
            slot[g] = Aggregation::none;
          P.rows.starts.push_back(P.rows.columns.size());
        }

      P.starts.assign(groups.n_groups + 1, 0);
      for (const unsigned int g : P.rows.columns)
        ++P.starts[g + 1];
      for (unsigned int g = 0; g < groups.n_groups; ++g)
        P.starts[g + 1] += P.starts[g];
      P.entries.resize(P.rows.columns.size());
      std::vector<std::size_t> next(P.starts.begin(), P.starts.end() - 1);
      for (unsigned int i = 0; i < rows.n_rows(); ++i)
        for (std::size_t e = P.rows.starts[i]; e < P.rows.starts[i + 1]; ++e)
          P.entries[next[P.rows.columns[e]]++] = {i, e};
    }



    // Which blocks P^T A P has.
    template <int m, typename Rows, typename Prolongation>
    void
    make_pattern(BlockRowMatrix<m, m> &product,
                 const Rows           &rows,
                 const Prolongation   &P)
    {
      const unsigned int        n_coarse = P.starts.size() - 1;
      std::vector<unsigned int> last(n_coarse, Aggregation::none);
      std::vector<std::size_t>  starts = {0};
      std::vector<unsigned int> columns;
      for (unsigned int i = 0; i < rows.n_rows(); ++i)
        {
          if (P.rows.starts[i] < P.rows.starts[i + 1])
            rows.visit(i, [&](const unsigned int j, const double *) {
              for (std::size_t e = P.rows.starts[j]; e < P.rows.starts[j + 1];
                   ++e)
                if (last[P.rows.columns[e]] != i)
                  {
                    last[P.rows.columns[e]] = i;
                    columns.push_back(P.rows.columns[e]);
                  }
            });
          starts.push_back(columns.size());
        }
      last.assign(n_coarse, Aggregation::none);
      for (unsigned int I = 0; I < n_coarse; ++I)
        {
          last[I] = I;
          product.columns.push_back(I);
          for (std::size_t e = P.starts[I]; e < P.starts[I + 1]; ++e)
            {
              const unsigned int i = P.entries[e].first;
              for (std::size_t f = starts[i]; f < starts[i + 1]; ++f)
                if (last[columns[f]] != I)
                  {
                    last[columns[f]] = I;
                    product.columns.push_back(columns[f]);
                  }
            }
          // The diagonal first, the others in order.
          std::sort(product.columns.begin() + product.starts.back() + 1,
                    product.columns.end());
          product.starts.push_back(product.columns.size());
        }
      product.values.assign(product.columns.size() * m * m, 0.);
    }



    // The rows of P^T A P that depend on some rows of A, computed anew. Returns
    // which.
    template <int m, typename Rows, typename Prolongation>
    std::vector<unsigned int>
    update_product(BlockRowMatrix<m, m>            &product,
                   const Rows                      &rows,
                   const Prolongation              &P,
                   const std::vector<unsigned int> &changed)
    {
      constexpr int             n = Rows::n;
      std::vector<char>         is_affected(product.n_rows(), false);
      std::vector<unsigned int> affected;
      const auto                mark = [&](const unsigned int i) {
        for (std::size_t e = P.rows.starts[i]; e < P.rows.starts[i + 1]; ++e)
          if (!is_affected[P.rows.columns[e]])
            {
              is_affected[P.rows.columns[e]] = true;
              affected.push_back(P.rows.columns[e]);
            }
      };
      for (const unsigned int i : changed)
        rows.visit(i, [&](const unsigned int j, const double *) { mark(j); });

      // A P, in those rows that are needed.
      using Motions = std::array<double, n * m>;
      std::vector<std::size_t>  first(rows.n_rows(), ~std::size_t(0));
      std::vector<std::size_t>  end(rows.n_rows());
      std::vector<unsigned int> columns;
      std::vector<Motions>      sums;
      std::vector<std::size_t>  slot(product.n_rows(), ~std::size_t(0));
      for (const unsigned int I : affected)
        for (std::size_t e = P.starts[I]; e < P.starts[I + 1]; ++e)
          {
            const unsigned int i = P.entries[e].first;
            if (first[i] != ~std::size_t(0))
              continue;
            first[i] = columns.size();
            rows.visit(i, [&](const unsigned int j, const double *block) {
              for (std::size_t f = P.rows.starts[j]; f < P.rows.starts[j + 1];
                   ++f)
                {
                  const unsigned int J = P.rows.columns[f];
                  if (slot[J] == ~std::size_t(0))
                    {
                      slot[J] = columns.size();
                      columns.push_back(J);
                      sums.emplace_back();
                    }
                  add_product<n, n, m>(
                    sums[slot[J]].data(), block, P.rows.block(f));
                }
            });
            end[i] = columns.size();
            for (std::size_t s = first[i]; s < end[i]; ++s)
              slot[columns[s]] = ~std::size_t(0);
          }

      for (const unsigned int I : affected)
        {
          for (std::size_t e = product.starts[I]; e < product.starts[I + 1];
               ++e)
            slot[product.columns[e]] = e;
          std::fill(product.block(product.starts[I]),
                    product.block(product.starts[I + 1]),
                    0.);
          for (std::size_t e = P.starts[I]; e < P.starts[I + 1]; ++e)
            {
              const unsigned int i = P.entries[e].first;
              const double      *p = P.rows.block(P.entries[e].second);
              for (std::size_t s = first[i]; s < end[i]; ++s)
                add_transposed_product<m, n, m>(
                  product.block(slot[columns[s]]), p, sums[s].data());
            }
          for (std::size_t e = product.starts[I]; e < product.starts[I + 1];
               ++e)
            slot[product.columns[e]] = ~std::size_t(0);
        }
      return affected;
    }



    template <int n, typename Prolongation>
    void
    restrict_to(std::vector<double> &coarse,
                const Prolongation  &P,
                const double        *fine)
    {
      constexpr int m = Prolongation::n_columns;
      std::fill(coarse.begin(), coarse.end(), 0.);
      for (unsigned int i = 0; i < P.rows.n_rows(); ++i)
        for (std::size_t e = P.rows.starts[i]; e < P.rows.starts[i + 1]; ++e)
          add_transposed_product<m, n, 1>(coarse.data() + m * P.rows.columns[e],
                                          P.rows.block(e),
                                          fine + n * i);
    }

    template <int n, typename Prolongation>
    void
    prolongate_and_add(double             *fine,
                       const Prolongation &P,
                       const double       *coarse)
    {
      constexpr int m = Prolongation::n_columns;
      for (unsigned int i = 0; i < P.rows.n_rows(); ++i)
        for (std::size_t e = P.rows.starts[i]; e < P.rows.starts[i + 1]; ++e)
          add_product<n, m, 1>(
            fine + n * i, P.rows.block(e), coarse + m * P.rows.columns[e]);
    }
  } // namespace



  template <int dim>
  std::vector<Point<dim>>
  node_positions(const DoFHandler<dim>       &dof_handler,
                 const NodalConstraints<dim> &constraints)
  {
    std::vector<Point<dim>> positions(constraints.n_owned_nodes());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int v : cell->vertex_indices())
          if (constraints.partitioner()->in_local_range(
                cell->vertex_dof_index(v, 0)))
            positions[constraints.node_of_dof(cell->vertex_dof_index(v, 0))] =
              cell->vertex(v);
    return positions;
  }



  template <int dim>
  bool
  materials_jump(const NodeBlockMatrix<dim> &matrix,
                 const MPI_Comm              communicator)
  {
    constexpr double large     = 30;
    const auto       stiffness = [&](const unsigned int i) {
      return trace<dim>(matrix.diagonal(i));
    };
    // Each node and the next one in its row: chains of these lead out of every
    // part of the body.
    bool jumps = false;
    for (unsigned int i = 0; i < matrix.n_rows() && !jumps; ++i)
      if (matrix.row_begin(i) + 1 < matrix.row_end(i))
        {
          const unsigned int j = matrix.column(matrix.row_begin(i) + 1);
          if (j >= matrix.n_rows())
            continue;
          const double a = stiffness(i), b = stiffness(j);
          jumps = a > large * b || b > large * a;
        }
    return true_on_any_process(jumps, communicator);
  }



  template <int dim>
  AggregateLevels<dim>::AggregateLevels(
    const NodeBlockMatrix<dim>    &leaf_matrix,
    const NodalConstraints<dim>   &constraints,
    const std::vector<Point<dim>> &positions)
    : leaf_matrix(leaf_matrix)
    , truncation(constraints)
  {
    const LeafRows<dim> leaf = {leaf_matrix, truncation};
    Geometry<dim>       finer, coarse;
    finer.positions  = positions;
    double threshold = strong;
    make_prolongation(leaf_prolongation, leaf, finer, threshold, coarse);
    const auto add_level = [&](const auto &rows, const auto &P) {
      levels.emplace_back();
      Level &level = levels.back();
      make_pattern(level.matrix, rows, P);
      std::vector<unsigned int> all(rows.n_rows());
      for (unsigned int i = 0; i < rows.n_rows(); ++i)
        all[i] = i;
      update_product(level.matrix, rows, P, all);
      level.inverses.resize(level.matrix.n_rows());
      for (unsigned int i = 0; i < level.matrix.n_rows(); ++i)
        compute_inverse(level, i);
      for (auto *v : {&level.rhs, &level.correction, &level.defect})
        v->resize(n_motions * level.matrix.n_rows());
    };
    levels.reserve(most_levels);
    add_level(leaf, leaf_prolongation);
    while (levels.size() < most_levels &&
           levels.back().matrix.n_rows() > coarsest_size)
      {
        finer = coarse;
        threshold *= .5;
        const LevelRows<n_motions> rows = {levels.back().matrix};
        Prolongation<n_motions>    P;
        make_prolongation(P, rows, finer, threshold, coarse);
        // No strong couplings are left.
        if (coarse.positions.empty() ||
            2 * coarse.positions.size() > rows.n_rows())
          break;
        levels.back().prolongation = std::move(P);
        add_level(rows, levels.back().prolongation);
      }
    invert_coarsest();
  }



  template <int dim>
  std::size_t
  AggregateLevels<dim>::update(const Truncation<dim> &wanted)
  {
    std::vector<unsigned int> changed = truncation.differences(wanted);
    changed.erase(
      std::lower_bound(changed.begin(), changed.end(), leaf_matrix.n_rows()),
      changed.end());
    if (changed.empty())
      return 0;
    truncation         = wanted;
    std::size_t n_rows = 0;
    for (unsigned int k = 0; k < levels.size(); ++k)
      {
        if (k == 0)
          changed = update_product(levels[k].matrix,
                                   LeafRows<dim>{leaf_matrix, truncation},
                                   leaf_prolongation,
                                   changed);
        else
          changed = update_product(levels[k].matrix,
                                   LevelRows<n_motions>{levels[k - 1].matrix},
                                   levels[k - 1].prolongation,
                                   changed);
        for (const unsigned int row : changed)
          compute_inverse(levels[k], row);
        n_rows += changed.size();
      }
    invert_coarsest();
    return n_rows;
  }



  template <int dim>
  void
  AggregateLevels<dim>::compute_inverse(Level &level, const unsigned int row)
  {
    level.inverses[row] =
      inverse_block<n_motions>(level.matrix.block(level.matrix.starts[row]));
  }



  template <int dim>
  void
  AggregateLevels<dim>::invert_coarsest()
  {
    const auto        &matrix = levels.back().matrix;
    const unsigned int size   = n_motions * matrix.n_rows();
    // None, if a process has nothing, or too much, since no couplings are
    // strong.
    if (size == 0 || matrix.n_rows() > 2 * coarsest_size)
      {
        coarsest_inverse.clear();
        return;
      }
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
    for (unsigned int i = 0; i < matrix.n_rows(); ++i)
      for (std::size_t e = matrix.starts[i]; e < matrix.starts[i + 1]; ++e)
        for (int c = 0; c < n_motions; ++c)
          for (int r = 0; r < n_motions; ++r)
            dense(n_motions * i + r, n_motions * matrix.columns[e] + c) =
              matrix.block(e)[c * n_motions + r];
    dense = scaled_pseudo_inverse(dense);
    coarsest_inverse.assign(dense.data(), dense.data() + size * size);
  }



  template <int dim>
  void
  AggregateLevels<dim>::relax(Level &level, const bool backwards)
  {
    const auto        &A = level.matrix;
    const unsigned int n = A.n_rows();
    for (unsigned int sweep = 0; sweep < n_sweeps; ++sweep)
      for (unsigned int k = 0; k < n; ++k)
        {
          const unsigned int i = backwards ? n - 1 - k : k;
          // What the others leave of the right hand side.
          std::array<double, n_motions> sum{};
          for (std::size_t e = A.starts[i] + 1; e < A.starts[i + 1]; ++e)
            add_product<n_motions, n_motions, 1>(sum.data(),
                                                 A.block(e),
                                                 level.correction.data() +
                                                   n_motions * A.columns[e]);
          for (int c = 0; c < n_motions; ++c)
            sum[c] = level.rhs[n_motions * i + c] - sum[c];
          std::fill_n(level.correction.begin() + n_motions * i, n_motions, 0.);
          add_product<n_motions, n_motions, 1>(level.correction.data() +
                                                 n_motions * i,
                                               level.inverses[i].data(),
                                               sum.data());
        }
  }



  template <int dim>
  void
  AggregateLevels<dim>::visit(const unsigned int k)
  {
    Level &level = levels[k];
    std::fill(level.correction.begin(), level.correction.end(), 0.);
    if (k + 1 == levels.size() && !coarsest_inverse.empty())
      {
        const std::size_t size = level.rhs.size();
        for (std::size_t c = 0; c < size; ++c)
          for (std::size_t r = 0; r < size; ++r)
            level.correction[r] +=
              coarsest_inverse[c * size + r] * level.rhs[c];
        return;
      }
    relax(level, false);
    if (k + 1 < levels.size())
      {
        vmult(k, level.defect.data(), level.correction.data());
        for (std::size_t i = 0; i < level.rhs.size(); ++i)
          level.defect[i] = level.rhs[i] - level.defect[i];
        restrict_to<n_motions>(
          levels[k + 1].rhs, level.prolongation, level.defect.data());
        visit(k + 1);
        prolongate_and_add<n_motions>(level.correction.data(),
                                      level.prolongation,
                                      levels[k + 1].correction.data());
      }
    relax(level, true);
  }



  template <int dim>
  void
  AggregateLevels<dim>::apply(double *v, const double *r)
  {
    std::fill_n(v, dim * leaf_matrix.n_rows(), 0.);
    if (n_nodes(0) == 0)
      return;
    restrict_to<dim>(levels[0].rhs, leaf_prolongation, r);
    visit(0);
    prolongate_and_add<dim>(v, leaf_prolongation, levels[0].correction.data());
    truncation.apply(v);
  }



  template <int dim>
  void
  AggregateLevels<dim>::prolongate(const unsigned int k,
                                   double            *fine,
                                   const double      *coarse) const
  {
    if (k == 0)
      {
        std::fill_n(fine, dim * leaf_matrix.n_rows(), 0.);
        prolongate_and_add<dim>(fine, leaf_prolongation, coarse);
      }
    else
      {
        std::fill_n(fine, n_motions * n_nodes(k - 1), 0.);
        prolongate_and_add<n_motions>(fine, levels[k - 1].prolongation, coarse);
      }
  }



  template <int dim>
  void
  AggregateLevels<dim>::vmult(const unsigned int k,
                              double            *y,
                              const double      *x) const
  {
    const auto &A = levels[k].matrix;
    std::fill_n(y, n_motions * A.n_rows(), 0.);
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      for (std::size_t e = A.starts[i]; e < A.starts[i + 1]; ++e)
        add_product<n_motions, n_motions, 1>(
          y + n_motions * i, A.block(e), x + n_motions * A.columns[e]);
  }



  template <int dim>
  std::size_t
  AggregateLevels<dim>::memory_consumption() const
  {
    const auto of = [](const auto &P) {
      return P.rows.memory_consumption() +
        P.starts.capacity() * sizeof(std::size_t) +
        P.entries.capacity() * sizeof(P.entries[0]);
    };
    std::size_t bytes =
      of(leaf_prolongation) + coarsest_inverse.capacity() * sizeof(double);
    for (const Level &level : levels)
      bytes += level.matrix.memory_consumption() + of(level.prolongation) +
        level.inverses.capacity() * sizeof(Block) +
        (level.rhs.capacity() + level.correction.capacity() +
         level.defect.capacity()) *
          sizeof(double);
    return bytes;
  }



  template std::vector<Point<2>> node_positions(const DoFHandler<2> &,
                                                const NodalConstraints<2> &);
  template std::vector<Point<3>> node_positions(const DoFHandler<3> &,
                                                const NodalConstraints<3> &);

  template bool materials_jump(const NodeBlockMatrix<2> &, const MPI_Comm);
  template bool materials_jump(const NodeBlockMatrix<3> &, const MPI_Comm);

  template class AggregateLevels<2>;
  template class AggregateLevels<3>;
} // namespace Friction

#include <tests/benchmarks/baselines/stiffness_factor.h>

#include <cholmod.h>

#include <algorithm>
#include <string>

extern "C"
{
  void dgetrf_(const int *m,
               const int *n,
               double    *a,
               const int *lda,
               int       *pivots,
               int       *info);
  void dgetrs_(const char   *transposed,
               const int    *n,
               const int    *n_right_hand_sides,
               const double *a,
               const int    *lda,
               const int    *pivots,
               double       *b,
               const int    *ldb,
               int          *info);
  void
  dlauum_(const char *part, const int *n, double *a, const int *lda, int *info);
  // Only OpenBLAS has it.
  void openblas_set_num_threads(int) __attribute__((weak));
}

namespace Benchmark
{
  void
  solve_dense(DenseMatrix &A, std::vector<double> &b)
  {
    const int        n = A.n, one = 1;
    int              info = 0;
    std::vector<int> pivots(n);
    if (n == 0)
      return;
    dgetrf_(&n, &n, A.values.data(), &n, pivots.data(), &info);
    AssertThrow(info == 0,
                ExcMessage("A matrix of Newton's method is singular."));
    dgetrs_(
      "N", &n, &one, A.values.data(), &n, pivots.data(), b.data(), &n, &info);
  }



  template <int dim>
  struct StiffnessFactor<dim>::Cholmod
  {
    Cholmod()
    {
      if (openblas_set_num_threads != nullptr)
        openblas_set_num_threads(1);
      cholmod_l_start(&common);
      common.print      = 0;
      common.supernodal = CHOLMOD_SUPERNODAL;
    }

    ~Cholmod()
    {
      if (factor != nullptr)
        cholmod_l_free_factor(&factor, &common);
      if (right_hand_side != nullptr)
        cholmod_l_free_dense(&right_hand_side, &common);
      cholmod_l_finish(&common);
    }

    void
    check(const bool success, const std::string &what)
    {
      AssertThrow(success && common.status >= CHOLMOD_OK,
                  ExcMessage("CHOLMOD could not " + what + "."));
      AssertThrow(common.status != CHOLMOD_NOT_POSDEF,
                  ExcMessage("The stiffness matrix is not positive definite: "
                             "without contact the body could move freely, "
                             "which a direct solver cannot cope with."));
    }

    // Calls f(i,j,l) for the entries l of the factor's dense block L_cc, by
    // positions in that block.
    template <typename Function>
    void
    for_each_dense_entry(const Function &f) const
    {
      const auto *super  = static_cast<const SuiteSparse_long *>(factor->super);
      const auto *starts = static_cast<const SuiteSparse_long *>(factor->pi);
      const auto *blocks = static_cast<const SuiteSparse_long *>(factor->px);
      const auto *rows   = static_cast<const SuiteSparse_long *>(factor->s);
      const auto *values = static_cast<const double *>(factor->x);
      for (std::size_t s = 0; s < factor->nsuper; ++s)
        {
          const SuiteSparse_long n_rows = starts[s + 1] - starts[s];
          for (SuiteSparse_long c = super[s]; c < super[s + 1]; ++c)
            if (dense_number[c] >= 0)
              for (SuiteSparse_long k = c - super[s]; k < n_rows; ++k)
                {
                  const SuiteSparse_long i = dense_number[rows[starts[s] + k]];
                  if (i >= 0)
                    f(i,
                      dense_number[c],
                      values[blocks[s] + (c - super[s]) * n_rows + k]);
                }
        }
    }

    cholmod_common  common;
    cholmod_factor *factor          = nullptr;
    cholmod_dense  *right_hand_side = nullptr;

    // Of each row of the factor, in the dense block or -1; and the opposite.
    std::vector<SuiteSparse_long> dense_number;
    std::vector<std::size_t>      dense_rows;
  };



  template <int dim>
  StiffnessFactor<dim>::StiffnessFactor(const RotatedProblem<dim> &rotated,
                                        const std::vector<unsigned int> &last)
    : rotated(rotated)
    , last(last)
    , cholmod(std::make_unique<Cholmod>())
  {
    for (const unsigned int node : order_other_nodes())
      for (unsigned int d = 0; d < dim; ++d)
        if (!rotated.is_fixed(dim * node + d))
          order.push_back(dim * node + d);
    unsigned int n_dense = 0;
    for (const unsigned int p : last)
      {
        const ContactNode<dim> &node = rotated.problem.contact[p];
        first.push_back(n_dense);
        n_dense += 1 + node.n_free_tangents;
        for (unsigned int e = 0; e <= node.n_free_tangents; ++e)
          order.push_back(dim * node.node + e);
      }
    first.push_back(n_dense);
    factorize();
    extract_schur_complement();
  }



  template <int dim>
  StiffnessFactor<dim>::~StiffnessFactor() = default;



  template <int dim>
  std::vector<unsigned int>
  StiffnessFactor<dim>::order_other_nodes() const
  {
    const NodeBlockMatrix<dim> &A = rotated.problem.stiffness.blocks();
    std::vector<unsigned int> number(A.n_rows(), numbers::invalid_unsigned_int);
    std::vector<char>         is_last(A.n_rows(), 0);
    for (const unsigned int p : last)
      is_last[rotated.problem.contact[p].node] = 1;
    std::vector<unsigned int> nodes;
    std::size_t               n_entries = 0;
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      {
        bool free = false;
        for (unsigned int d = 0; d < dim; ++d)
          free = free || !rotated.is_fixed(dim * i + d);
        if (free && !is_last[i])
          {
            number[i] = nodes.size();
            nodes.push_back(i);
            n_entries += A.row_end(i) - A.row_begin(i);
          }
      }
    if (nodes.empty())
      return nodes;

    cholmod_common &common = cholmod->common;
    cholmod_sparse *graph  = cholmod_l_allocate_sparse(nodes.size(),
                                                      nodes.size(),
                                                      n_entries,
                                                      0,
                                                      1,
                                                      -1,
                                                      CHOLMOD_PATTERN,
                                                      &common);
    cholmod->check(graph != nullptr, "allocate memory");
    auto       *starts  = static_cast<SuiteSparse_long *>(graph->p);
    auto       *entries = static_cast<SuiteSparse_long *>(graph->i);
    std::size_t n       = 0;
    for (unsigned int j = 0; j < nodes.size(); ++j)
      {
        starts[j] = n;
        for (auto e = A.row_begin(nodes[j]); e < A.row_end(nodes[j]); ++e)
          {
            const unsigned int i = number[A.column(e)];
            if (i != numbers::invalid_unsigned_int && i > j)
              entries[n++] = i;
          }
      }
    starts[nodes.size()] = n;
    std::vector<SuiteSparse_long> permutation(nodes.size());
    const bool                    success =
      cholmod_l_metis(graph, nullptr, 0, 1, permutation.data(), &common) ||
      cholmod_l_amd(graph, nullptr, 0, permutation.data(), &common);
    cholmod_l_free_sparse(&graph, &common);
    cholmod->check(success, "order the nodes");

    std::vector<unsigned int> ordered(nodes.size());
    for (unsigned int i = 0; i < nodes.size(); ++i)
      ordered[i] = nodes[permutation[i]];
    return ordered;
  }



  template <int dim>
  void
  StiffnessFactor<dim>::factorize()
  {
    const NodeBlockMatrix<dim> &A    = rotated.problem.stiffness.blocks();
    constexpr std::size_t       none = -1;
    std::vector<std::size_t>    row_of(rotated.n_dofs(), none);
    for (std::size_t i = 0; i < order.size(); ++i)
      row_of[order[i]] = i;

    // The lower triangle, whose columns are rows of the symmetric matrix.
    std::vector<std::size_t> starts(order.size() + 1, 0);
    const auto               for_each_entry = [&](const auto &treat) {
      for (unsigned int node = 0; node < A.n_rows(); ++node)
        for (auto e = A.row_begin(node); e < A.row_end(node); ++e)
          {
            const auto block = rotated.block(node, e);
            for (unsigned int d = 0; d < dim; ++d)
              {
                const std::size_t j = row_of[dim * node + d];
                if (j == none)
                  continue;
                for (unsigned int c = 0; c < dim; ++c)
                  {
                    const std::size_t i = row_of[dim * A.column(e) + c];
                    if (i != none && i >= j)
                      treat(i, j, block[c * dim + d]);
                  }
              }
          }
    };
    for_each_entry([&](const std::size_t, const std::size_t j, const double) {
      ++starts[j + 1];
    });
    for (std::size_t j = 0; j < order.size(); ++j)
      starts[j + 1] += starts[j];

    cholmod_common &common = cholmod->common;
    cholmod_sparse *matrix = cholmod_l_allocate_sparse(order.size(),
                                                       order.size(),
                                                       starts.back(),
                                                       0,
                                                       1,
                                                       -1,
                                                       CHOLMOD_REAL,
                                                       &common);
    cholmod->check(matrix != nullptr, "allocate memory");
    auto *entries = static_cast<SuiteSparse_long *>(matrix->i);
    auto *values  = static_cast<double *>(matrix->x);
    std::copy(
      starts.begin(), starts.end(), static_cast<SuiteSparse_long *>(matrix->p));
    for_each_entry(
      [&](const std::size_t i, const std::size_t j, const double value) {
        entries[starts[j]]  = i;
        values[starts[j]++] = value;
      });

    common.nmethods           = 1;
    common.method[0].ordering = CHOLMOD_NATURAL;
    common.postorder          = 1;
    cholmod->factor           = cholmod_l_analyze(matrix, &common);
    const bool success        = cholmod->factor != nullptr &&
      cholmod_l_factorize(matrix, cholmod->factor, &common);
    cholmod_l_free_sparse(&matrix, &common);
    cholmod->check(success, "factorise the stiffness matrix");
  }



  // Postordering may have moved the rows of the dense block, but only past rows
  // that have no entries in their columns: they are in the same order, and the
  // block is still a factor of the Schur complement.
  template <int dim>
  void
  StiffnessFactor<dim>::extract_schur_complement()
  {
    const int             m = n_dense();
    const cholmod_factor &L = *cholmod->factor;
    AssertThrow(L.is_super && L.is_ll, ExcInternalError());
    const auto *permutation = static_cast<const SuiteSparse_long *>(L.Perm);
    cholmod->dense_number.assign(L.n, -1);
    cholmod->dense_rows.resize(m);
    for (std::size_t i = 0; i < L.n; ++i)
      if (static_cast<std::size_t>(permutation[i]) >= L.n - m)
        {
          cholmod->dense_number[i] = permutation[i] - (L.n - m);
          cholmod->dense_rows[cholmod->dense_number[i]] = i;
        }

    // Reversed in both directions L_cc is an upper triangular matrix U, and
    // U U^T is what LAPACK has a routine for.
    DenseMatrix      U(m);
    std::vector<int> reversed(m);
    int              next = m;
    for (const SuiteSparse_long number : cholmod->dense_number)
      if (number >= 0)
        reversed[number] = --next;
    cholmod->for_each_dense_entry(
      [&](const std::size_t i, const std::size_t j, const double value) {
        U(reversed[i], reversed[j]) = value;
      });
    int info = 0;
    if (m > 0)
      dlauum_("U", &m, U.values.data(), &m, &info);
    S = DenseMatrix(m);
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i)
        S(i, j) = U(std::min(reversed[i], reversed[j]),
                    std::max(reversed[i], reversed[j]));
  }



  template <int dim>
  std::vector<double>
  StiffnessFactor<dim>::reduce(const VectorType &b)
  {
    cholmod_common &common      = cholmod->common;
    const auto     &L           = *cholmod->factor;
    const auto     *permutation = static_cast<const SuiteSparse_long *>(L.Perm);
    cholmod_dense  *right_hand_side =
      cholmod_l_allocate_dense(L.n, 1, L.n, CHOLMOD_REAL, &common);
    cholmod->check(right_hand_side != nullptr, "allocate memory");
    auto *values = static_cast<double *>(right_hand_side->x);
    for (std::size_t i = 0; i < L.n; ++i)
      values[i] = b.local_element(order[permutation[i]]);
    if (cholmod->right_hand_side != nullptr)
      cholmod_l_free_dense(&cholmod->right_hand_side, &common);
    cholmod->right_hand_side =
      cholmod_l_solve(CHOLMOD_L, cholmod->factor, right_hand_side, &common);
    cholmod_l_free_dense(&right_hand_side, &common);
    cholmod->check(cholmod->right_hand_side != nullptr, "solve");

    // What remains is L_cc times that part of the result.
    const auto *y = static_cast<const double *>(cholmod->right_hand_side->x);
    std::vector<double> reduced(n_dense(), 0.);
    cholmod->for_each_dense_entry(
      [&](const std::size_t i, const std::size_t j, const double value) {
        reduced[i] += value * y[cholmod->dense_rows[j]];
      });
    return reduced;
  }



  template <int dim>
  void
  StiffnessFactor<dim>::solve(VectorType                &x,
                              const std::vector<double> &values) const
  {
    cholmod_common &common = cholmod->common;
    const auto     &L      = *cholmod->factor;
    AssertThrow(cholmod->right_hand_side != nullptr &&
                  values.size() == n_dense(),
                ExcInternalError());

    // Backward substitution gives the chosen nodes their values if their part
    // of the right hand side is L_cc^T times these.
    cholmod_dense *b = cholmod_l_copy_dense(cholmod->right_hand_side, &common);
    cholmod->check(b != nullptr, "allocate memory");
    auto *y = static_cast<double *>(b->x);
    for (const std::size_t row : cholmod->dense_rows)
      y[row] = 0.;
    cholmod->for_each_dense_entry(
      [&](const std::size_t i, const std::size_t j, const double value) {
        y[cholmod->dense_rows[j]] += value * values[i];
      });
    cholmod_dense *result =
      cholmod_l_solve(CHOLMOD_Lt, cholmod->factor, b, &common);
    cholmod_l_free_dense(&b, &common);
    cholmod->check(result != nullptr, "solve");
    const auto *permutation = static_cast<const SuiteSparse_long *>(L.Perm);
    const auto *found       = static_cast<const double *>(result->x);
    x                       = 0.;
    for (std::size_t i = 0; i < L.n; ++i)
      x.local_element(order[permutation[i]]) = found[i];
    cholmod_l_free_dense(&result, &common);
  }



  template <int dim>
  std::size_t
  StiffnessFactor<dim>::memory_consumption() const
  {
    return cholmod->common.memory_usage + S.values.capacity() * sizeof(double) +
      order.capacity() * sizeof(std::size_t);
  }



  template class StiffnessFactor<2>;
  template class StiffnessFactor<3>;
} // namespace Benchmark

#include <common/nodes/instructions.h>
#include <common/nodes/row_kernels.h>

namespace Friction
{
  namespace RowKernels
  {
    namespace
    {
      // Vectors as GCC and Clang understand them, in registers and in memory.
      typedef double Pair __attribute__((vector_size(16)));
      typedef double Quad __attribute__((vector_size(32)));
      typedef Pair   PairInMemory __attribute__((aligned(8)));
      typedef Quad   QuadInMemory __attribute__((aligned(8)));

      inline DEAL_II_ALWAYS_INLINE Pair
      pair(const double *numbers)
      {
        return *reinterpret_cast<const PairInMemory *>(numbers);
      }

      // Four numbers at a time, for processors that calculate with two,
      struct TwoPairs
      {
        Pair lower = {0., 0.}, upper = {0., 0.};

        TwoPairs() = default;

        inline DEAL_II_ALWAYS_INLINE
        TwoPairs(const Pair lower, const Pair upper)
          : lower(lower)
          , upper(upper)
        {}

        // Adds four numbers that follow each other in memory, times these.
        inline DEAL_II_ALWAYS_INLINE void
        add(const double *a, const TwoPairs &x)
        {
          lower += pair(a) * x.lower;
          upper += pair(a + 2) * x.upper;
        }

        inline DEAL_II_ALWAYS_INLINE void
        operator+=(const TwoPairs &other)
        {
          lower += other.lower;
          upper += other.upper;
        }

        inline DEAL_II_ALWAYS_INLINE Pair
        sums_of_pairs() const
        {
          return __builtin_shufflevector(lower, upper, 0, 2) +
            __builtin_shufflevector(lower, upper, 1, 3);
        }

        inline DEAL_II_ALWAYS_INLINE void
        add_to(double *sums) const
        {
          *reinterpret_cast<PairInMemory *>(sums) += lower;
          *reinterpret_cast<PairInMemory *>(sums + 2) += upper;
        }

        inline DEAL_II_ALWAYS_INLINE double
        operator[](const unsigned int i) const
        {
          return i < 2 ? lower[i] : upper[i - 2];
        }
      };

      // and with four. To be used in functions only that are compiled for such.
      struct OneQuad
      {
        Quad all = {0., 0., 0., 0.};

        OneQuad() = default;

        inline DEAL_II_ALWAYS_INLINE
        OneQuad(const Pair lower, const Pair upper)
          : all(__builtin_shufflevector(lower, upper, 0, 1, 2, 3))
        {}

        inline DEAL_II_ALWAYS_INLINE void
        add(const double *a, const OneQuad &x)
        {
          all += *reinterpret_cast<const QuadInMemory *>(a) * x.all;
        }

        inline DEAL_II_ALWAYS_INLINE void
        operator+=(const OneQuad &other)
        {
          all += other.all;
        }

        inline DEAL_II_ALWAYS_INLINE Pair
        sums_of_pairs() const
        {
          return __builtin_shufflevector(all, all, 0, 2) +
            __builtin_shufflevector(all, all, 1, 3);
        }

        inline DEAL_II_ALWAYS_INLINE void
        add_to(double *sums) const
        {
          *reinterpret_cast<QuadInMemory *>(sums) += all;
        }

        inline DEAL_II_ALWAYS_INLINE double
        operator[](const unsigned int i) const
        {
          return all[i];
        }
      };



      // A sum of blocks times values. Blocks are stored row by row; the
      // products of a row are added up in the end. In two dimensions both rows
      // are one vector.
      template <int dim, typename Four>
      struct Sum
      {
        Four rows;

        inline DEAL_II_ALWAYS_INLINE void
        add(const double *block, const double *x)
        {
          rows.add(block, Four(pair(x), pair(x)));
        }

        inline DEAL_II_ALWAYS_INLINE void
        operator+=(const Sum &other)
        {
          rows += other.rows;
        }

        inline DEAL_II_ALWAYS_INLINE void
        get(double *result) const
        {
          *reinterpret_cast<PairInMemory *>(result) = rows.sums_of_pairs();
        }
      };

      // In three dimensions a vector is a row and one number too many, the next
      // row's first, which is multiplied by zero. The last row of the last
      // block needs a number in memory behind it, see NodeBlockMatrix. With
      // four numbers stored per row it would be no faster, and there would be
      // more to read.
      template <typename Four>
      struct Sum<3, Four>
      {
        Four first, second, third;

        inline DEAL_II_ALWAYS_INLINE void
        add(const double *block, const double *x)
        {
          const Four value(pair(x), Pair{x[2], 0.});
          first.add(block, value);
          second.add(block + 3, value);
          third.add(block + 6, value);
        }

        inline DEAL_II_ALWAYS_INLINE void
        operator+=(const Sum &other)
        {
          first += other.first;
          second += other.second;
          third += other.third;
        }

        inline DEAL_II_ALWAYS_INLINE void
        get(double *result) const
        {
          result[0] = (first[0] + first[1]) + first[2];
          result[1] = (second[0] + second[1]) + second[2];
          result[2] = (third[0] + third[1]) + third[2];
        }
      };



      // A value of a node, by which transposed blocks are multiplied, and what
      // that adds to the sums of other rows: rows of a block times a number
      // each.
      template <typename Four>
      struct FromLeft
      {
        Four first, second, third;

        inline DEAL_II_ALWAYS_INLINE
        FromLeft(const double *x)
          : first(Pair{x[0], x[0]}, Pair{x[0], x[0]})
          , second(Pair{x[1], x[1]}, Pair{x[1], x[1]})
          , third(Pair{x[2], x[2]}, Pair{x[2], x[2]})
        {}

        inline DEAL_II_ALWAYS_INLINE void
        add(const double *block, double *sums) const
        {
          Four products;
          products.add(block, first);
          products.add(block + 3, second);
          products.add(block + 6, third);
          products.add_to(sums);
        }
      };



      inline DEAL_II_ALWAYS_INLINE void
      clear(double *sums)
      {
        for (unsigned int i = 0; i < n_partial_sums; ++i)
          sums[i] = 0.;
      }



      // Blocks stored with a row: the diagonal one, and how many there are.
      template <int dim>
      struct StoredRow
      {
        std::size_t         n;
        const unsigned int *columns;
        const double       *blocks;

        inline DEAL_II_ALWAYS_INLINE
        StoredRow(const BlockRows<dim> &A, const std::size_t row)
          : n(A.stored_starts[row + 1] - A.stored_starts[row])
          , columns(A.columns + A.starts[row])
          , blocks(A.blocks + dim * dim * A.stored_starts[row])
        {}
      };



      // Adds up n blocks times values, from the first one on. Two sums, so that
      // an addition need not wait for the one before it.
      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE void
      add_blocks(Sum<dim, Four>       &sum,
                 const StoredRow<dim> &row,
                 const std::size_t     first,
                 std::size_t           n,
                 const double         *x)
      {
        constexpr int       size   = dim * dim;
        const unsigned int *column = row.columns + first;
        const double       *block  = row.blocks + size * first;
        Sum<dim, Four>      other;
        for (; n > 1; n -= 2)
          {
            sum.add(block, x + dim * static_cast<std::size_t>(column[0]));
            other.add(block + size,
                      x + dim * static_cast<std::size_t>(column[1]));
            column += 2;
            block += 2 * size;
          }
        if (n > 0)
          sum.add(block, x + dim * static_cast<std::size_t>(column[0]));
        sum += other;
      }



      // What a row adds to the sums of others. To the right of the diagonal
      // other processes' columns come last.
      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE void
      add_share_body(const BlockRows<dim> &A,
                     const StoredRow<dim> &row,
                     const double         *value,
                     const LeftSums       &left)
      {
        if constexpr (stores_half<dim>)
          if (left.add)
            {
              const FromLeft<Four> from_left(value);
              for (std::size_t k = 1; k < row.n && row.columns[k] < A.n_rows;
                   ++k)
                from_left.add(row.blocks + dim * dim * k,
                              left.sums +
                                n_partial_sums *
                                  static_cast<std::size_t>(row.columns[k]));
            }
      }

      // What others have added to it, which is to be cleared or not.
      template <int dim>
      inline DEAL_II_ALWAYS_INLINE void
      take_sums(const std::size_t row, const LeftSums &left, double *product)
      {
        if constexpr (stores_half<dim>)
          {
            double *sums = left.sums + n_partial_sums * row;
            for (int d = 0; d < dim; ++d)
              product[d] += sums[d];
            if (left.clear)
              clear(sums);
          }
      }



      // The diagonal block comes in the end, when the others are under way.
      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE void
      add_row(Sum<dim, Four>       &sum,
              const StoredRow<dim> &row,
              const double         *x,
              const double         *xi)
      {
        add_blocks(sum, row, 1, row.n - 1, x);
        sum.add(row.blocks, xi);
      }



      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE void
      times_body(const BlockRows<dim> &A,
                 const unsigned int    row,
                 const double         *x,
                 double               *product)
      {
        const StoredRow<dim> blocks(A, row);
        Sum<dim, Four>       sum;
        if (blocks.n > 0)
          add_row(sum, blocks, x, x + dim * static_cast<std::size_t>(row));
        sum.get(product);
      }



      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE void
      pass_body(const BlockRows<dim> &matrix,
                const RowLoop        &loop,
                const double         *x)
      {
        const BlockRows<dim> A     = matrix;
        Prefetch             fetch = loop.prefetch;
        for (std::size_t i = loop.rows.first; i < loop.rows.second; ++i)
          {
            fetch.step();
            if (loop.left.clear)
              clear(loop.left.sums + n_partial_sums * i);
            const double *xi      = x + dim * i;
            bool          is_zero = true;
            for (int d = 0; d < dim; ++d)
              is_zero = is_zero && xi[d] == 0.;
            if (!is_zero)
              add_share_body<dim, Four>(A, StoredRow<dim>(A, i), xi, loop.left);
          }
        loop.prefetch = fetch;
      }



      // With b, b - A x, and without A x.
      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE void
      residual_body(const BlockRows<dim> &matrix,
                    const RowLoop        &loop,
                    double               *r,
                    const double         *b,
                    const double         *x)
      {
        const BlockRows<dim> A     = matrix;
        Prefetch             fetch = loop.prefetch;
        for (std::size_t i = loop.rows.first; i < loop.rows.second; ++i)
          {
            fetch.step();
            const StoredRow<dim> row(A, i);
            const double        *xi = x + dim * i;
            Sum<dim, Four>       sum;
            if (row.n > 0)
              {
                add_row(sum, row, x, xi);
                add_share_body<dim, Four>(A, row, xi, loop.left);
              }
            double product[dim];
            sum.get(product);
            take_sums<dim>(i, loop.left, product);
            for (int d = 0; d < dim; ++d)
              r[dim * i + d] =
                b != nullptr ? b[dim * i + d] - product[d] : product[d];
          }
        loop.prefetch = fetch;
      }



      // In a row's order, see NodePattern, the diagonal block comes first, then
      // larger numbers, those of other processes last, and then smaller ones,
      // which are not read, if they are stored. What the processor would
      // foresee then is the next memory, half of which is of no use, so that it
      // is told which comes next.
      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE double
      energy_body(const BlockRows<dim> &matrix, const double *x)
      {
        constexpr unsigned int size = dim * dim, ahead = 4;
        const BlockRows<dim>   A   = matrix;
        double                 sum = 0.;
        for (std::size_t i = 0; i < A.n_rows; ++i)
          {
            if (!stores_half<dim> && i + ahead < A.n_rows)
              {
                const StoredRow<dim> next(A, i + ahead);
                const double        *first = next.blocks,
                             *const  last  = first + size * (next.n / 2 + 1);
                for (; first < last; first += 8)
                  __builtin_prefetch(first);
              }
            const StoredRow<dim> row(A, i);
            if (row.n == 0)
              continue;
            std::size_t larger = 1;
            while (larger < row.n && row.columns[larger] - i < A.n_rows - i)
              ++larger;
            std::size_t ghosts = larger;
            while (ghosts < row.n && row.columns[ghosts] >= A.n_rows)
              ++ghosts;

            const double  *xi = x + dim * i;
            Sum<dim, Four> twice, once;
            add_blocks(twice, row, 1, larger - 1, x);
            once.add(row.blocks, xi);
            add_blocks(once, row, larger, ghosts - larger, x);
            double products[2][dim];
            twice.get(products[0]);
            once.get(products[1]);
            for (int d = 0; d < dim; ++d)
              sum += xi[d] * (2. * products[0][d] + products[1][d]);
          }
        return sum;
      }



      // Rows are read from front to back, as is the matrix: processors foresee
      // what is read next, as long as it goes on in one direction. The node
      // that has just been relaxed comes last: in the order of the row, see
      // NodePattern, or in the sums of the left. So the processor can begin
      // with a row while it is not yet through with the one before.
      //
      // In two dimensions rows are so short that this is not enough. There the
      // last block is multiplied by the inverse beforehand: from one relaxed
      // node to the next there is then a single product instead of two, one
      // after the other, and a sum.
      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE void
      relax_body(const BlockRows<dim> &matrix,
                 const NodeBlock<dim> *inverses,
                 const RowLoop        &loop,
                 const double         *b,
                 double               *x)
      {
        constexpr int        size  = dim * dim;
        const BlockRows<dim> A     = matrix;
        const LeftSums       left  = loop.left;
        Prefetch             fetch = loop.prefetch;
        for (std::size_t i = loop.rows.first; i < loop.rows.second; ++i)
          {
            fetch.step();
            const StoredRow<dim> row(A, i);
            if (row.n == 0)
              continue;
            double        *xi      = x + dim * i;
            const double  *bi      = b + dim * i;
            const double  *inverse = inverses[i].data();
            Sum<dim, Four> sum;
            if constexpr (dim == 2)
              {
                // The others, but for the last one, and then the diagonal.
                const bool        has_last = (row.n > 1);
                const std::size_t last     = row.n - 1;
                add_blocks(sum, row, 1, last - has_last, x);
                sum.add(row.blocks, xi);

                const Pair inverse0 = pair(inverse),
                           inverse1 = pair(inverse + 2);
                const Pair defect   = pair(bi) - sum.rows.sums_of_pairs();
                Pair       value    = pair(xi) +
                  (inverse0 * Pair{defect[0], defect[0]} +
                   inverse1 * Pair{defect[1], defect[1]});
                if (has_last)
                  {
                    const double *block = row.blocks + size * last;
                    const Pair column0  = inverse0 * Pair{block[0], block[0]} +
                      inverse1 * Pair{block[2], block[2]};
                    const Pair column1 = inverse0 * Pair{block[1], block[1]} +
                      inverse1 * Pair{block[3], block[3]};
                    const Pair other = pair(
                      x + dim * static_cast<std::size_t>(row.columns[last]));
                    value = (value - column0 * Pair{other[0], other[0]}) -
                      column1 * Pair{other[1], other[1]};
                  }
                *reinterpret_cast<PairInMemory *>(xi) = value;
              }
            else
              {
                add_row(sum, row, x, xi);
                double product[dim], defect[dim];
                sum.get(product);
                take_sums<dim>(i, left, product);
                for (int d = 0; d < dim; ++d)
                  defect[d] = bi[d] - product[d];
                // Two numbers at a time, as they are read by the next row.
                *reinterpret_cast<PairInMemory *>(xi) = pair(xi) +
                  ((pair(inverse) * Pair{defect[0], defect[0]} +
                    pair(inverse + 3) * Pair{defect[1], defect[1]}) +
                   pair(inverse + 6) * Pair{defect[2], defect[2]});
                xi[2] += (inverse[2] * defect[0] + inverse[5] * defect[1]) +
                  inverse[8] * defect[2];
                add_share_body<dim, Four>(A, row, xi, left);
              }
          }
        loop.prefetch = fetch;
      }



#ifdef FRICTION_AVX2
      // What is inlined into a function is compiled for the same instructions
      // as that function. The functions called in these are all inlined.
      template <int dim>
      FRICTION_AVX2 void
      times_avx2(const BlockRows<dim> &A,
                 const unsigned int    row,
                 const double         *x,
                 double               *product)
      {
        times_body<dim, OneQuad>(A, row, x, product);
      }

      template <int dim>
      FRICTION_AVX2 void
      pass_avx2(const BlockRows<dim> &A, const RowLoop &loop, const double *x)
      {
        pass_body<dim, OneQuad>(A, loop, x);
      }

      template <int dim>
      FRICTION_AVX2 void
      add_share_avx2(const BlockRows<dim> &A,
                     const unsigned int    row,
                     const double         *x,
                     const LeftSums       &left)
      {
        add_share_body<dim, OneQuad>(
          A, StoredRow<dim>(A, row), x + dim * std::size_t(row), left);
      }

      template <int dim>
      FRICTION_AVX2 void
      residual_avx2(const BlockRows<dim> &A,
                    const RowLoop        &loop,
                    double               *r,
                    const double         *b,
                    const double         *x)
      {
        residual_body<dim, OneQuad>(A, loop, r, b, x);
      }

      template <int dim>
      FRICTION_AVX2 double
      energy_avx2(const BlockRows<dim> &A, const double *x)
      {
        return energy_body<dim, OneQuad>(A, x);
      }

      template <int dim>
      FRICTION_AVX2 void
      relax_avx2(const BlockRows<dim> &A,
                 const NodeBlock<dim> *inverses,
                 const RowLoop        &loop,
                 const double         *b,
                 double               *x)
      {
        relax_body<dim, OneQuad>(A, inverses, loop, b, x);
      }
#endif
    } // namespace



    template <int dim>
    NodeValue<dim>
    times(const BlockRows<dim> &A, const unsigned int row, const double *x)
    {
      NodeValue<dim> product;
#ifdef FRICTION_AVX2
      if (instructions_in_use == Instructions::avx2)
        times_avx2<dim>(A, row, x, product.data());
      else
#endif
        times_body<dim, TwoPairs>(A, row, x, product.data());
      return product;
    }



    template <int dim>
    NodeValue<dim>
    times(const BlockRows<dim> &A,
          const unsigned int    row,
          const double         *x,
          const LeftSums       &left)
    {
      NodeValue<dim> product = times<dim>(A, row, x);
      take_sums<dim>(row, left, product.data());
      return product;
    }



    template <int dim>
    void
    pass(const BlockRows<dim> &A, const RowLoop &loop, const double *x)
    {
      if (!stores_half<dim>)
        return;
#ifdef FRICTION_AVX2
      if (instructions_in_use == Instructions::avx2)
        return pass_avx2<dim>(A, loop, x);
#endif
      pass_body<dim, TwoPairs>(A, loop, x);
    }



    template <int dim>
    void
    add_share(const BlockRows<dim> &A,
              const unsigned int    row,
              const double         *x,
              const LeftSums       &left)
    {
      if (!stores_half<dim>)
        return;
#ifdef FRICTION_AVX2
      if (instructions_in_use == Instructions::avx2)
        return add_share_avx2<dim>(A, row, x, left);
#endif
      add_share_body<dim, TwoPairs>(
        A, StoredRow<dim>(A, row), x + dim * std::size_t(row), left);
    }



    template <int dim>
    void
    residual(const BlockRows<dim> &A,
             const RowLoop        &loop,
             double               *r,
             const double         *b,
             const double         *x)
    {
#ifdef FRICTION_AVX2
      if (instructions_in_use == Instructions::avx2)
        return residual_avx2<dim>(A, loop, r, b, x);
#endif
      residual_body<dim, TwoPairs>(A, loop, r, b, x);
    }



    template <int dim>
    double
    energy(const BlockRows<dim> &A, const double *x)
    {
#ifdef FRICTION_AVX2
      if (instructions_in_use == Instructions::avx2)
        return energy_avx2<dim>(A, x);
#endif
      return energy_body<dim, TwoPairs>(A, x);
    }



    template <int dim>
    void
    relax(const BlockRows<dim> &A,
          const NodeBlock<dim> *inverses,
          const RowLoop        &loop,
          const double         *b,
          double               *x)
    {
#ifdef FRICTION_AVX2
      if (instructions_in_use == Instructions::avx2)
        return relax_avx2<dim>(A, inverses, loop, b, x);
#endif
      relax_body<dim, TwoPairs>(A, inverses, loop, b, x);
    }



#define INSTANTIATE(dim)                                                \
  template NodeValue<dim> times<dim>(                                   \
    const BlockRows<dim> &, const unsigned int, const double *);        \
  template NodeValue<dim> times<dim>(const BlockRows<dim> &,            \
                                     const unsigned int,                \
                                     const double *,                    \
                                     const LeftSums &);                 \
  template void           pass<dim>(                                    \
    const BlockRows<dim> &, const RowLoop &, const double *); \
  template void   add_share<dim>(const BlockRows<dim> &,                \
                               const unsigned int,                    \
                               const double *,                        \
                               const LeftSums &);                     \
  template void   residual<dim>(const BlockRows<dim> &,                 \
                              const RowLoop &,                        \
                              double *,                               \
                              const double *,                         \
                              const double *);                        \
  template double energy<dim>(const BlockRows<dim> &, const double *);  \
  template void   relax<dim>(const BlockRows<dim> &,                    \
                           const NodeBlock<dim> *,                    \
                           const RowLoop &,                           \
                           const double *,                            \
                           double *);
    INSTANTIATE(2)
    INSTANTIATE(3)
#undef INSTANTIATE
  } // namespace RowKernels
} // namespace Friction

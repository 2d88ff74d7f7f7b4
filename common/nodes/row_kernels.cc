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

      // Four sums; to each is added one of four numbers that follow each other
      // in memory, times a factor. For processors that calculate with two
      // numbers at a time,
      struct TwoPairs
      {
        Pair lower = {0., 0.}, upper = {0., 0.};

        // The same factor for all.
        inline DEAL_II_ALWAYS_INLINE void
        add(const double *a, const double x)
        {
          lower += pair(a) * Pair{x, x};
          upper += pair(a + 2) * Pair{x, x};
        }

        // One for the first two, one for the other two.
        inline DEAL_II_ALWAYS_INLINE void
        add_columns(const double *a, const double *x)
        {
          lower += pair(a) * Pair{x[0], x[0]};
          upper += pair(a + 2) * Pair{x[1], x[1]};
        }

        inline DEAL_II_ALWAYS_INLINE void
        operator+=(const TwoPairs &other)
        {
          lower += other.lower;
          upper += other.upper;
        }

        inline DEAL_II_ALWAYS_INLINE Pair
        sum_of_halves() const
        {
          return lower + upper;
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

        inline DEAL_II_ALWAYS_INLINE void
        add(const double *a, const double x)
        {
          all += *reinterpret_cast<const QuadInMemory *>(a) * Quad{x, x, x, x};
        }

        inline DEAL_II_ALWAYS_INLINE void
        add_columns(const double *a, const double *x)
        {
          all += *reinterpret_cast<const QuadInMemory *>(a) *
            __builtin_shufflevector(pair(x), pair(x), 0, 0, 1, 1);
        }

        inline DEAL_II_ALWAYS_INLINE void
        operator+=(const OneQuad &other)
        {
          all += other.all;
        }

        inline DEAL_II_ALWAYS_INLINE Pair
        sum_of_halves() const
        {
          return __builtin_shufflevector(all, all, 0, 1) +
            __builtin_shufflevector(all, all, 2, 3);
        }

        inline DEAL_II_ALWAYS_INLINE double
        operator[](const unsigned int i) const
        {
          return all[i];
        }
      };



      // A sum of blocks times values. In two dimensions both columns of a block
      // are one vector.
      template <int dim, typename Four>
      struct Sum
      {
        Four columns;

        inline DEAL_II_ALWAYS_INLINE void
        add(const double *block, const double *x)
        {
          columns.add_columns(block, x);
        }

        inline DEAL_II_ALWAYS_INLINE void
        operator+=(const Sum &other)
        {
          columns += other.columns;
        }

        inline DEAL_II_ALWAYS_INLINE double
        operator[](const unsigned int row) const
        {
          return columns[row] + columns[2 + row];
        }
      };

      // In three dimensions a vector is a column and one number too many, which
      // is calculated in vain: the next column's first for the first two, the
      // one before it for the third, so that nothing outside of the block is
      // touched. With four numbers stored per column it would be no faster, and
      // there would be more to read.
      template <typename Four>
      struct Sum<3, Four>
      {
        Four first, second, third;

        inline DEAL_II_ALWAYS_INLINE void
        add(const double *block, const double *x)
        {
          first.add(block, x[0]);
          second.add(block + 3, x[1]);
          third.add(block + 5, x[2]);
        }

        inline DEAL_II_ALWAYS_INLINE void
        operator+=(const Sum &other)
        {
          first += other.first;
          second += other.second;
          third += other.third;
        }

        inline DEAL_II_ALWAYS_INLINE double
        operator[](const unsigned int row) const
        {
          return first[row] + second[row] + third[1 + row];
        }
      };



      // Adds up n blocks times values, from the first one on, forwards or
      // backwards by steps of 1 or -1. Two sums, so that an addition need not
      // wait for the one before it.
      template <int step, int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE void
      add_blocks(Sum<dim, Four>       &sum,
                 const BlockRows<dim> &A,
                 const std::size_t     first,
                 std::size_t           n,
                 const double         *x)
      {
        constexpr int       size   = dim * dim;
        const unsigned int *column = A.columns + first;
        const double       *block  = A.blocks + size * first;
        Sum<dim, Four>      other;
        for (; n > 1; n -= 2)
          {
            sum.add(block, x + dim * static_cast<std::size_t>(column[0]));
            other.add(block + size * step,
                      x + dim * static_cast<std::size_t>(column[step]));
            column += 2 * step;
            block += 2 * size * step;
          }
        if (n > 0)
          sum.add(block, x + dim * static_cast<std::size_t>(column[0]));
        sum += other;
      }



      template <int dim, typename Four, int step>
      inline DEAL_II_ALWAYS_INLINE void
      times_in_steps(const BlockRows<dim> &A,
                     const unsigned int    row,
                     const double         *x,
                     double               *product)
      {
        const std::size_t begin = A.starts[row], end = A.starts[row + 1];
        const std::size_t n     = end - begin;
        const std::size_t first = (step > 0 || n == 0) ? begin : end - 1;
        Sum<dim, Four>    sum;
        add_blocks<step>(sum, A, first, n, x);
        for (int d = 0; d < dim; ++d)
          product[d] = sum[d];
      }



      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE void
      times_body(const BlockRows<dim> &A,
                 const unsigned int    row,
                 const double         *x,
                 const bool            backwards,
                 double               *product)
      {
        if (backwards)
          times_in_steps<dim, Four, -1>(A, row, x, product);
        else
          times_in_steps<dim, Four, 1>(A, row, x, product);
      }



      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE void
      residual_body(const BlockRows<dim> &matrix,
                    const RowLoop        &loop,
                    double               *r,
                    const double         *b,
                    const double         *x)
      {
        const BlockRows<dim> A     = matrix;
        const RowRange       rows  = loop.rows;
        Prefetch             fetch = loop.prefetch;
        for (unsigned int i = rows.first; i < rows.second; ++i)
          {
            fetch.step();
            double product[dim];
            times_in_steps<dim, Four, 1>(A, i, x, product);
            for (int d = 0; d < dim; ++d)
              r[dim * i + d] = b[dim * i + d] - product[d];
          }
        loop.prefetch = fetch;
      }



      // In a row's order, see NodePattern, the diagonal block comes first, then
      // larger numbers, those of other processes last, and then smaller ones,
      // which are not read. What the processor would foresee is the next
      // memory, half of which is of no use, so that it is told which comes
      // next.
      template <int dim, typename Four>
      inline DEAL_II_ALWAYS_INLINE double
      energy_body(const BlockRows<dim> &matrix,
                  const unsigned int    n_rows,
                  const double         *x)
      {
        constexpr unsigned int size = dim * dim, ahead = 4;
        const BlockRows<dim>   A   = matrix;
        double                 sum = 0.;
        for (unsigned int i = 0; i < n_rows; ++i)
          {
            if (i + ahead < n_rows)
              {
                const std::size_t   next  = A.starts[i + ahead];
                const std::size_t   n     = A.starts[i + ahead + 1] - next;
                const double       *first = A.blocks + size * next,
                             *const last  = first + size * (n / 2 + 1);
                for (; first < last; first += 8)
                  __builtin_prefetch(first);
              }
            const std::size_t begin = A.starts[i], end = A.starts[i + 1];
            if (begin == end)
              continue;
            std::size_t larger = begin + 1;
            while (larger < end && A.columns[larger] - i < n_rows - i)
              ++larger;
            std::size_t ghosts = larger;
            while (ghosts < end && A.columns[ghosts] >= n_rows)
              ++ghosts;

            const double  *xi = x + dim * static_cast<std::size_t>(i);
            Sum<dim, Four> twice, once;
            add_blocks<1>(twice, A, begin + 1, larger - begin - 1, x);
            once.add(A.blocks + dim * dim * begin, xi);
            add_blocks<1>(once, A, larger, ghosts - larger, x);
            for (int d = 0; d < dim; ++d)
              sum += xi[d] * (2. * twice[d] + once[d]);
          }
        return sum;
      }



      // Rows are read from front to back or from back to front, like the
      // matrix: processors foresee what is read next, as long as it goes on in
      // one direction. In a row's order, see NodePattern, the node that has
      // just been relaxed comes last in either direction; so the processor
      // can begin with a row while it is not yet through with the one before.
      //
      // In two dimensions rows are so short that this is not enough. There the
      // last block is multiplied by the inverse beforehand: from one relaxed
      // node to the next there is then a single product instead of two, one
      // after the other, and a sum.
      template <int dim, typename Four, int step>
      inline DEAL_II_ALWAYS_INLINE void
      relax_body(const BlockRows<dim> &matrix,
                 const NodeBlock<dim> *inverses,
                 const RowLoop        &loop,
                 const double         *b,
                 double               *x)
      {
        constexpr bool       backwards = (step < 0);
        constexpr int        size      = dim * dim;
        const BlockRows<dim> A         = matrix;
        const RowRange       rows      = loop.rows;
        Prefetch             fetch     = loop.prefetch;
        std::size_t          i = backwards ? rows.second - 1 : rows.first;
        for (unsigned int n = rows.second - rows.first; n > 0; --n, i += step)
          {
            fetch.step();
            const std::size_t begin = A.starts[i], end = A.starts[i + 1];
            if (begin == end)
              continue;
            double       *xi      = x + dim * i;
            const double *bi      = b + dim * i;
            const double *inverse = inverses[i].data();

            // The others, but for the last one, and then the diagonal.
            const std::size_t n_others = end - begin - 1;
            const bool        has_last = (dim == 2 && n_others > 0);
            const std::size_t first    = backwards ? end - 1 : begin + 1,
                              last     = backwards ? begin + 1 : end - 1;
            Sum<dim, Four> sum;
            add_blocks<step>(sum, A, first, n_others - has_last, x);
            sum.add(A.blocks + size * begin, xi);

            if constexpr (dim == 2)
              {
                const Pair inverse0 = pair(inverse),
                           inverse1 = pair(inverse + 2);
                const Pair defect   = pair(bi) - sum.columns.sum_of_halves();
                Pair       value    = pair(xi) +
                  (inverse0 * Pair{defect[0], defect[0]} +
                   inverse1 * Pair{defect[1], defect[1]});
                if (has_last)
                  {
                    const double *block = A.blocks + size * last;
                    const Pair column0  = inverse0 * Pair{block[0], block[0]} +
                      inverse1 * Pair{block[1], block[1]};
                    const Pair column1 = inverse0 * Pair{block[2], block[2]} +
                      inverse1 * Pair{block[3], block[3]};
                    const Pair other =
                      pair(x + dim * static_cast<std::size_t>(A.columns[last]));
                    value = (value - column0 * Pair{other[0], other[0]}) -
                      column1 * Pair{other[1], other[1]};
                  }
                *reinterpret_cast<PairInMemory *>(xi) = value;
              }
            else
              {
                double defect[dim];
                for (int d = 0; d < dim; ++d)
                  defect[d] = bi[d] - sum[d];
                Sum<dim, Four> correction;
                correction.add(inverse, defect);
                for (int d = 0; d < dim; ++d)
                  xi[d] += correction[d];
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
                 const bool            backwards,
                 double               *product)
      {
        times_body<dim, OneQuad>(A, row, x, backwards, product);
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
      energy_avx2(const BlockRows<dim> &A,
                  const unsigned int    n_rows,
                  const double         *x)
      {
        return energy_body<dim, OneQuad>(A, n_rows, x);
      }

      template <int dim>
      FRICTION_AVX2 void
      relax_avx2(const BlockRows<dim> &A,
                 const NodeBlock<dim> *inverses,
                 const RowLoop        &loop,
                 const double         *b,
                 double               *x)
      {
        if (loop.backwards)
          relax_body<dim, OneQuad, -1>(A, inverses, loop, b, x);
        else
          relax_body<dim, OneQuad, 1>(A, inverses, loop, b, x);
      }
#endif
    } // namespace



    template <int dim>
    NodeValue<dim>
    times(const BlockRows<dim> &A,
          const unsigned int    row,
          const double         *x,
          const bool            backwards)
    {
      NodeValue<dim> product;
#ifdef FRICTION_AVX2
      if (instructions_in_use == Instructions::avx2)
        times_avx2<dim>(A, row, x, backwards, product.data());
      else
#endif
        times_body<dim, TwoPairs>(A, row, x, backwards, product.data());
      return product;
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
    energy(const BlockRows<dim> &A, const unsigned int n_rows, const double *x)
    {
#ifdef FRICTION_AVX2
      if (instructions_in_use == Instructions::avx2)
        return energy_avx2<dim>(A, n_rows, x);
#endif
      return energy_body<dim, TwoPairs>(A, n_rows, x);
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
      if (loop.backwards)
        relax_body<dim, TwoPairs, -1>(A, inverses, loop, b, x);
      else
        relax_body<dim, TwoPairs, 1>(A, inverses, loop, b, x);
    }



    template NodeValue<2> times<2>(const BlockRows<2> &,
                                   const unsigned int,
                                   const double *,
                                   const bool);
    template void         residual<2>(const BlockRows<2> &,
                              const RowLoop &,
                              double *,
                              const double *,
                              const double *);
    template double
    energy<2>(const BlockRows<2> &, const unsigned int, const double *);
    template void         relax<2>(const BlockRows<2> &,
                           const NodeBlock<2> *,
                           const RowLoop &,
                           const double *,
                           double *);
    template NodeValue<3> times<3>(const BlockRows<3> &,
                                   const unsigned int,
                                   const double *,
                                   const bool);
    template void         residual<3>(const BlockRows<3> &,
                              const RowLoop &,
                              double *,
                              const double *,
                              const double *);
    template double
    energy<3>(const BlockRows<3> &, const unsigned int, const double *);
    template void relax<3>(const BlockRows<3> &,
                           const NodeBlock<3> *,
                           const RowLoop &,
                           const double *,
                           double *);
  } // namespace RowKernels
} // namespace Friction

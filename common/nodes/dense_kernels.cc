#include <common/nodes/dense_kernels.h>
#include <common/nodes/instructions.h>

#define FRICTION_INSTRUCTIONS Common
#include <common/nodes/dense_kernels_body.h>

namespace Friction
{
  namespace DenseKernels
  {
#ifdef FRICTION_AVX2_FILES
    // In a file of its own.
    namespace Avx2
    {
      bool eliminate(double *, const unsigned int, const unsigned int);
      void solve(double *, double *, const unsigned int);
    } // namespace Avx2
#endif



    bool
    eliminate(double            *matrix,
              const unsigned int n,
              const unsigned int n_eliminated)
    {
#ifdef FRICTION_AVX2_FILES
      if (instructions_in_use == Instructions::avx2)
        return Avx2::eliminate(matrix, n, n_eliminated);
#endif
      return Common::eliminate(matrix, n, n_eliminated);
    }



    void
    solve(double *matrix, double *x, const unsigned int n)
    {
#ifdef FRICTION_AVX2_FILES
      if (instructions_in_use == Instructions::avx2)
        return Avx2::solve(matrix, x, n);
#endif
      Common::solve(matrix, x, n);
    }
  } // namespace DenseKernels
} // namespace Friction

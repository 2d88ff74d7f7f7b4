// DenseKernels for processors with AVX2. Eigen gets a name of its own: the
// linker keeps one of all functions of the same name, and might hand those of
// this file to other processors. For the same reason what Eigen uses of the
// standard library is included before.

#include <common/nodes/instructions.h>

#ifdef FRICTION_AVX2_FILES

#  include <algorithm>
#  include <array>
#  include <atomic>
#  include <cassert>
#  include <cerrno>
#  include <climits>
#  include <cmath>
#  include <complex>
#  include <cstddef>
#  include <cstdint>
#  include <cstdlib>
#  include <cstring>
#  include <functional>
#  include <initializer_list>
#  include <iosfwd>
#  include <iterator>
#  include <limits>
#  include <list>
#  include <map>
#  include <memory>
#  include <mutex>
#  include <new>
#  include <numeric>
#  include <sstream>
#  include <string>
#  include <thread>
#  include <tuple>
#  include <type_traits>
#  include <utility>
#  include <vector>

#  include <immintrin.h>

#  pragma GCC target("avx2,fma")

// Before version 13 the compiler does not say so to Eigen.
#  ifndef __AVX__
#    define __AVX__ 1
#  endif
#  ifndef __AVX2__
#    define __AVX2__ 1
#  endif
#  ifndef __FMA__
#    define __FMA__ 1
#  endif

#  define Eigen EigenAvx2
#  define FRICTION_INSTRUCTIONS Avx2
#  include <common/nodes/dense_kernels_body.h>

#endif

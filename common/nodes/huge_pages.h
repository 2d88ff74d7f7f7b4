#ifndef friction_nodes_huge_pages_h
#define friction_nodes_huge_pages_h

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#ifdef __linux__
#  include <sys/mman.h>
#endif

namespace Friction
{
  /**
   * Asks for large arrays in pages of 2 MB instead of 4 KB, where the system
   * has such. Processors foresee what a loop reads next, but only to the end of
   * a page, and look up each page's place in memory: a row of blocks in three
   * dimensions is half of a small page, and reading such a matrix takes twice
   * as long as with large pages.
   *
   * No more memory is used: what does not fill a large page has small ones.
   */
  template <typename T>
  class HugePageAllocator
  {
  public:
    using value_type = T;

    HugePageAllocator() = default;

    template <typename U>
    HugePageAllocator(const HugePageAllocator<U> &)
    {}

    T *
    allocate(const std::size_t n)
    {
      const std::size_t bytes = n * sizeof(T);
      void             *memory;
      if (posix_memalign(&memory, bytes < page ? 64 : page, bytes) != 0)
        throw std::bad_alloc();
#if defined(__linux__) && defined(MADV_HUGEPAGE)
      // A wish: whether it is granted makes no difference but in speed.
      if (bytes >= page)
        madvise(memory, bytes / page * page, MADV_HUGEPAGE);
#endif
      return static_cast<T *>(memory);
    }

    void
    deallocate(T *memory, const std::size_t)
    {
      std::free(memory);
    }

    template <typename U>
    bool
    operator==(const HugePageAllocator<U> &) const
    {
      return true;
    }

    template <typename U>
    bool
    operator!=(const HugePageAllocator<U> &) const
    {
      return false;
    }

  private:
    static constexpr std::size_t page = 1 << 21;
  };



  /** A vector in large pages. */
  template <typename T>
  using HugePageVector = std::vector<T, HugePageAllocator<T>>;
} // namespace Friction

#endif

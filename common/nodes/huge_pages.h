#ifndef friction_nodes_huge_pages_h
#define friction_nodes_huge_pages_h

#include <cstddef>
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
   * No more memory is touched, since what does not fill a large page has small
   * ones; of addresses there are up to two large pages more.
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
      if (bytes < page)
        return static_cast<T *>(::operator new(bytes));
      void *memory = ::operator new(bytes, std::align_val_t(page));
#if defined(__linux__) && defined(MADV_HUGEPAGE)
      // A wish: whether it is granted makes no difference but in speed.
      madvise(memory, bytes / page * page, MADV_HUGEPAGE);
#endif
      return static_cast<T *>(memory);
    }

    void
    deallocate(T *memory, const std::size_t n)
    {
      if (n * sizeof(T) < page)
        ::operator delete(memory);
      else
        ::operator delete(memory, std::align_val_t(page));
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

#pragma once

#include <cstdint>
#include <cstdlib>
#include <new>
#include <type_traits>

namespace latcon::support
{

/// Allocator of zeros that take memory only where they are touched: a large vector made as `Vector(n)` is zero pages,
/// which the operating system replaces by memory at the first write. So a process may hold a field over a sheet of
/// which it moves a few rows, at the places it has in the whole.
///
/// Elements that are made without a value are what the memory holds, zero in a vector that was made with its size. They
/// are not zero where a vector shrinks and grows again. Vectors begin at a multiple of 64 bytes, a cache line.
template <class T>
struct ZeroPages
{
  static_assert(std::is_arithmetic_v<T>);
  using value_type = T;
  static constexpr std::size_t alignment = 64; // of a cache line

  ZeroPages() = default;
  template <class U>
  ZeroPages(const ZeroPages<U> &)
  {
  }

  T *allocate(std::size_t n)
  {
    // calloc, as the only way to zero pages, knows no alignment: room for that, and for where its memory begins. Loops
    // over rows take vectors of places, and may load some zeros beyond the last one.
    void *const memory = std::calloc(n * sizeof(T) + 3 * alignment, 1);
    if (memory == nullptr)
      throw std::bad_alloc();
    const auto address = reinterpret_cast<std::uintptr_t>(memory);
    const auto aligned = reinterpret_cast<void **>(static_cast<char *>(memory) + (2 * alignment - address % alignment));
    aligned[-1] = memory;
    return reinterpret_cast<T *>(aligned);
  }
  void deallocate(T *memory, std::size_t) { std::free(reinterpret_cast<void **>(memory)[-1]); }

  void construct(T *) {} // without a value

  friend bool operator==(const ZeroPages &, const ZeroPages &) { return true; }
  friend bool operator!=(const ZeroPages &, const ZeroPages &) { return false; }
};

} // namespace latcon::support

// A std::vector whose resize() leaves new elements of trivial types uninitialised: large arrays that are
// written once, in parallel, should not be touched twice.
#pragma once

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace levelray {

template <class T>
struct UninitializedAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UninitializedAllocator<U>;
  };
  static constexpr std::size_t alignment = 64; // a cache line, and the widest vector

  T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(alignment)));
  }
  void deallocate(T* p, std::size_t) noexcept { ::operator delete(p, std::align_val_t(alignment)); }
  template <class U>
  void construct(U* p) noexcept {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
};

template <class T>
using uninitialized_vector = std::vector<T, UninitializedAllocator<T>>;

} // namespace levelray

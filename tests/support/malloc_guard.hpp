// Counts heap allocations of the calling thread during its lifetime. Link tests/support/malloc_guard.cpp,
// which interposes malloc.
#pragma once

#include <cstddef>

namespace swiftlet::test {

class MallocGuard {
 public:
  MallocGuard();
  ~MallocGuard();
  MallocGuard(const MallocGuard&) = delete;
  MallocGuard& operator=(const MallocGuard&) = delete;

  // Calls of malloc, calloc, realloc, aligned_alloc, memalign, posix_memalign and free since construction.
  std::size_t calls() const;
};

}  // namespace swiftlet::test

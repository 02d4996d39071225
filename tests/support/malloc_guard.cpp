#include "tests/support/malloc_guard.hpp"

#include <cerrno>
#include <cstdlib>

// glibc's own entry points, behind the names that are interposed below.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);
}
// NOLINTEND(bugprone-reserved-identifier)

namespace {

thread_local bool guarded = false;
thread_local std::size_t call_count = 0;

void count_call() {
  if (guarded) ++call_count;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) {
  count_call();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  count_call();
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  count_call();
  return __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  count_call();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count_call();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  count_call();
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
void free(void* block) {
  count_call();
  __libc_free(block);
}

}  // extern "C"

namespace swiftlet::test {

MallocGuard::MallocGuard() {
  call_count = 0;
  guarded = true;
}
MallocGuard::~MallocGuard() { guarded = false; }
std::size_t MallocGuard::calls() const { return call_count; }

}  // namespace swiftlet::test

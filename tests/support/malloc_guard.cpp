#include "tests/support/malloc_guard.hpp"

#include <cerrno>
#include <cstdlib>

namespace {

thread_local bool guarded = false;
thread_local std::size_t call_count = 0;

void count_call() {
  if (guarded) ++call_count;
}

}  // namespace

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

// The sanitizer interposes malloc itself and calls hooks. Debian's GCC has its runtime without the header.
// NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                                         void (*on_free)(const volatile void*));

namespace {

[[maybe_unused]] const int kInstalled = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { count_call(); }, [](const volatile void*) { count_call(); });

}  // namespace

#else

// glibc's own entry points behind the functions interposed below.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

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

#endif

namespace swiftlet::test {

MallocGuard::MallocGuard() {
  call_count = 0;
  guarded = true;
}
MallocGuard::~MallocGuard() { guarded = false; }
std::size_t MallocGuard::calls() const { return call_count; }

}  // namespace swiftlet::test

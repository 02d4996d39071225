// Replaces the read-write locks of glibc in the program that it is linked into: those that pthread_rwlock_init() makes, as
// OpenSSL's, become mutexes with priority inheritance. Locks with a static initializer, such as std::shared_mutex, stay as
// they are.
//
// With security OpenSSL takes locks of the whole process for each datagram. A writer of glibc's lock spins while the
// holder is between two of the steps that take or release it. If a thread of ordinary priority is preempted there, two
// SCHED_FIFO threads that spin on two cores keep it from ever going on: the flight stands until the kernel throttles them.
// OpenSSL does not need two readers at once: where there are no read-write locks, it uses mutexes.
#include <cerrno>
#include <ctime>
#include <dlfcn.h>
#include <new>
#include <pthread.h>

namespace {

constexpr unsigned kMark = 0x5cf17e75;  // glibc's lock begins with a number of readers, which stays far below

struct Lock {
  unsigned mark;
  pthread_mutex_t mutex;
};
static_assert(sizeof(Lock) <= sizeof(pthread_rwlock_t) && alignof(Lock) <= alignof(pthread_rwlock_t));

// The mutex in place of the lock; nullptr if the lock is glibc's.
pthread_mutex_t* mutex_of(pthread_rwlock_t* lock) {
  auto* const own = reinterpret_cast<Lock*>(lock);
  return __atomic_load_n(&own->mark, __ATOMIC_RELAXED) == kMark ? &own->mutex : nullptr;
}

// glibc's function that `Function` replaces.
template <auto* Function>
auto* replaced(const char* name) {
  static auto* const function = reinterpret_cast<decltype(Function)>(dlsym(RTLD_NEXT, name));
  return function;
}
#define SWIFTLET_REPLACED(Function) replaced<&Function>(#Function)

}  // namespace

extern "C" {

int pthread_rwlock_init(pthread_rwlock_t* lock, const pthread_rwlockattr_t* attributes) noexcept {
  if (attributes != nullptr) return SWIFTLET_REPLACED(pthread_rwlock_init)(lock, attributes);
  pthread_mutexattr_t inherits;
  pthread_mutexattr_init(&inherits);
  pthread_mutexattr_setprotocol(&inherits, PTHREAD_PRIO_INHERIT);
  auto* const own = new (lock) Lock{kMark, {}};
  const int result = pthread_mutex_init(&own->mutex, &inherits);
  pthread_mutexattr_destroy(&inherits);
  return result;
}

int pthread_rwlock_destroy(pthread_rwlock_t* lock) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  if (mutex == nullptr) return SWIFTLET_REPLACED(pthread_rwlock_destroy)(lock);
  reinterpret_cast<Lock*>(lock)->mark = 0;
  return pthread_mutex_destroy(mutex);
}

int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  return mutex != nullptr ? pthread_mutex_lock(mutex) : SWIFTLET_REPLACED(pthread_rwlock_rdlock)(lock);
}

int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  return mutex != nullptr ? pthread_mutex_lock(mutex) : SWIFTLET_REPLACED(pthread_rwlock_wrlock)(lock);
}

int pthread_rwlock_tryrdlock(pthread_rwlock_t* lock) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  return mutex != nullptr ? pthread_mutex_trylock(mutex) : SWIFTLET_REPLACED(pthread_rwlock_tryrdlock)(lock);
}

int pthread_rwlock_trywrlock(pthread_rwlock_t* lock) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  return mutex != nullptr ? pthread_mutex_trylock(mutex) : SWIFTLET_REPLACED(pthread_rwlock_trywrlock)(lock);
}

int pthread_rwlock_timedrdlock(pthread_rwlock_t* lock, const timespec* until) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  return mutex != nullptr ? pthread_mutex_timedlock(mutex, until)
                          : SWIFTLET_REPLACED(pthread_rwlock_timedrdlock)(lock, until);
}

int pthread_rwlock_timedwrlock(pthread_rwlock_t* lock, const timespec* until) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  return mutex != nullptr ? pthread_mutex_timedlock(mutex, until)
                          : SWIFTLET_REPLACED(pthread_rwlock_timedwrlock)(lock, until);
}

int pthread_rwlock_clockrdlock(pthread_rwlock_t* lock, clockid_t clock, const timespec* until) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  return mutex != nullptr ? pthread_mutex_clocklock(mutex, clock, until)
                          : SWIFTLET_REPLACED(pthread_rwlock_clockrdlock)(lock, clock, until);
}

int pthread_rwlock_clockwrlock(pthread_rwlock_t* lock, clockid_t clock, const timespec* until) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  return mutex != nullptr ? pthread_mutex_clocklock(mutex, clock, until)
                          : SWIFTLET_REPLACED(pthread_rwlock_clockwrlock)(lock, clock, until);
}

int pthread_rwlock_unlock(pthread_rwlock_t* lock) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  return mutex != nullptr ? pthread_mutex_unlock(mutex) : SWIFTLET_REPLACED(pthread_rwlock_unlock)(lock);
}

}  // extern "C"

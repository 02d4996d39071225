// Lets the locks of the program that it is linked into hand down priority: who holds one runs with the priority of the highest
// that waits for it. That are all mutexes, of Fast DDS and the standard library too, which cannot be asked for it, and the
// read-write locks that pthread_rwlock_init() makes, as OpenSSL's.
//
// Fast DDS takes locks of the participant to send and to receive a datagram, also while it takes in a process that joins.
// With mutexes of glibc a real-time thread waits there until threads of ordinary priority have let the holder run.
// With security OpenSSL takes locks of the whole process for each datagram. A writer of glibc's read-write lock spins while
// the holder is between two of the steps that take or release it. If a thread of ordinary priority is preempted there,
// two SCHED_FIFO threads that spin on two cores keep it from ever going on: the flight stands until the kernel throttles
// them. OpenSSL does not need two readers at once: where there are no read-write locks, it uses mutexes.
//
// Locks that are neither keep glibc's way: std::shared_mutex and others with a static initializer, and what is shared
// between processes or has a protocol already.
#include <array>
#include <cerrno>
#include <cstddef>
#include <ctime>
#include <dlfcn.h>
#include <new>
#include <pthread.h>

namespace {

// glibc's function that `Function` replaces.
template <auto* Function>
auto* replaced(const char* name) {
  static auto* const function = reinterpret_cast<decltype(Function)>(dlsym(RTLD_NEXT, name));
  return function;
}
#define SWIFTLET_REPLACED(Function) replaced<&Function>(#Function)

// Of a mutex without a protocol it is the type. Static initializers set it: its place and these values stay as they are.
int& kind_of(pthread_mutex_t& mutex) { return mutex.__data.__kind; }

int inheriting_kind(int type) {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_settype(&attributes, type);
  pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
  pthread_mutex_t mutex;
  pthread_mutex_init(&mutex, &attributes);
  pthread_mutexattr_destroy(&attributes);
  return kind_of(mutex);
}

// Each lock of a mutex calls this first, so that nobody holds one that is still of another kind.
void let_inherit(pthread_mutex_t& mutex) {
  static_assert(PTHREAD_MUTEX_NORMAL == 0 && PTHREAD_MUTEX_RECURSIVE == 1 && PTHREAD_MUTEX_ERRORCHECK == 2);
  static const std::array<int, 3> kInheriting{inheriting_kind(0), inheriting_kind(1), inheriting_kind(2)};
  int kind = __atomic_load_n(&kind_of(mutex), __ATOMIC_RELAXED);
  if (kind < PTHREAD_MUTEX_NORMAL || kind > PTHREAD_MUTEX_ERRORCHECK) return;
  const int inheriting = kInheriting[static_cast<std::size_t>(kind)];
  __atomic_compare_exchange_n(&kind_of(mutex), &kind, inheriting, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
}

// A time of a clock as one of the wall clock.
timespec by_wall_clock(clockid_t clock, const timespec& time) {
  timespec now{};
  timespec wall{};
  clock_gettime(clock, &now);
  clock_gettime(CLOCK_REALTIME, &wall);
  constexpr long kSecond_ns = 1'000'000'000;
  timespec result{wall.tv_sec + time.tv_sec - now.tv_sec, wall.tv_nsec + time.tv_nsec - now.tv_nsec};
  for (; result.tv_nsec < 0; --result.tv_sec) result.tv_nsec += kSecond_ns;
  for (; result.tv_nsec >= kSecond_ns; ++result.tv_sec) result.tv_nsec -= kSecond_ns;
  return result;
}

// In place of a read-write lock.
struct Lock {
  static constexpr unsigned kMark =
      0x5cf17e75;  // glibc's begins with a number of readers, which stays far below

  unsigned mark = kMark;
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
};
static_assert(sizeof(Lock) <= sizeof(pthread_rwlock_t) && alignof(Lock) <= alignof(pthread_rwlock_t));

// nullptr if the lock is glibc's.
pthread_mutex_t* mutex_of(pthread_rwlock_t* lock) {
  auto* const own = reinterpret_cast<Lock*>(lock);
  return __atomic_load_n(&own->mark, __ATOMIC_RELAXED) == Lock::kMark ? &own->mutex : nullptr;
}

// Calls a function of the mutex in place of a lock, or the one of glibc.
template <auto* OfLock, auto* OfMutex, class... Arguments>
int locked(const char* name, pthread_rwlock_t* lock, Arguments... arguments) {
  pthread_mutex_t* const mutex = mutex_of(lock);
  return mutex != nullptr ? OfMutex(mutex, arguments...) : replaced<OfLock>(name)(lock, arguments...);
}
#define SWIFTLET_LOCKED(OfLock, OfMutex, ...) locked<&OfLock, &OfMutex>(#OfLock, __VA_ARGS__)

}  // namespace

extern "C" {

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  let_inherit(*mutex);
  return SWIFTLET_REPLACED(pthread_mutex_lock)(mutex);
}

int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  let_inherit(*mutex);
  return SWIFTLET_REPLACED(pthread_mutex_trylock)(mutex);
}

int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* until) noexcept {
  let_inherit(*mutex);
  return SWIFTLET_REPLACED(pthread_mutex_timedlock)(mutex, until);
}

int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock, const timespec* until) noexcept {
  let_inherit(*mutex);
  const int result = SWIFTLET_REPLACED(pthread_mutex_clocklock)(mutex, clock, until);
  // Before Linux 5.14 such a mutex is waited for by the wall clock only.
  if (result != EINVAL || clock == CLOCK_REALTIME) return result;
  const timespec wall = by_wall_clock(clock, *until);
  return SWIFTLET_REPLACED(pthread_mutex_timedlock)(mutex, &wall);
}

int pthread_rwlock_init(pthread_rwlock_t* lock, const pthread_rwlockattr_t* attributes) noexcept {
  if (attributes != nullptr) return SWIFTLET_REPLACED(pthread_rwlock_init)(lock, attributes);
  new (lock) Lock;
  return 0;
}

int pthread_rwlock_destroy(pthread_rwlock_t* lock) noexcept {
  pthread_mutex_t* const mutex = mutex_of(lock);
  if (mutex == nullptr) return SWIFTLET_REPLACED(pthread_rwlock_destroy)(lock);
  reinterpret_cast<Lock*>(lock)->mark = 0;
  return pthread_mutex_destroy(mutex);
}

int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  return SWIFTLET_LOCKED(pthread_rwlock_rdlock, pthread_mutex_lock, lock);
}

int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  return SWIFTLET_LOCKED(pthread_rwlock_wrlock, pthread_mutex_lock, lock);
}

int pthread_rwlock_tryrdlock(pthread_rwlock_t* lock) noexcept {
  return SWIFTLET_LOCKED(pthread_rwlock_tryrdlock, pthread_mutex_trylock, lock);
}

int pthread_rwlock_trywrlock(pthread_rwlock_t* lock) noexcept {
  return SWIFTLET_LOCKED(pthread_rwlock_trywrlock, pthread_mutex_trylock, lock);
}

int pthread_rwlock_timedrdlock(pthread_rwlock_t* lock, const timespec* until) noexcept {
  return SWIFTLET_LOCKED(pthread_rwlock_timedrdlock, pthread_mutex_timedlock, lock, until);
}

int pthread_rwlock_timedwrlock(pthread_rwlock_t* lock, const timespec* until) noexcept {
  return SWIFTLET_LOCKED(pthread_rwlock_timedwrlock, pthread_mutex_timedlock, lock, until);
}

int pthread_rwlock_clockrdlock(pthread_rwlock_t* lock, clockid_t clock, const timespec* until) noexcept {
  return SWIFTLET_LOCKED(pthread_rwlock_clockrdlock, pthread_mutex_clocklock, lock, clock, until);
}

int pthread_rwlock_clockwrlock(pthread_rwlock_t* lock, clockid_t clock, const timespec* until) noexcept {
  return SWIFTLET_LOCKED(pthread_rwlock_clockwrlock, pthread_mutex_clocklock, lock, clock, until);
}

int pthread_rwlock_unlock(pthread_rwlock_t* lock) noexcept {
  return SWIFTLET_LOCKED(pthread_rwlock_unlock, pthread_mutex_unlock, lock);
}

}  // extern "C"

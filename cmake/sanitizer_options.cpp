// Options of the sanitizer runtimes, linked into every program of a sanitizer build.
#include <ctime>
#include <pthread.h>
#include <semaphore.h>

extern "C" {

// Debian's Fast DDS deletes its own objects through a base class with sized delete. The mismatch stays
// inside the library.
const char* __asan_default_options() { return "new_delete_type_mismatch=0"; }

const char* __ubsan_default_options() { return "print_stacktrace=1"; }

#ifdef __SANITIZE_THREAD__

// Fast DDS and spdlog are not built with the sanitizer, which sees their locks but not their atomics. Fast
// DDS locks some mutexes recursively; spdlog counts references to a logger with atomics.
const char* __tsan_default_suppressions() {
  return "deadlock:libfastrtps.so\n"
         "deadlock:libfastdds.so\n"
         "race:libspdlog.so\n";
}

// Converts an absolute time from `clock` to CLOCK_REALTIME, the clock of the functions that the sanitizer
// intercepts.
static timespec by_real_time(clockid_t clock, const timespec* until) {
  constexpr long kSecond_ns = 1'000'000'000;
  timespec now{};
  timespec real{};
  clock_gettime(clock, &now);
  clock_gettime(CLOCK_REALTIME, &real);
  real.tv_sec += until->tv_sec - now.tv_sec;
  real.tv_nsec += until->tv_nsec - now.tv_nsec;
  if (real.tv_nsec < 0) {
    --real.tv_sec;
    real.tv_nsec += kSecond_ns;
  } else if (real.tv_nsec >= kSecond_ns) {
    ++real.tv_sec;
    real.tv_nsec -= kSecond_ns;
  }
  return real;
}

// The sanitizer runtime of GCC 12 does not intercept these functions, which std::timed_mutex and
// services::Semaphore use. They are mapped to functions that it intercepts.
int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock, const timespec* until) noexcept {
  const timespec real = by_real_time(clock, until);
  return pthread_mutex_timedlock(mutex, &real);
}
int sem_clockwait(sem_t* semaphore, clockid_t clock, const timespec* until) {
  const timespec real = by_real_time(clock, until);
  return sem_timedwait(semaphore, &real);
}

#endif
}

// A mutex between real-time threads and others: who holds it runs with the priority of the highest that waits for it, so
// that no thread of a priority between theirs holds up the real-time one.
#pragma once

#include <pthread.h>

namespace swiftlet::runtime {

// Meets the requirements of std::lock_guard.
class PriorityInheritingMutex {
 public:
  PriorityInheritingMutex() {
    pthread_mutexattr_t inherits;
    pthread_mutexattr_init(&inherits);
    pthread_mutexattr_setprotocol(&inherits, PTHREAD_PRIO_INHERIT);
    pthread_mutex_init(&mutex_, &inherits);
    pthread_mutexattr_destroy(&inherits);
  }
  ~PriorityInheritingMutex() { pthread_mutex_destroy(&mutex_); }
  PriorityInheritingMutex(const PriorityInheritingMutex&) = delete;
  PriorityInheritingMutex& operator=(const PriorityInheritingMutex&) = delete;

  void lock() noexcept { pthread_mutex_lock(&mutex_); }
  void unlock() noexcept { pthread_mutex_unlock(&mutex_); }

 private:
  pthread_mutex_t mutex_;
};

}  // namespace swiftlet::runtime

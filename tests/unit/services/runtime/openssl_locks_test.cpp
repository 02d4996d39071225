// The read-write locks of this program are those of openssl_locks.cpp.
#include <cerrno>
#include <ctime>
#include <fstream>
#include <future>
#include <openssl/crypto.h>
#include <pthread.h>
#include <shared_mutex>
#include <sstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "swiftlet/services/runtime/realtime.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet::runtime {
namespace {

using namespace std::chrono_literals;

// Calls f in another thread.
template <class F>
auto elsewhere(const F& f) {
  return std::async(std::launch::async, f).get();
}

// The kernel's, proc_pid_stat(5): below 0 for real-time scheduling, also if it is inherited.
int priority_of_this_thread() {
  std::ifstream file("/proc/thread-self/stat");
  std::string stat;
  std::getline(file, stat);
  std::istringstream fields(stat.substr(stat.rfind(')') + 2));
  std::string field;
  for (int number = 3; number <= 18; ++number) fields >> field;
  return std::stoi(field);
}

TEST(OpenSslLocks, AreExclusive) {
  CRYPTO_RWLOCK* const lock = CRYPTO_THREAD_lock_new();
  auto* const own = static_cast<pthread_rwlock_t*>(lock);
  ASSERT_EQ(CRYPTO_THREAD_read_lock(lock), 1);
  EXPECT_EQ(elsewhere([&] { return pthread_rwlock_tryrdlock(own); }), EBUSY);
  EXPECT_EQ(elsewhere([&] { return pthread_rwlock_trywrlock(own); }), EBUSY);
  const timespec past{1, 0};
  EXPECT_EQ(elsewhere([&] { return pthread_rwlock_timedrdlock(own, &past); }), ETIMEDOUT);
  EXPECT_EQ(elsewhere([&] { return pthread_rwlock_timedwrlock(own, &past); }), ETIMEDOUT);
  EXPECT_EQ(elsewhere([&] { return pthread_rwlock_clockrdlock(own, CLOCK_MONOTONIC, &past); }), ETIMEDOUT);
  EXPECT_EQ(elsewhere([&] { return pthread_rwlock_clockwrlock(own, CLOCK_MONOTONIC, &past); }), ETIMEDOUT);
  EXPECT_EQ(CRYPTO_THREAD_unlock(lock), 1);
  EXPECT_EQ(elsewhere([&] { return pthread_rwlock_trywrlock(own) == 0 && pthread_rwlock_unlock(own) == 0; }),
            true);
  CRYPTO_THREAD_lock_free(lock);
}

TEST(OpenSslLocks, HolderInheritsThePriorityOfWhoWaits) {
  CRYPTO_RWLOCK* const lock = CRYPTO_THREAD_lock_new();
  ASSERT_EQ(CRYPTO_THREAD_write_lock(lock), 1);
  ASSERT_GE(priority_of_this_thread(), 0);
  std::promise<std::string> refusal;
  std::thread waiting([&] {
    refusal.set_value(make_this_thread_realtime({true, 50}));
    CRYPTO_THREAD_write_lock(lock);
    CRYPTO_THREAD_unlock(lock);
  });
  const std::string refused = refusal.get_future().get();
  const bool inherited = refused.empty() && tests::eventually([] { return priority_of_this_thread() < 0; });
  CRYPTO_THREAD_unlock(lock);
  waiting.join();
  CRYPTO_THREAD_lock_free(lock);
  if (!refused.empty()) GTEST_SKIP() << refused;
  EXPECT_TRUE(inherited);
  EXPECT_GE(priority_of_this_thread(), 0);
}

TEST(OpenSslLocks, OthersStayReadWriteLocks) {
  std::shared_mutex mutex;
  mutex.lock_shared();
  EXPECT_TRUE(elsewhere([&] {
    const bool shared = mutex.try_lock_shared();
    if (shared) mutex.unlock_shared();
    return shared;
  }));
  EXPECT_FALSE(elsewhere([&] { return mutex.try_lock(); }));
  mutex.unlock_shared();
  EXPECT_TRUE(elsewhere([&] {
    mutex.lock();
    mutex.unlock();
    return true;
  }));

  pthread_rwlockattr_t attributes;
  pthread_rwlockattr_init(&attributes);
  pthread_rwlock_t lock;
  ASSERT_EQ(pthread_rwlock_init(&lock, &attributes), 0);
  EXPECT_EQ(pthread_rwlock_rdlock(&lock), 0);
  EXPECT_EQ(elsewhere([&] { return pthread_rwlock_tryrdlock(&lock); }), 0);
  EXPECT_EQ(pthread_rwlock_trywrlock(&lock), EBUSY);
  pthread_rwlock_unlock(&lock);
  pthread_rwlock_unlock(&lock);
  EXPECT_EQ(pthread_rwlock_destroy(&lock), 0);
  pthread_rwlockattr_destroy(&attributes);
}

}  // namespace
}  // namespace swiftlet::runtime

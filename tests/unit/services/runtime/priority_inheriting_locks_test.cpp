// The locks of this program are those of priority_inheriting_locks.cpp.
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <future>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <mutex>
#include <openssl/crypto.h>
#include <pthread.h>
#include <shared_mutex>
#include <sstream>
#include <string>
#include <sys/prctl.h>
#include <sys/syscall.h>
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

// CRYPTO_RWLOCK as the standard library has its mutexes.
class OpenSslLock {
 public:
  ~OpenSslLock() { CRYPTO_THREAD_lock_free(lock_); }
  void lock() { CRYPTO_THREAD_write_lock(lock_); }
  void unlock() { CRYPTO_THREAD_unlock(lock_); }

 private:
  CRYPTO_RWLOCK* const lock_ = CRYPTO_THREAD_lock_new();
};

// Waits with a limit, as Fast DDS does.
template <class Mutex>
class WithLimit {
 public:
  void lock() { ASSERT_TRUE(mutex_.try_lock_for(tests::kStuck)); }
  void unlock() { mutex_.unlock(); }

 private:
  Mutex mutex_;
};

template <class Lock>
class PriorityInheritingLock : public testing::Test {};
using Locks = testing::Types<OpenSslLock, std::mutex, std::recursive_mutex, WithLimit<std::timed_mutex>,
                             WithLimit<std::recursive_timed_mutex>>;
TYPED_TEST_SUITE(PriorityInheritingLock, Locks);

TYPED_TEST(PriorityInheritingLock, HolderHasThePriorityOfWhoWaits) {
  TypeParam lock;
  lock.lock();
  ASSERT_GE(priority_of_this_thread(), 0);
  std::promise<std::string> refusal;
  std::thread waiting([&] {
    refusal.set_value(make_this_thread_realtime({true, 50}));
    lock.lock();
    lock.unlock();
  });
  const std::string refused = refusal.get_future().get();
  const bool inherited = refused.empty() && tests::eventually([] { return priority_of_this_thread() < 0; });
  lock.unlock();
  waiting.join();
  if (!refused.empty()) GTEST_SKIP() << refused;
  EXPECT_TRUE(inherited);
  EXPECT_GE(priority_of_this_thread(), 0);
}

TEST(PriorityInheritingMutexes, KeepTheirTypes) {
  std::recursive_mutex recursive;
  recursive.lock();
  EXPECT_TRUE(recursive.try_lock());
  EXPECT_FALSE(elsewhere([&] { return recursive.try_lock(); }));
  recursive.unlock();
  EXPECT_FALSE(elsewhere([&] { return recursive.try_lock(); }));
  recursive.unlock();
  EXPECT_TRUE(elsewhere([&] { return recursive.try_lock() && (recursive.unlock(), true); }));

  pthread_mutex_t checked = PTHREAD_ERRORCHECK_MUTEX_INITIALIZER_NP;
  EXPECT_EQ(pthread_mutex_lock(&checked), 0);
  EXPECT_EQ(pthread_mutex_lock(&checked), EDEADLK);
  EXPECT_EQ(elsewhere([&] { return pthread_mutex_unlock(&checked); }), EPERM);
  EXPECT_EQ(pthread_mutex_unlock(&checked), 0);
}

TEST(PriorityInheritingMutexes, AreReleasedWhileAConditionIsWaitedFor) {
  std::mutex mutex;
  std::condition_variable changed;
  int turn = 0;
  const auto take = [&](int own) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return turn == own; });
    ++turn;
    changed.notify_all();
  };
  const auto second = std::async(std::launch::async, take, 1);
  take(0);
  std::unique_lock lock(mutex);
  EXPECT_TRUE(changed.wait_for(lock, tests::kStuck, [&] { return turn == 2; }));
}

// Refuses FUTEX_LOCK_PI2 to this process, as kernels before Linux 5.14.
bool refuse_to_wait_by_the_monotonic_clock() {
  constexpr unsigned kCommand = 0x7f;  // without the flags of a futex operation
  constexpr unsigned kLockPi2 = 13;
  std::array<sock_filter, 7> filter{{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_futex, 0, 4),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[1])),
      BPF_STMT(BPF_ALU | BPF_AND | BPF_K, kCommand),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kLockPi2, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOSYS),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  }};
  const sock_fprog program{filter.size(), filter.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

TEST(PriorityInheritingMutexes, AreWaitedForAlsoWithoutTheMonotonicClock) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        if (!refuse_to_wait_by_the_monotonic_clock()) std::exit(2);
        std::timed_mutex mutex;
        mutex.lock();
        const auto begin = std::chrono::steady_clock::now();
        const bool locked = elsewhere([&] { return mutex.try_lock_for(50ms); });
        const bool waited = std::chrono::steady_clock::now() - begin >= 50ms;
        auto waiting = std::async(std::launch::async, [&] { return mutex.try_lock_for(tests::kStuck); });
        mutex.unlock();
        std::exit(!locked && waited && waiting.get() ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

TEST(ReadWriteLocks, OthersStay) {
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

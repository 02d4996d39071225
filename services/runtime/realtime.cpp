#include "swiftlet/services/runtime/realtime.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace swiftlet::runtime {
namespace {

// With CAP_IPC_LOCK a process has no limit on locked memory.
bool may_lock_without_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  constexpr unsigned long long kCapIpcLock = 1ULL << 14;
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("CapEff:", 0) == 0) return (std::stoull(line.substr(7), nullptr, 16) & kCapIpcLock) != 0;
  }
  return false;
}

void add(std::string& refusals, const std::string& refusal) {
  refusals += (refusals.empty() ? "" : ", ") + refusal;
}

}  // namespace

void limit_thread_stacks() {
  constexpr std::size_t kStackBytes = std::size_t{1} << 20;
  pthread_attr_t attributes;
  if (pthread_getattr_default_np(&attributes) != 0) return;
  if (pthread_attr_setstacksize(&attributes, kStackBytes) == 0) pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

std::string lock_memory() {
  if (!may_lock_without_limit()) return "memory is not locked (RLIMIT_MEMLOCK is limited)";
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    return std::string("memory is not locked (") + std::strerror(errno) + ")";
  return {};
}

std::string make_this_thread_realtime(const RealtimeSettings& settings) {
  std::string refusals;
  if (settings.cpu >= 0) {
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    if (settings.cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(settings.cpu), &cpus);
    const int error = pthread_setaffinity_np(pthread_self(), sizeof cpus, &cpus);
    if (error != 0) {
      add(refusals,
          "core " + std::to_string(settings.cpu) + " is not granted (" + std::strerror(error) + ")");
    }
  }
  sched_param parameters{};
  parameters.sched_priority = settings.priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error != 0) {
    add(refusals,
        "SCHED_FIFO " + std::to_string(settings.priority) + " is not granted (" + std::strerror(error) + ")");
  }
  return refusals;
}

bool this_thread_is_realtime() {
  int policy = SCHED_OTHER;
  sched_param parameters{};
  return pthread_getschedparam(pthread_self(), &policy, &parameters) == 0 && policy == SCHED_FIFO;
}

RealtimeScope::RealtimeScope(int priority) {
  if (priority == 0 || this_thread_is_realtime()) return;
  sched_param parameters{};
  parameters.sched_priority = priority;
  raised_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

RealtimeScope::~RealtimeScope() {
  if (raised_) make_this_thread_ordinary();
}

void make_this_thread_ordinary() {
  const sched_param parameters{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &parameters);
}

// Compares kernel thread IDs: a new thread often gets the pthread_t of an ended one.
void RealtimeThread::enter(const RealtimeSettings& settings) {
  static thread_local const pid_t this_thread = ::gettid();
  if (thread_.load(std::memory_order_relaxed) == this_thread) return;
  if (settings.enabled) make_this_thread_realtime(settings);
  thread_.store(this_thread, std::memory_order_relaxed);
}

bool RealtimeThread::is_realtime() const {
  const pid_t thread = thread_.load(std::memory_order_relaxed);
  return thread != 0 && ::sched_getscheduler(thread) == SCHED_FIFO;
}

}  // namespace swiftlet::runtime

// Memory locking, SCHED_FIFO and CPU affinity, where the system permits them.
#pragma once

#include <atomic>
#include <string>
#include <sys/types.h>

namespace swiftlet::runtime {

struct RealtimeSettings {
  bool enabled = true;
  int priority = 0;  // SCHED_FIFO, 1 .. 99
  int cpu = -1;      // CPU core of the real-time thread; -1: any

  int thread_priority() const { return enabled ? priority : 0; }  // 0: ordinary
};

// Sets the stack size of new threads to 1 MiB instead of the system's 8 MiB. With locked memory the kernel
// allocates and clears all pages of a stack before the thread runs.
void limit_thread_stacks();

// Locks all present and future memory of the process, unless a limit on locked memory would make later
// allocations fail. Returns what was refused, as a clause for a message; empty if nothing.
std::string lock_memory();

// Gives the calling thread SCHED_FIFO and pins it to the core. Only for threads that wait for a sample or a
// timer between short steps: a spinning thread would starve the others on its core. Returns what was refused,
// as a clause for a message; empty if nothing.
std::string make_this_thread_realtime(const RealtimeSettings& settings);

// Returns whether the calling thread has SCHED_FIFO.
bool this_thread_is_realtime();

// Gives the calling thread SCHED_FIFO while it exists, if the system permits that and the thread has it not yet. For threads of
// ordinary priority that take locks for which real-time threads wait: nothing but real-time threads keeps them from running
// meanwhile. Threads that are started meanwhile have it too.
class RealtimeScope {
 public:
  explicit RealtimeScope(int priority);  // 0: no effect
  ~RealtimeScope();
  RealtimeScope(const RealtimeScope&) = delete;
  RealtimeScope& operator=(const RealtimeScope&) = delete;

 private:
  bool raised_ = false;
};

// Takes SCHED_FIFO from the calling thread, which may have it from the one that started it.
void make_this_thread_ordinary();

// The thread that currently runs the real-time steps; the middleware may replace it by another thread.
class RealtimeThread {
 public:
  // That thread calls this before each step. The first call of a thread makes it real-time if that is
  // enabled; later calls cost a comparison.
  void enter(const RealtimeSettings& settings);

  // Returns whether the thread of the last enter() has SCHED_FIFO now; false if none entered or it has ended.
  bool is_realtime() const;
  bool has_entered() const { return thread_.load(std::memory_order_relaxed) != 0; }

 private:
  std::atomic<pid_t> thread_{0};
};

}  // namespace swiftlet::runtime

// Locked memory, SCHED_FIFO and the choice of a core, where the system permits them.
#pragma once

#include <atomic>
#include <string>
#include <sys/types.h>

namespace swiftlet::runtime {

struct RealtimeSettings {
  bool enabled = true;
  int priority = 0;  // SCHED_FIFO, 1 .. 99
  int cpu = -1;      // core of the thread that counts; -1: any
};

// Gives threads that start from now on a stack of 1 MiB instead of the system's 8 MiB, of which locked memory
// would take every page and fill it with zeros before the thread runs.
void limit_thread_stacks();

// Locks all memory of the process, present and future, if that can be done without a limit that would make
// later allocations fail. Returns what was refused, as half a sentence, or nothing.
std::string lock_memory();

// Gives the calling thread SCHED_FIFO and pins it to the core. For threads that wait for a sample or a timer
// between short steps; one that spins would starve the others on its core. Returns what was refused, as half
// a sentence, or nothing.
std::string make_this_thread_realtime(const RealtimeSettings& settings);

// Whether the calling thread has SCHED_FIFO.
bool this_thread_is_realtime();

// The thread that does what counts, whichever it is: the middleware may end it and begin another in its place.
class RealtimeThread {
 public:
  // By that thread, before each of its steps: the first call of each thread makes it real-time, if that is
  // enabled. Later ones cost a comparison.
  void enter(const RealtimeSettings& settings);

  // Whether the one that entered last has SCHED_FIFO at this moment; false if none has, or if it has ended.
  bool is_realtime() const;
  bool has_entered() const { return thread_.load(std::memory_order_relaxed) != 0; }

 private:
  std::atomic<pid_t> thread_{0};
};

}  // namespace swiftlet::runtime

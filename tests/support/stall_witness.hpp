// Measures stalls of the machine with a real-time thread on each core that only reads the clock: times in which the core
// served no thread of this priority. On a virtual machine, the host may stop a core. At the highest priority these are the
// stalls of the machine itself, but without permission for real-time priorities they include time taken by other processes.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace swiftlet::tests {

class StallWitness {
 public:
  static constexpr int kHighestPriority = 98;

  // Measures stalls of control cycles of period_ns. priority: SCHED_FIFO.
  explicit StallWitness(std::int64_t period_ns, int priority = kHighestPriority);
  ~StallWitness();
  StallWitness(const StallWitness&) = delete;
  StallWitness& operator=(const StallWitness&) = delete;

  // Percentage of cycles that could not be answered within a period because the core stalled, on the worst
  // core.
  double lost_percent() const;

  // The longest stall of a core since the last call. A stall that has not ended does not count.
  std::int64_t take_longest_ns();

 private:
  struct Core {
    std::atomic<std::int64_t> elapsed_ns{0};
    std::atomic<std::int64_t> lost_ns{0};     // sum of stalls, each beyond one period
    std::atomic<std::int64_t> longest_ns{0};  // since take_longest_ns()
    std::thread thread;
  };
  void watch(Core& core, int cpu);

  const std::int64_t period_ns_;
  const int priority_;
  std::atomic<bool> end_{false};
  std::vector<std::unique_ptr<Core>> cores_;
};

}  // namespace swiftlet::tests

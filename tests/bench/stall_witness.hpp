// Measures stalls of the machine itself with a thread of the highest priority on each core that only reads
// the clock. Without permission for real-time priorities, the result includes time taken by other processes.
// On a virtual machine, the host may stop a core.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace swiftlet::bench {

class StallWitness {
 public:
  // Measures stalls of control cycles of period_ns.
  explicit StallWitness(std::int64_t period_ns);
  ~StallWitness();
  StallWitness(const StallWitness&) = delete;
  StallWitness& operator=(const StallWitness&) = delete;

  // Percentage of cycles that could not be answered within a period because the core stalled, on the worst
  // core.
  double lost_percent() const;

 private:
  struct Core {
    std::atomic<std::int64_t> elapsed_ns{0};
    std::atomic<std::int64_t> lost_ns{0};  // sum of stalls, each beyond one period
    std::thread thread;
  };
  void watch(Core& core, int cpu);

  const std::int64_t period_ns_;
  std::atomic<bool> end_{false};
  std::vector<std::unique_ptr<Core>> cores_;
};

}  // namespace swiftlet::bench

// What the computer itself takes from every process: a thread on each core, above all others, that does
// nothing but look at the clock. Without the right to real-time priorities it sees what other processes take,
// too. On a virtual machine the host stops cores; nothing that runs on them can answer meanwhile.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace swiftlet::bench {

class StallWitness {
 public:
  // Of cycles of period_ns.
  explicit StallWitness(std::int64_t period_ns);
  ~StallWitness();
  StallWitness(const StallWitness&) = delete;
  StallWitness& operator=(const StallWitness&) = delete;

  // Of the cycles of the core that lost most, how many could not be answered within a period because the core
  // stood still, in percent.
  double lost_percent() const;

 private:
  struct Core {
    std::atomic<std::int64_t> elapsed_ns{0};
    std::atomic<std::int64_t> lost_ns{0};  // beyond a period, of each stall
    std::thread thread;
  };
  void watch(Core& core, int cpu);

  const std::int64_t period_ns_;
  std::atomic<bool> end_{false};
  std::vector<std::unique_ptr<Core>> cores_;
};

}  // namespace swiftlet::bench

// Tells a restarted vehicle from one that goes on. A vehicle whose clock continues, as one with stamps of CLOCK_MONOTONIC, may be
// back within a fraction of a second: it then stands with its rotors off, or falls, and must not get the commands of the flight.
#pragma once

#include <atomic>
#include <cstdint>

#include "swiftlet/services/control/vehicle_sample.hpp"

namespace swiftlet::services {

class VehicleRestarts {
 public:
  // The number in vehicle_info, for a vehicle whose samples have none; 0: not reported. Call from any thread.
  void note_boot(std::uint32_t boot) { reported_boot_.store(boot, std::memory_order_relaxed); }

  // True if the vehicle was restarted since the sample before. Call from the thread of the samples.
  bool sample(const VehicleSample& sample) {
    const std::uint32_t boot =
        sample.obeyed.boot != 0 ? sample.obeyed.boot : reported_boot_.load(std::memory_order_relaxed);
    const bool other_boot = boot != 0 && boot_ != 0 && boot != boot_;
    const bool forgot_commands = obeyed_any_ && sample.obeyed.reported && !sample.obeyed.any;
    // A sample that arrives late has an older stamp too. A vehicle that counts in 16 or 32 bits is not stopped in the air.
    const bool counts_again = sample.sequence() < sequence_ && sample.stamp_ns() > stamp_ns_ &&
                              !wraps(1ULL << 16U, sample.sequence()) &&
                              !wraps(1ULL << 32U, sample.sequence());
    const bool looks_new = boot == 0 && (counts_again || sample.of_another_process);
    if (boot != 0) boot_ = boot;
    obeyed_any_ = sample.obeyed.reported && sample.obeyed.any;
    sequence_ = sample.sequence();
    stamp_ns_ = sample.stamp_ns();
    return other_boot || forgot_commands || looks_new;
  }

 private:
  bool wraps(std::uint64_t count, std::uint64_t sequence) const {
    constexpr std::uint64_t kNear = 100;  // samples may be lost there
    return sequence_ < count && sequence_ + kNear >= count && sequence < kNear;
  }

  std::atomic<std::uint32_t> reported_boot_{0};
  std::uint32_t boot_ = 0;
  bool obeyed_any_ = false;
  std::uint64_t sequence_ = 0;
  std::int64_t stamp_ns_ = 0;
};

}  // namespace swiftlet::services

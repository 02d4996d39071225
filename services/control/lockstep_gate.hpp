// Lockstep: holds a sample of the vehicle, of its IMU or its own estimate, back until the pose, battery and
// rotor-speed samples that it names have arrived, so that every run processes them in the same order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "swiftlet/services/control/vehicle_sample.hpp"

namespace swiftlet::services {

// Not thread-safe.
class LockstepGate {
 public:
  enum class Stream : std::size_t { kPose, kBattery, kRotorSpeeds };

  // Call for each sample of the other streams. Returns false for a repeated sample, which must be ignored.
  bool is_new(Stream stream, std::uint64_t sequence) {
    std::uint64_t& newest = newest_[static_cast<std::size_t>(stream)];
    if (sequence <= newest) return false;
    newest = sequence;
    return true;
  }

  // Call for each such sample. Returns false if take() has returned it before.
  bool offer(const VehicleSample& sample) {
    if (sample.sequence() == let_through_) return false;
    waiting_ = sample;
    return true;
  }

  // Returns the sample to answer now, once; nullopt if there is none or it must wait.
  std::optional<VehicleSample> take() {
    if (!waiting_ || !complete(*waiting_)) return std::nullopt;
    let_through_ = waiting_->sequence();
    return std::exchange(waiting_, std::nullopt);
  }

 private:
  bool complete(const VehicleSample& sample) const {
    return newest_[0] >= sample.mocap_sequence && newest_[1] >= sample.battery_sequence &&
           newest_[2] >= sample.rotor_speeds_sequence;
  }

  std::array<std::uint64_t, 3> newest_{};  // by Stream
  std::optional<VehicleSample> waiting_;
  std::uint64_t let_through_ = 0;
};

}  // namespace swiftlet::services

// Lockstep: holds a sample of the vehicle, of its IMU or its own estimate, back until the pose and the samples of
// other sensors that it names have arrived, so that every run processes them in the same order.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "swiftlet/services/control/vehicle_sample.hpp"

namespace swiftlet::services {

// Not thread-safe.
class LockstepGate {
 public:
  using Stream = std::uint64_t plant::LockstepInputs::*;

  // Call for each sample of the other streams. Returns false for a repeated sample, which must be ignored.
  bool is_new(Stream stream, std::uint64_t sequence) {
    std::uint64_t& newest = newest_.*stream;
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
    bool all = newest_.mocap_pose >= sample.lockstep.mocap_pose;
    plant::for_each_sensor([&all](auto newest, auto named) { all = all && newest >= named; }, newest_,
                           sample.lockstep);
    return all;
  }

  plant::LockstepInputs newest_;
  std::optional<VehicleSample> waiting_;
  std::uint64_t let_through_ = 0;
};

}  // namespace swiftlet::services

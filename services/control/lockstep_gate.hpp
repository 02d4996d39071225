// Lockstep: holds an IMU sample back until the pose, battery and rotor-speed samples that it names have
// arrived, so that every run processes them in the same order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::services {

// Not thread-safe.
class LockstepGate {
 public:
  enum class Stream : std::size_t { kPose, kBattery, kRotorSpeeds };

  // Call for each sample. Returns false for a repeated sample, which must be ignored.
  bool is_new(Stream stream, std::uint64_t sequence) {
    std::uint64_t& newest = newest_[static_cast<std::size_t>(stream)];
    if (sequence <= newest) return false;
    newest = sequence;
    return true;
  }

  // Call for each IMU sample. Returns false if take() has returned it before.
  bool offer(const comms::msg::Imu& imu) {
    if (imu.sequence_number() == let_through_) return false;
    waiting_ = imu;
    return true;
  }

  // Returns the IMU sample to answer now, once; nullopt if there is none or it must wait.
  std::optional<comms::msg::Imu> take() {
    if (!waiting_ || !complete(*waiting_)) return std::nullopt;
    let_through_ = waiting_->sequence_number();
    return std::exchange(waiting_, std::nullopt);
  }

 private:
  bool complete(const comms::msg::Imu& imu) const {
    return newest_[0] >= imu.mocap_sequence_number() && newest_[1] >= imu.battery_sequence_number() &&
           newest_[2] >= imu.rotor_speeds_sequence_number();
  }

  std::array<std::uint64_t, 3> newest_{};  // by Stream
  std::optional<comms::msg::Imu> waiting_;
  std::uint64_t let_through_ = 0;
};

}  // namespace swiftlet::services

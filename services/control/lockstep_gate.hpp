// In lockstep: holds an IMU sample back until the samples that it names have come, so that every run takes
// them in in one order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::services {

// One thread at a time calls it.
class LockstepGate {
 public:
  enum class Stream : std::size_t { kPose, kBattery, kRotorSpeeds };

  // A sample has come; false if it is one that came before and must not be taken in again.
  bool is_new(Stream stream, std::uint64_t sequence) {
    std::uint64_t& newest = newest_[static_cast<std::size_t>(stream)];
    if (sequence <= newest) return false;
    newest = sequence;
    return true;
  }

  // An IMU sample has come; false if it is one that has been let through before.
  bool offer(const comms::msg::Imu& imu) {
    if (imu.sequence_number() == let_through_) return false;
    waiting_ = imu;
    return true;
  }

  // The sample that is to be answered now, once; empty if there is none or if it has to wait.
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

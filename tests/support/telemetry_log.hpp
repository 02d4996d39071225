// Ground truth and reference of a vehicle as they arrive.
#pragma once

#include <mutex>
#include <vector>

#include "swiftlet/record/flight.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::tests {

// Thread-safe.
class TelemetryLog {
 public:
  explicit TelemetryLog(dds::Node& node) {
    truth_ = node.subscribe<messages::msg::GroundTruth>(
        messages::topics::kGroundTruth, [this](const messages::msg::GroundTruth& truth) {
          const std::lock_guard<std::mutex> lock(mutex_);
          // Lockstep repeats a sample whose answer is late.
          if (!flight_.truth.empty() && flight_.truth.back().stamp_ns >= truth.stamp_ns()) return;
          flight_.truth.push_back({truth.stamp_ns(), truth.position_ned(), truth.velocity_ned(),
                                   truth.q_ned_from_frd(), truth.body_rates_frd(), truth.rotor_speeds(),
                                   truth.rotor_count(), truth.supply_voltage_v(), truth.on_ground()});
        });
    reference_ = node.subscribe<messages::msg::Reference>(
        messages::topics::kReference, [this](const messages::msg::Reference& reference) {
          const std::lock_guard<std::mutex> lock(mutex_);
          if (!flight_.reference.empty() && flight_.reference.back().stamp_ns >= reference.stamp_ns()) return;
          flight_.reference.push_back({reference.stamp_ns(), reference.mode(), reference.position_ned(),
                                       reference.velocity_ned(), reference.acceleration_ned(),
                                       reference.yaw(), reference.attitude_setpoint(),
                                       reference.thrust_setpoint(), reference.moment_setpoint()});
        });
  }

  // Forgets what has arrived.
  void clear() {
    const std::lock_guard<std::mutex> lock(mutex_);
    flight_ = {};
  }
  record::Flight flight() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return flight_;
  }

 private:
  mutable std::mutex mutex_;  // guards flight_
  record::Flight flight_;
  dds::Subscription truth_, reference_;  // last: their callbacks use the members above
};

}  // namespace swiftlet::tests

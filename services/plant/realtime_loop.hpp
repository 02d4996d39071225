// Real time: simulated time follows the computer's clock.
#pragma once

#include <atomic>
#include <cstdint>

#include <boost/lockfree/spsc_queue.hpp>

#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/plant/simulated_vehicle.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

class RealtimeLoop {
 public:
  // speed: simulated time per real time, > 0. The vehicle must outlive the loop.
  RealtimeLoop(SimulatedVehicle& vehicle, const plant::SimulationSettings& settings, double speed,
               comms::Node& node, const runtime::RealtimeSettings& realtime);

  // Steps until `stop`. If it falls behind by more than an IMU period, it delays simulated time instead of
  // catching up: a burst of samples could not be answered.
  void run(const std::atomic<bool>& stop);

 private:
  void on_command(const comms::msg::ActuatorCommand& message);

  SimulatedVehicle& vehicle_;
  std::int64_t step_ns_;  // computer's clock
  std::int64_t imu_period_ns_;
  runtime::RealtimeSettings realtime_;

  boost::lockfree::spsc_queue<ReceivedCommand, boost::lockfree::capacity<64>> received_;
  runtime::RealtimeThread listener_;
  comms::Subscription commands_;  // last: its callback uses all members above
};

}  // namespace swiftlet::services

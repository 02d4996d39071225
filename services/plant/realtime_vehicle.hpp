// A simulated vehicle whose time follows the computer's clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include <boost/lockfree/spsc_queue.hpp>

#include "swiftlet/plant/simulation/truth_schedule.hpp"
#include "swiftlet/services/clocks/clock_server.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/plant/simulated_vehicle.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

class RealtimeVehicle {
 public:
  // speed: simulated time per real time, > 0. The vehicle must outlive this.
  RealtimeVehicle(SimulatedVehicle& vehicle, const plant::SimulationSettings& settings, double speed,
                  dds::Node& node, const runtime::RealtimeSettings& realtime);

  // Computer's clock, ns: of the IMU.
  std::int64_t sample_period_ns() const { return sample_period_ns_; }

  // In one thread. tick_ns: when the last sample was due. Publishes that of the present state.
  void begin(std::int64_t tick_ns);
  // Steps to the sample that is due at tick_ns. slipped_ns: by which that was put off, whole periods.
  void step_to_sample(std::int64_t tick_ns, std::int64_t slipped_ns);

 private:
  void on_command(const ReceivedCommand& received);
  void on_pose(const messages::msg::MocapPose& message);
  void obey_due(std::int64_t due_ns, bool is_last);
  void publish();
  void set_origin(std::int64_t tick_ns);
  std::optional<std::int64_t> simulated_ns() const;

  SimulatedVehicle& vehicle_;
  double speed_;
  std::int64_t steps_per_sample_;
  std::int64_t sample_period_ns_;  // of the IMU, computer's clock
  plant::TruthSchedule truth_;
  runtime::RealtimeSettings realtime_;

  boost::lockfree::spsc_queue<ReceivedCommand, boost::lockfree::capacity<64>>
      commands_;  // of all levels, from the one thread of Delivery::kSamples
  runtime::RealtimeThread listener_;
  runtime::LatestValue<plant::PoseSample> pose_;
  // The computer's clock at stamp 0, monotonic; 0 before the first step.
  std::atomic<std::int64_t> origin_ns_{0};
  std::vector<dds::Subscription> subscriptions_;  // last two: their callbacks use all members above
  clocks::ClockServer clock_;
};

}  // namespace swiftlet::services

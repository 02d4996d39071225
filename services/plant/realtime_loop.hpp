// Real time: simulated time follows the computer's clock.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include <boost/lockfree/spsc_queue.hpp>

#include "swiftlet/services/dds/clocks/clock_server.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/plant/simulated_vehicle.hpp"
#include "swiftlet/services/plant/truth_schedule.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

class RealtimeLoop {
 public:
  // speed: simulated time per real time, > 0. phase: of the IMU samples, 0 .. 1 of their period after a time that all
  // loops of the process share: runtime::group_phase() spreads those of several vehicles over it. The vehicle must
  // outlive the loop.
  RealtimeLoop(SimulatedVehicle& vehicle, const plant::SimulationSettings& settings, double speed,
               double phase, comms::Node& node, const runtime::RealtimeSettings& realtime);

  // Steps until `stop`. If it falls behind by more than an IMU period, it delays simulated time by whole periods
  // instead of catching up: a burst of samples could not be answered.
  void run(const std::atomic<bool>& stop);

 private:
  void on_command(const ReceivedCommand& received);
  void on_pose(const comms::msg::MocapPose& message);
  void step_to_sample(std::int64_t sample_due_ns);
  void obey_due(std::int64_t due_ns, bool is_last);
  void publish();
  void set_origin(std::int64_t tick_ns);
  std::optional<std::int64_t> simulated_ns() const;

  SimulatedVehicle& vehicle_;
  double speed_;
  double phase_;
  std::int64_t steps_per_sample_;
  std::int64_t sample_period_ns_;  // of the IMU, computer's clock
  TruthSchedule truth_;
  runtime::RealtimeSettings realtime_;

  // Each level's commands come in a thread of their own.
  struct Link {
    boost::lockfree::spsc_queue<ReceivedCommand, boost::lockfree::capacity<64>> received;
    runtime::RealtimeThread listener;
  };
  std::array<Link, plant::kControlLevelCount> links_;  // by level
  runtime::LatestValue<plant::PoseSample> pose_;
  // The computer's clock at stamp 0, monotonic; 0 before the first step.
  std::atomic<std::int64_t> origin_ns_{0};
  std::vector<comms::Subscription> subscriptions_;  // last two: their callbacks use all members above
  comms::ClockServer clock_;
};

}  // namespace swiftlet::services

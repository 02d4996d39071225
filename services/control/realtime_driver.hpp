// Real time: each sample is answered when it comes, by the active one of the vehicle's controllers.
#pragma once

#include <atomic>
#include <cstdint>

#include <boost/lockfree/spsc_queue.hpp>

#include "swiftlet/services/control/command_server.hpp"
#include "swiftlet/services/control/failover.hpp"
#include "swiftlet/services/control/inner_loop.hpp"
#include "swiftlet/services/control/sample_answers.hpp"
#include "swiftlet/services/control/semaphore.hpp"
#include "swiftlet/services/control/step_driver.hpp"
#include "swiftlet/services/control/takeover.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/throttled_warning.hpp"
#include "swiftlet/services/runtime/latest_value.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

class RealtimeDriver final : public StepDriver {
 public:
  // controller: its random number. Listens to the other controllers' states from then on.
  RealtimeDriver(std::uint64_t controller, int failover_priority, InnerLoop& loop,
                 CommandServer& command_server, SampleAnswers& answers, Semaphore& wake, dds::Node& node,
                 const runtime::RealtimeSettings& realtime);

  void on_sample(const VehicleSample& sample) override;
  void on_sensor(Stream stream, std::uint64_t sequence, const std::function<void()>& put) override;
  // Logs a takeover. Without samples and another active controller answers requests, which refuses them with that reason.
  void attend() override;
  std::uint32_t command_term() const override { return command_term_.load(std::memory_order_relaxed); }
  bool is_realtime() const override;

 private:
  Authority take_role(const VehicleSample& sample);
  void on_controller_state(const messages::msg::ControllerState& message);

  const std::uint64_t controller_;
  const runtime::RealtimeSettings realtime_;
  InnerLoop& loop_;
  CommandServer& command_server_;
  SampleAnswers& answers_;
  Semaphore& wake_;

  // Used by the inner loop's thread only.
  Failover failover_;
  std::int64_t answered_ns_ = -1;  // stamp of the last sample
  std::uint64_t answered_ = 0;     // and its number

  boost::lockfree::spsc_queue<Heartbeat, boost::lockfree::capacity<64>> heartbeats_;
  runtime::LatestValue<Takeover> takeover_;  // to the thread of attend()
  std::atomic<bool> active_{false};
  std::atomic<std::uint32_t> command_term_;       // of a command that is sent now; standby: of its takeover
  std::atomic<std::int64_t> active_heard_ns_{0};  // last of another active one; monotonic
  runtime::RealtimeThread imu_thread_, pose_thread_, rotor_speed_thread_;

  dds::ThrottledWarning faults_{"controller_state"};
  dds::Subscription controller_states_;  // last: its callback uses all members above
};

}  // namespace swiftlet::services

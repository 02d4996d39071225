// The flight controller on the network.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include <boost/lockfree/spsc_queue.hpp>

#include "swiftlet/services/control/command_server.hpp"
#include "swiftlet/services/control/failover.hpp"
#include "swiftlet/services/control/inner_loop.hpp"
#include "swiftlet/services/control/lockstep_gate.hpp"
#include "swiftlet/services/control/telemetry.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/throttled_warning.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/realtime.hpp"
#include "swiftlet/services/runtime/semaphore.hpp"

namespace swiftlet::services {

// Any number of them may fly one vehicle: one acts, the others step along with the same samples, follow the
// state of its flight and take over when it falls silent (Failover). In lockstep there is one alone.
//
// Threads: the IMU's own runs the inner loop and sends the command before it returns; poses, missions and
// trajectories arrive in their own, all else in one that is shared; run() is telemetry's. In lockstep the
// inner loop runs in the thread that brings the last of the samples that belong together.
class ControlService {
 public:
  // Throws std::invalid_argument as FlightController does, std::runtime_error as Node does. strength: of
  // several standbys the strongest takes over first.
  ControlService(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                 int failover_priority, comms::Node& node, const runtime::RealtimeSettings& realtime,
                 runtime::Clock clock);

  void run(const std::atomic<bool>& stop);
  void wake() { wake_.post(); }

  // In lockstep: another controller answers the vehicle too.
  bool has_rival() const { return rival_.load(std::memory_order_relaxed); }

  const Snapshot& last() const { return telemetry_.last(); }  // once run() has returned

 private:
  void subscribe(comms::Node& node, runtime::Clock clock);
  void on_imu(const comms::msg::Imu& message);
  void on_imu_in_lockstep(const comms::msg::Imu& message);
  void on_ground_link(const comms::msg::GroundLink& message);
  void on_controller_state(const comms::msg::ControllerState& message);
  Role take_role(const comms::msg::Imu& message);
  Role take_role_in_lockstep(const comms::msg::Imu& message);
  void answer(const comms::msg::Imu& message, Role role);
  void report(std::int64_t stamp_ns);
  void attend_to_those_who_are_alone();
  void offer_strength();
  bool is_realtime() const;
  template <class Message, class Sample>
  std::function<void(const Message&)> deliver(runtime::LatestValue<Sample>& latest,
                                              comms::ThrottledWarning& faults);
  template <class Message, class Sample>
  std::function<void(const Message&)> deliver_in_lockstep(runtime::LatestValue<Sample>& latest,
                                                          comms::ThrottledWarning& faults,
                                                          LockstepGate::Stream stream);

  const std::uint64_t controller_;
  const runtime::Clock clock_;
  runtime::RealtimeSettings realtime_;
  runtime::Semaphore wake_;
  InnerLoop loop_;
  CommandServer command_server_;
  Telemetry telemetry_;

  // By the thread of the inner loop alone.
  Failover failover_;
  comms::Publisher<comms::msg::ControllerState> reports_;
  comms::ControllerReport report_;
  comms::msg::ActuatorCommand last_answer_;

  comms::Publisher<comms::msg::ActuatorCommand> commands_;
  boost::lockfree::spsc_queue<Heartbeat, boost::lockfree::capacity<64>> heartbeats_;
  std::atomic<bool> active_{false};
  std::atomic<std::uint32_t> wanted_strength_;    // of the commands
  std::atomic<std::int64_t> stepped_down_ns_{0};  // monotonic
  std::atomic<std::int64_t> active_heard_ns_{0};  // another one; monotonic
  std::atomic<bool> rival_{false};
  std::uint32_t offered_strength_;  // by the thread of run()

  runtime::RealtimeThread imu_thread_, pose_thread_;

  std::mutex gate_mutex_;  // in lockstep: of the inner loop and all that it takes in
  LockstepGate gate_;

  comms::ThrottledWarning pose_faults_{"mocap_pose"};
  comms::ThrottledWarning battery_faults_{"battery"};
  comms::ThrottledWarning rotor_speed_faults_{"rotor_speeds"};
  comms::ThrottledWarning setpoint_faults_{"setpoint"};
  comms::ThrottledWarning controller_faults_{"controller_state"};
  comms::ThrottledWarning ground_link_faults_{"ground_link"};

  std::vector<comms::Subscription> subscriptions_;  // last: their callbacks use what stands above
};

}  // namespace swiftlet::services

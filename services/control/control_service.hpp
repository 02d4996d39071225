// Connects the flight controller to the DDS topics.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/services/control/arrivals.hpp"
#include "swiftlet/services/control/command_publisher.hpp"
#include "swiftlet/services/control/command_server.hpp"
#include "swiftlet/services/control/inner_loop.hpp"
#include "swiftlet/services/control/sample_answers.hpp"
#include "swiftlet/services/control/semaphore.hpp"
#include "swiftlet/services/control/step_driver.hpp"
#include "swiftlet/services/control/telemetry.hpp"
#include "swiftlet/services/control/worker.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/throttled_warning.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/realtime.hpp"
#include "swiftlet/services/runtime/service_manager.hpp"

namespace swiftlet::services {

// Any number of control services may serve one vehicle: one is active, the others are standbys. A standby
// steps with the same samples, follows the active controller's state and takes over when it falls silent
// (Failover). In lockstep only one is allowed.
//
// Of each sensor topic the samples of one process are used. If another one sends them too, control_status
// reports both.
//
// A driver decides when a sample is answered, and in which role: RealtimeDriver or LockstepDriver.
//
// Threads: the thread of the IMU subscription runs the inner loop and publishes the command before its
// callback returns. Poses and rotor speeds, and missions, trajectories and controller states have one each; the other topics
// share one: all of these serve every vehicle of the process. run() is the telemetry thread. In lockstep the inner loop runs in
// the thread that receives the last sample of a step.
class ControlService {
 public:
  // Throws std::invalid_argument as FlightController does, std::runtime_error as Node does.
  // failover_priority: of several standbys the one of the highest priority takes over first. fixed: the
  // settings that cannot change in flight; empty: changes of them are not noticed. level: at which the vehicle is
  // commanded; nullopt: the lowest that vehicle_info says it accepts. In lockstep no sample is answered before
  // vehicle_info has come.
  ControlService(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                 int failover_priority, dds::Node& node, const runtime::RealtimeSettings& realtime,
                 runtime::Clock clock, std::vector<control::FixedSetting> fixed = {},
                 std::optional<plant::ControlLevel> level = std::nullopt);

  void run(const std::atomic<bool>& stop);
  void wake() { wake_.post(); }
  // Whether run() goes on, and no step lasts for a second. Call from any thread.
  bool goes_on() const { return pulse_.beats(); }

  // Lockstep: true if another controller commands the vehicle too.
  bool has_rival() const { return driver_->has_rival(); }

  bool active() const { return command_server_.active(); }
  const Snapshot& last() const { return telemetry_.last(); }  // once run() has returned

 private:
  void subscribe(dds::Node& node);
  void subscribe_sensors(dds::Node& node);
  template <class Message>
  void subscribe_motion(dds::Node& node, const messages::Topic<Message>& topic, const char* samples,
                        AnsweredSamples::Kind kind);
  void on_ground_link(const messages::msg::GroundLink& message);
  template <class Message>
  static void note(Arrivals& arrivals, const Message& message);
  StreamAges stream_ages() const;
  std::string source_conflict() const;
  void publish_pending_stop(const StreamAges& ages);
  void on_vehicle_info(const messages::msg::VehicleInfo& message);
  void refuse_vehicle(const std::string& why);
  void adopt_levels();
  template <class Message>
  std::function<void(const Message&)> deliver_to_worker(void (CommandServer::*take)(const Message&));
  // Passes a valid sample to the inner loop, and warns of an invalid one.
  template <class Message, class Sample>
  static void put(const Message& message, runtime::LatestValue<Sample>& latest,
                  dds::ThrottledWarning& faults);
  // The same when the driver says so.
  template <class Message, class Sample>
  void deliver(const Message& message, StepDriver::Stream stream, runtime::LatestValue<Sample>& latest,
               dds::ThrottledWarning& faults);

  static constexpr std::int64_t kNoStep = std::numeric_limits<std::int64_t>::max();

  const std::uint64_t controller_;
  const runtime::Clock clock_;
  Semaphore wake_;
  InnerLoop loop_;
  CommandServer command_server_;
  Telemetry telemetry_;
  CommandPublisher commands_;
  const int rotor_count_;
  const std::optional<plant::ControlLevel> wanted_level_;
  std::atomic<std::uint8_t> reported_levels_{0};  // in vehicle_info, ControlLevels::bits(); 0: not known yet
  bool of_another_process_ = false;  // the next sample of the vehicle; used by the thread of these only
  std::uint8_t adopted_levels_ = 0;  // used by the thread of run() only
  const plant::Vehicle expected_vehicle_;
  const double max_vehicle_difference_;
  std::string vehicle_refusal_;  // used by the thread of vehicle_info only
  std::atomic<std::int64_t> step_began_ns_{kNoStep};
  runtime::Pulse pulse_;  // of run()
  SampleAnswers answers_;
  std::unique_ptr<StepDriver> driver_;  // by the clock
  AnsweredSamples answered_samples_;
  Arrivals imu_arrivals_, pose_arrivals_, battery_arrivals_;
  Worker worker_;  // checks plans and designs gains

  dds::ThrottledWarning pose_faults_{"mocap_pose"};
  dds::ThrottledWarning battery_faults_{"battery"};
  dds::ThrottledWarning rotor_speed_faults_{"rotor_speeds"};
  dds::ThrottledWarning setpoint_faults_{"setpoint"};
  dds::ThrottledWarning ground_link_faults_{"ground_link"};

  struct Sensor {
    const char* samples;  // "IMU samples"
    dds::Subscription subscription;
  };
  std::vector<Sensor> sensors_;
  std::vector<dds::Subscription> subscriptions_;  // last: their callbacks use all members above
};

}  // namespace swiftlet::services

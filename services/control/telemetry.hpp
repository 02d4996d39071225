// Publishes the control service's telemetry, statuses and answers to requests, and writes its log. Not
// time-critical. A standby publishes almost nothing, so that tools hear the active controller only.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/services/control/arrivals.hpp"
#include "swiftlet/services/control/command_server.hpp"
#include "swiftlet/services/control/delay_monitor.hpp"
#include "swiftlet/services/control/inner_loop.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::services {

class Telemetry {
 public:
  // thresholds: published in control_status. controller: the random number of this controller. rotors: of the
  // loops whose delay margin is published.
  Telemetry(InnerLoop& loop, CommandServer& command_server, const control::FailsafeSettings& thresholds,
            dds::Node& node, std::uint64_t controller, const control::ObservedRotors& rotors);

  // Publishes what is new or due. Call periodically from one thread.
  void publish_due();

  // What control_status reports. realtime: whether the flight threads have real-time scheduling. source_conflict: a sentence or
  // empty; logged when it begins.
  void set_ages(const StreamAges& ages) { ages_ = ages; }
  void set_conditions(bool realtime, const std::string& source_conflict);
  // A stop request that is accepted and commanded, but that no IMU sample has let the inner loop evaluate:
  // control_status shows it.
  void set_unconfirmed_stop(const std::optional<control::RequestKey>& stop);
  // What vehicle_info reports as fault, "" for none: the reason of a flight that it stopped. Call from any thread.
  void set_vehicle_fault(const std::string& fault);
  // Warns when IMU samples stop. Call before publish_due().
  void watch_imu() { watches_imu_ = true; }
  // Call from the thread of publish_due(), or after it has ended.
  const Snapshot& last() const { return last_; }

 private:
  void open();
  void take(const Snapshot& snapshot);
  void change_role();
  void publish_plan();
  std::string reason_text(const control::Status& status) const;
  void log_imu_silence();
  const DelayMonitor::Report& update_delay();
  void publish_sampled(const Snapshot& snapshot);
  void publish_status();
  void publish_mission();

  InnerLoop& loop_;
  CommandServer& command_server_;
  const control::FailsafeSettings thresholds_;
  dds::Node& node_;
  const std::uint64_t controller_;
  bool realtime_ = false;
  bool watches_imu_ = false;
  bool imu_silent_ = false;
  StreamAges ages_;
  std::string source_conflict_;
  mutable std::mutex vehicle_fault_mutex_;
  std::string vehicle_fault_;  // the last one
  std::optional<control::RequestKey> unconfirmed_stop_;
  DelayMonitor delay_monitor_;

  Snapshot last_;
  bool saturated_ = false;             // since the last control_status
  std::uint8_t mission_end_code_ = 0;  // why the last mission ended
  std::string mission_end_;
  std::int64_t status_due_ns_ = 0;
  std::int64_t mission_due_ns_ = 0;
  std::uint64_t sampled_count_ = 0;
  std::uint64_t status_count_ = 0;
  std::uint64_t mission_count_ = 0;
  std::uint64_t published_mission_ = 0;  // id of the last flown_mission
  std::uint64_t published_trajectory_ = 0;

  dds::Publisher<messages::msg::Estimate> estimates_;
  dds::Publisher<messages::msg::Reference> references_;
  dds::Publisher<messages::msg::ControlStatus> statuses_;
  dds::Publisher<messages::msg::MissionStatus> missions_;
  dds::Publisher<messages::msg::Mission> flown_missions_;
  dds::Publisher<messages::msg::Trajectory> flown_trajectories_;
  dds::Publisher<messages::msg::CommandAck> acks_;
};

}  // namespace swiftlet::services

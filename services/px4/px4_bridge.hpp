// swiftlet-px4's vehicle on the network: joins one PX4 to the topics of a vehicle. What it does is in px4_vehicle.hpp.
//
//   sensor_combined or vehicle_odometry, battery_status --> imu or vehicle_odometry, battery --> control
//   offboard_control_mode, setpoint <-- rates_setpoint, attitude_setpoint or trajectory_setpoint <-- control
//   vehicle_visual_odometry         <-- mocap_pose
//   vehicle_command, its ack, vehicle_status <--> OffboardSession --> vehicle_info
//
// The vehicle's clock is the monotonic clock of this host. Each setpoint of control goes on once, in the thread that received it,
// with PX4's proof of life before it: when control falls silent, PX4 hears nothing more.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "swiftlet/services/clocks/clock_server.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/throttled_warning.hpp"
#include "swiftlet/services/px4/px4_topics.hpp"
#include "swiftlet/services/px4/px4_vehicle.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/realtime.hpp"
#include "swiftlet/services/runtime/service_manager.hpp"

namespace swiftlet::px4 {

struct BridgeSettings : Px4VehicleSettings {
  int instance = 0;
  std::string namespace_prefix{};  // of topic_folder()
  runtime::RealtimeSettings realtime;
};

class Px4Bridge final : public runtime::HostedVehicle {
 public:
  Px4Bridge(const dds::Participant& participant, const std::string& name, const BridgeSettings& settings);

  // The session, 100 times a second.
  void run(const std::atomic<bool>& stop) override;
  // The main thread: looks for PX4, logs, and publishes vehicle_info.
  void attend() override;
  bool goes_on() const override { return pulse_.beats(); }
  void log_end() override;

 private:
  void subscribe();
  // Each is called by the thread that receives the topic.
  void on_sensors(const msg::SensorCombined& message);
  void on_odometry(const msg::VehicleOdometry& message);
  void on_battery(const msg::BatteryStatus& message);
  void on_status(const msg::VehicleStatus& message);
  template <class Message, class Command>
  void on_setpoint(const Message& message);
  void on_pose(const messages::msg::MocapPose& message);

  void publish(const OffboardStream& stream);
  void log_changes();

  const BridgeSettings settings_;
  const Px4Topics topics_;

  mutable std::mutex mutex_;  // guards the vehicle; held for microseconds
  Px4Vehicle vehicle_;

  dds::ThrottledWarning sensor_faults_{"sensor_combined"};
  dds::ThrottledWarning battery_faults_{"battery_status"};
  dds::ThrottledWarning status_faults_{"vehicle_status_v1"};
  dds::ThrottledWarning odometry_faults_{"vehicle_odometry"};
  runtime::Pulse pulse_;  // of run(), which waits for what the callbacks hold
  runtime::RealtimeThread sensor_thread_, odometry_thread_, command_thread_, pose_thread_;

  // Only the main thread uses these.
  Phase logged_phase_ = Phase::kDisconnected;
  std::string logged_fault_;
  std::uint64_t logged_refused_ = 0;
  int logged_steps_ = 0;
  std::int64_t search_due_ns_ = 0;
  std::int64_t info_due_ns_ = 0;
  messages::msg::VehicleInfo info_;

  dds::Participant participant_;
  dds::Node node_;
  dds::Publisher<messages::msg::Imu> imu_;  // or, in its place:
  dds::Publisher<messages::msg::VehicleOdometry> vehicle_odometry_;
  dds::Publisher<messages::msg::Battery> battery_;
  dds::Publisher<messages::msg::VehicleInfo> vehicle_info_;
  dds::Publisher<msg::OffboardControlMode> modes_;
  dds::Publisher<msg::VehicleRatesSetpoint> rates_;
  dds::Publisher<msg::VehicleAttitudeSetpoint> attitudes_;
  dds::Publisher<msg::TrajectorySetpoint> trajectories_;
  dds::Publisher<msg::VehicleOdometry> poses_;
  dds::Publisher<msg::VehicleCommand> commands_;
  clocks::ClockServer clock_server_;  // these last: their callbacks use all members above
  std::vector<dds::Subscription> subscriptions_;
};

}  // namespace swiftlet::px4

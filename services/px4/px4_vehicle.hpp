// The vehicle that a PX4 and its bridge are to control: samples of PX4 in, samples of a vehicle out, commands of control in,
// setpoints of PX4 out, and the offboard session between them. Without middleware, clock and threads: now_ns is the vehicle's
// clock, which is that of the host.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/command_watchdog.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/px4/offboard_session.hpp"
#include "swiftlet/services/px4/px4_clock.hpp"
#include "swiftlet/services/px4/px4_topics.hpp"
#include "swiftlet/services/px4/thrust_scale.hpp"
#include "swiftlet/services/px4/translate.hpp"
#include "swiftlet/services/px4/versions.hpp"
#include "swiftlet/services/px4/vision.hpp"
#include "swiftlet/services/runtime/random_id.hpp"

namespace swiftlet::px4 {

// What control is sent of PX4: its IMU, or its own estimate.
enum class Samples { kImu, kOdometry };

struct Px4VehicleSettings {
  plant::Vehicle vehicle;
  plant::ControlLevels levels;
  Samples samples = Samples::kImu;
  double control_silence_s = 0.2;
  std::optional<double> hover_throttle;
  VisionSettings vision;
  std::uint32_t boot = runtime::boot_number();
};

// What PX4 is sent for a command of control: the proof of life, and the setpoint unless the rotors are off.
struct OffboardStream {
  msg::OffboardControlMode mode;
  std::variant<std::monostate, msg::VehicleRatesSetpoint, msg::VehicleAttitudeSetpoint,
               msg::TrajectorySetpoint>
      setpoint;
};

class Px4Vehicle {
 public:
  explicit Px4Vehicle(const Px4VehicleSettings& settings);

  // PX4's topics. Each returns what control is sent, if anything. fault: set if the message is not sensible, and ignored then.
  std::optional<messages::msg::Imu> on_sensors(const msg::SensorCombined& message, std::int64_t now_ns,
                                               messages::Fault& fault);
  std::optional<messages::msg::VehicleOdometry> on_odometry(const msg::VehicleOdometry& message,
                                                            std::int64_t now_ns, messages::Fault& fault);
  std::optional<messages::msg::Battery> on_battery(const msg::BatteryStatus& message, std::int64_t now_ns,
                                                   messages::Fault& fault);
  void on_status(const msg::VehicleStatus& message, std::int64_t now_ns);
  void on_flags(const msg::FailsafeFlags& message) { flags_ = message; }
  void on_land_detected(const msg::VehicleLandDetected& message) {
    landed_ = message.landed() || message.ground_contact();
  }
  void on_ack(const msg::VehicleCommandAck& message) { session_.on_ack(message); }
  void set_version(Version version) { version_ = std::move(version); }

  // A command of control, at any level. Returns what goes on to PX4.
  std::optional<OffboardStream> on_command(const plant::VehicleCommand& command, std::int64_t now_ns);
  // A pose of motion capture. system_minus_now_ns: the system clock minus now_ns.
  std::optional<msg::VehicleOdometry> on_pose(const plant::PoseSample& pose, std::int64_t now_ns,
                                              std::int64_t system_minus_now_ns);

  // Call 100 times a second. Returns the command to send to PX4, if there is one.
  std::optional<msg::VehicleCommand> update(std::int64_t now_ns);

  // For vehicle_info and the log.
  const OffboardSession& session() const { return session_; }
  const Vision& vision() const { return vision_; }
  double hover_throttle() const { return scale_.hover_throttle(); }
  int stamp_steps() const { return clock_.steps(); }
  std::uint64_t samples() const { return samples_; }
  std::uint64_t setpoints() const { return setpoints_; }
  std::uint64_t refused_commands() const { return refused_commands_; }
  plant::CommandFault refusal() const { return refusal_; }  // of the last of them

 private:
  plant::ObeyedCommand obeyed() const;
  OffboardStream stream(const plant::VehicleCommand& command);
  OffboardInputs inputs(std::int64_t now_ns) const;
  std::string arming_fault(std::int64_t now_ns) const;

  const Px4VehicleSettings settings_;
  OffboardSession session_;
  plant::CommandWatchdog watchdog_;
  ThrustScale scale_;
  Px4Clock clock_;  // of the samples that control is sent
  Vision vision_;
  Version version_;
  std::optional<msg::VehicleStatus> status_;
  std::optional<msg::FailsafeFlags> flags_;
  plant::OdometrySample estimate_;  // PX4's
  bool landed_ = true;
  bool rotors_wanted_ = false;
  std::int64_t commanded_ns_ = 0;
  std::int64_t streamed_since_ns_ = 0;
  std::int64_t status_ns_ = 0;
  std::int64_t sampled_ns_ = 0;
  std::int64_t estimated_ns_ = 0;
  double thrust_n_ = 0.0;
  plant::ControlLevel level_ = plant::ControlLevel::kActuators;
  std::uint64_t samples_ = 0;  // of the IMU, or of PX4's estimate
  std::uint64_t battery_samples_ = 0;
  std::uint64_t refused_commands_ = 0;
  std::uint64_t setpoints_ = 0;
  plant::CommandFault refusal_ = plant::CommandFault::kNone;
  std::int64_t battery_ns_ = 0;  // when the last one was passed on
};

}  // namespace swiftlet::px4

#include "swiftlet/services/px4/translate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "swiftlet/services/messages/wire.hpp"
#include "swiftlet/services/px4/words.hpp"

namespace swiftlet::px4 {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using messages::Fault;
using messages::wire::Check;

constexpr float kUnused = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<float, 3> kUnusedVector{kUnused, kUnused, kUnused};

// The source of commands is the one that ground stations use, so that PX4 sees them as external.
constexpr std::uint8_t kOurSystem = 255;
constexpr std::uint16_t kOurComponent = 191;  // MAV_COMP_ID_ONBOARD_COMPUTER

constexpr float kCustomMode = 1.0F;        // param1 of DO_SET_MODE
constexpr float kMainModeOffboard = 6.0F;  // param2
constexpr float kForced = 21196.0F;        // param2 of ARM_DISARM: without a check

constexpr std::uint8_t kFrameNed = 1;
constexpr std::uint8_t kVelocityFrameUnknown = 0;
constexpr std::int8_t kBestQuality = 100;

// What a quadrotor cannot measure: the layout of the message must have changed.
constexpr double kGreatestForce = 400.0;  // m/s^2
constexpr double kGreatestRate = 60.0;    // rad/s
constexpr double kGreatestVoltage_v = 100.0;
constexpr double kGreatestDistance_m = 1e5;
constexpr double kGreatestSpeed = 200.0;  // m/s
constexpr std::uint8_t kGreatestNavState = 30;

std::array<float, 3> floats(const Vector3d& in) {
  return {static_cast<float>(in.x()), static_cast<float>(in.y()), static_cast<float>(in.z())};
}
std::array<float, 4> floats(const Quaterniond& in) {
  const double sign = in.w() < 0.0 ? -1.0 : 1.0;
  return {static_cast<float>(sign * in.w()), static_cast<float>(sign * in.x()),
          static_cast<float>(sign * in.y()), static_cast<float>(sign * in.z())};
}
Vector3d vector(const std::array<float, 3>& in) { return {in[0], in[1], in[2]}; }
bool is_known(const std::array<float, 3>& in) {
  return std::all_of(in.begin(), in.end(), [](float value) { return std::isfinite(value); });
}
// Variances about the body's axes to those about the axes of the frame: the diagonal of R diag(v) R^T.
std::array<float, 3> rotated(const std::array<float, 3>& variance_frd, const Quaterniond& q_ned_from_frd) {
  const Eigen::Matrix3d r = q_ned_from_frd.toRotationMatrix();
  return floats(Vector3d(r.cwiseAbs2() * vector(variance_frd)));
}
// Standard deviations; 0: not known.
Vector3d deviation(const std::array<float, 3>& variance) {
  return is_known(variance) ? Vector3d(vector(variance).cwiseMax(0.0).cwiseSqrt())
                            : Vector3d(Vector3d::Zero());
}

std::array<float, 3> thrust_body(double thrust_n, const ThrustScale& scale) {
  return {0.0F, 0.0F, -static_cast<float>(scale.throttle(thrust_n))};
}

msg::VehicleCommand command_to(std::uint8_t system, std::uint32_t command) {
  msg::VehicleCommand message;
  message.command(command);
  message.target_system(system);
  message.target_component(kAutopilotComponent);
  message.source_system(kOurSystem);
  message.source_component(kOurComponent);
  message.from_external(true);
  return message;
}

}  // namespace

msg::OffboardControlMode offboard_mode(const plant::VehicleCommand& command) {
  msg::OffboardControlMode mode;
  if (const auto* trajectory = std::get_if<plant::TrajectorySetpoint>(&command)) {
    mode.position(trajectory->position_used);
    mode.velocity(true);
    mode.acceleration(true);
  }
  mode.attitude(std::holds_alternative<plant::AttitudeSetpoint>(command));
  mode.body_rate(std::holds_alternative<plant::RatesSetpoint>(command));
  return mode;
}

msg::VehicleRatesSetpoint to_px4(const plant::RatesSetpoint& setpoint, const ThrustScale& scale) {
  msg::VehicleRatesSetpoint message;
  message.roll(static_cast<float>(setpoint.body_rates_frd.x()));
  message.pitch(static_cast<float>(setpoint.body_rates_frd.y()));
  message.yaw(static_cast<float>(setpoint.body_rates_frd.z()));
  message.thrust_body(thrust_body(setpoint.thrust_n, scale));
  return message;
}

msg::VehicleAttitudeSetpoint to_px4(const plant::AttitudeSetpoint& setpoint, const ThrustScale& scale) {
  msg::VehicleAttitudeSetpoint message;
  message.yaw_sp_move_rate(static_cast<float>(setpoint.body_rates_frd.z()));
  message.q_d(floats(setpoint.q_ned_from_frd));
  message.thrust_body(thrust_body(setpoint.thrust_n, scale));
  return message;
}

msg::TrajectorySetpoint to_px4(const plant::TrajectorySetpoint& setpoint) {
  msg::TrajectorySetpoint message;
  message.position(setpoint.position_used ? floats(setpoint.position_ned) : kUnusedVector);
  message.velocity(floats(setpoint.velocity_ned));
  message.acceleration(floats(setpoint.acceleration_ned));
  message.jerk(kUnusedVector);
  message.yaw(static_cast<float>(setpoint.yaw_rad));
  message.yawspeed(static_cast<float>(setpoint.yaw_rate));
  return message;
}

std::optional<double> thrust_of(const plant::VehicleCommand& command) {
  if (const auto* rates = std::get_if<plant::RatesSetpoint>(&command)) return rates->thrust_n;
  if (const auto* attitude = std::get_if<plant::AttitudeSetpoint>(&command)) return attitude->thrust_n;
  return std::nullopt;
}

msg::VehicleOdometry to_px4(const plant::PoseSample& pose, const PoseDeviation& deviation,
                            std::uint8_t reset_counter, std::uint64_t stamp_us) {
  const auto square = [](double value) { return static_cast<float>(value * value); };
  msg::VehicleOdometry message;
  message.timestamp(stamp_us);
  message.timestamp_sample(stamp_us);
  message.pose_frame(kFrameNed);
  message.position(floats(pose.position_ned));
  message.q(floats(pose.q_ned_from_frd));
  message.velocity_frame(kVelocityFrameUnknown);
  message.velocity(kUnusedVector);
  message.angular_velocity(kUnusedVector);
  message.position_variance().fill(square(deviation.position_m));
  message.orientation_variance().fill(square(deviation.attitude_rad));  // alike about all axes
  message.velocity_variance(kUnusedVector);
  message.reset_counter(reset_counter);
  message.quality(kBestQuality);
  return message;
}

msg::VehicleCommand set_offboard_mode(std::uint8_t system) {
  msg::VehicleCommand message = command_to(system, kCommandSetMode);
  message.param1(kCustomMode);
  message.param2(kMainModeOffboard);
  return message;
}

msg::VehicleCommand arm(std::uint8_t system) {
  msg::VehicleCommand message = command_to(system, kCommandArmDisarm);
  message.param1(1.0F);
  return message;
}

msg::VehicleCommand disarm_at_once(std::uint8_t system) {
  msg::VehicleCommand message = command_to(system, kCommandArmDisarm);
  message.param2(kForced);
  return message;
}

msg::VehicleCommand land(std::uint8_t system) { return command_to(system, kCommandLand); }

bool is_for_us(const msg::VehicleCommandAck& ack) {
  return ack.target_system() == kOurSystem && ack.target_component() == kOurComponent;
}

Fault from_px4(const msg::SensorCombined& message, plant::ImuSample& sample) {
  Check check;
  for (const float value : message.accelerometer_m_s2())
    check.within("accelerometer_m_s2", value, -kGreatestForce, kGreatestForce);
  for (const float value : message.gyro_rad()) check.within("gyro_rad", value, -kGreatestRate, kGreatestRate);
  if (!check.ok()) return check.fault();
  sample.specific_force_frd = vector(message.accelerometer_m_s2());
  sample.body_rates_frd = vector(message.gyro_rad());
  return {};
}

Fault from_px4(const msg::BatteryStatus& message, plant::BatterySample& sample) {
  Check check;
  check.within("voltage_v", message.voltage_v(), 0.0, kGreatestVoltage_v);
  check.within("remaining", message.remaining(), -1.0, 1.0);
  if (!check.ok()) return check.fault();
  sample.voltage_v = message.voltage_v();
  sample.current_a = std::isfinite(message.current_a()) ? std::max(message.current_a(), 0.0F) : 0.0;
  // -1: PX4 does not know it.
  sample.state_of_charge = std::max(message.remaining(), 0.0F);
  return {};
}

Fault from_px4(const msg::VehicleOdometry& message, plant::OdometrySample& odometry) {
  Check check;
  const bool has_position = is_known(message.position());
  const bool has_velocity = is_known(message.velocity()) && message.velocity_frame() == kFrameNed;
  if (has_position)
    for (const float value : message.position())
      check.within("position", value, -kGreatestDistance_m, kGreatestDistance_m);
  if (has_velocity)
    for (const float value : message.velocity())
      check.within("velocity", value, -kGreatestSpeed, kGreatestSpeed);
  for (const float value : message.angular_velocity())
    check.within("angular_velocity", value, -kGreatestRate, kGreatestRate);
  check.within("pose_frame", message.pose_frame(), kFrameNed, kFrameNed);
  const std::array<float, 4>& q = message.q();
  check.unit("q", {q[0], q[1], q[2], q[3]});
  if (!check.ok()) return check.fault();
  odometry.position_valid = has_position;
  if (has_position) odometry.position_ned = vector(message.position());
  odometry.velocity_valid = has_velocity;
  if (has_velocity) odometry.velocity_ned = vector(message.velocity());
  odometry.q_ned_from_frd = Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  odometry.body_rates_frd = vector(message.angular_velocity());
  odometry.position_deviation = deviation(message.position_variance());
  odometry.velocity_deviation = deviation(message.velocity_variance());
  odometry.rotation_deviation = deviation(rotated(message.orientation_variance(), odometry.q_ned_from_frd));
  odometry.resets += static_cast<std::uint8_t>(message.reset_counter() - odometry.resets);
  return {};
}

Fault check(const msg::VehicleStatus& message) {
  Check check;
  check.within("arming_state", message.arming_state(), 1, kArmingStateArmed);
  check.within("nav_state", message.nav_state(), 0, kGreatestNavState);
  check.within("vehicle_type", message.vehicle_type(), 0, 4);
  return check.fault();
}

}  // namespace swiftlet::px4

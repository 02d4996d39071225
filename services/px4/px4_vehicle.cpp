#include "swiftlet/services/px4/px4_vehicle.hpp"

#include <fmt/core.h>

#include "swiftlet/math/time.hpp"

namespace swiftlet::px4 {
namespace {

constexpr std::int64_t kBatteryPeriodNs = 100'000'000;
constexpr std::int64_t kStreamGapNs = 400'000'000;  // PX4 wants a proof of life twice a second
constexpr std::int64_t kCommandTimeoutNs = 500'000'000;
constexpr std::int64_t kPoseTimeoutNs = 500'000'000;
// Before arming: PX4's estimate against motion capture.
constexpr double kGreatestJump_m = 0.3;
constexpr double kGreatestAngle_rad = 0.35;

OffboardSettings offboard_settings(const Px4VehicleSettings& settings) {
  OffboardSettings offboard;
  offboard.control_silence_ns = math::nanoseconds(settings.control_silence_s);
  return offboard;
}

}  // namespace

Px4Vehicle::Px4Vehicle(const Px4VehicleSettings& settings)
    : settings_(settings),
      session_(offboard_settings(settings)),
      watchdog_(settings.vehicle.rotor_count(), kCommandTimeoutNs, settings.levels),
      scale_(settings.vehicle, settings.hover_throttle),
      vision_(settings.vision) {}

std::optional<messages::msg::Imu> Px4Vehicle::on_sensors(const msg::SensorCombined& message,
                                                         std::int64_t now_ns, messages::Fault& fault) {
  plant::ImuSample sample;
  fault = from_px4(message, sample);
  if (fault || version_.state == VersionState::kUnknown) return std::nullopt;
  const bool flies = session_.phase() == Phase::kFlying && !landed_;
  if (thrust_n_ > 0.0 || !flies) scale_.learn(thrust_n_, -sample.specific_force_frd.z(), flies, now_ns);
  if (settings_.samples != Samples::kImu) return std::nullopt;
  sampled_ns_ = now_ns;
  sample.stamp_ns = clock_.to_host(message.timestamp(), now_ns);
  sample.sequence = ++samples_;
  messages::msg::Imu out = messages::to_message(sample);
  out.obeyed(messages::to_message(obeyed()));
  return out;
}

std::optional<messages::msg::VehicleOdometry> Px4Vehicle::on_odometry(const msg::VehicleOdometry& message,
                                                                      std::int64_t now_ns,
                                                                      messages::Fault& fault) {
  fault = from_px4(message, estimate_);
  if (fault) return std::nullopt;
  if (estimate_.position_valid) estimated_ns_ = now_ns;
  if (settings_.samples != Samples::kOdometry || version_.state == VersionState::kUnknown)
    return std::nullopt;
  sampled_ns_ = now_ns;
  // The stamp is that of the IMU sample that the estimate was propagated to; message.timestamp() is when it was published.
  estimate_.stamp_ns = clock_.to_host(message.timestamp_sample(), now_ns);
  estimate_.sequence = ++samples_;
  estimate_.fuses_mocap = vision_.passed() > 0;
  messages::msg::VehicleOdometry out = messages::to_message(estimate_);
  out.obeyed(messages::to_message(obeyed()));
  return out;
}

std::optional<messages::msg::Battery> Px4Vehicle::on_battery(const msg::BatteryStatus& message,
                                                             std::int64_t now_ns, messages::Fault& fault) {
  plant::BatterySample sample;
  fault = from_px4(message, sample);
  if (fault) return std::nullopt;
  scale_.set_voltage(sample.voltage_v);
  if (now_ns - battery_ns_ < kBatteryPeriodNs) return std::nullopt;
  battery_ns_ = now_ns;
  sample.stamp_ns = now_ns;
  sample.sequence = ++battery_samples_;
  return messages::to_message(sample);
}

plant::ObeyedCommand Px4Vehicle::obeyed() const {
  plant::ObeyedCommand obeyed = watchdog_.obeyed();
  obeyed.boot = settings_.boot;
  return obeyed;
}

void Px4Vehicle::on_status(const msg::VehicleStatus& message, std::int64_t now_ns) {
  status_ = message;
  status_ns_ = now_ns;
}

std::optional<OffboardStream> Px4Vehicle::on_command(const plant::VehicleCommand& command,
                                                     std::int64_t now_ns) {
  const plant::CommandFault fault = watchdog_.accept(command, now_ns);
  if (fault != plant::CommandFault::kNone) {
    ++refused_commands_;
    refusal_ = fault;
    return std::nullopt;
  }
  if (commanded_ns_ == 0 || now_ns - commanded_ns_ > kStreamGapNs || !session_.streams())
    streamed_since_ns_ = now_ns;
  commanded_ns_ = now_ns;
  rotors_wanted_ = plant::header_of(command).rotor_state == plant::RotorState::kRunning;
  level_ = plant::level_of(command);
  if (!session_.streams()) return std::nullopt;
  return stream(command);
}

// PX4 obeys setpoints in other modes than offboard, too: while rotors are off it gets the proof of life alone.
OffboardStream Px4Vehicle::stream(const plant::VehicleCommand& command) {
  ++setpoints_;
  thrust_n_ = rotors_wanted_ ? thrust_of(command).value_or(0.0) : 0.0;
  OffboardStream out;
  out.mode = offboard_mode(command);
  if (!rotors_wanted_) return out;
  if (const auto* rates = std::get_if<plant::RatesSetpoint>(&command)) out.setpoint = to_px4(*rates, scale_);
  if (const auto* attitude = std::get_if<plant::AttitudeSetpoint>(&command))
    out.setpoint = to_px4(*attitude, scale_);
  if (const auto* trajectory = std::get_if<plant::TrajectorySetpoint>(&command))
    out.setpoint = to_px4(*trajectory);
  return out;
}

std::optional<msg::VehicleOdometry> Px4Vehicle::on_pose(const plant::PoseSample& pose, std::int64_t now_ns,
                                                        std::int64_t system_minus_now_ns) {
  if (version_.state == VersionState::kUnknown) return std::nullopt;
  return vision_.take(pose, now_ns, system_minus_now_ns);
}

std::string Px4Vehicle::arming_fault(std::int64_t now_ns) const {
  const bool uses_estimate =
      level_ == plant::ControlLevel::kAttitude || level_ == plant::ControlLevel::kTrajectory;
  if (!uses_estimate) return {};
  if (estimated_ns_ == 0 || now_ns - estimated_ns_ > kPoseTimeoutNs)
    return "PX4 must not be armed: it publishes no vehicle_odometry";
  // Control commands in the frame of PX4's estimate then, and knows whether motion capture is needed.
  if (settings_.samples == Samples::kOdometry) return {};
  const std::optional<plant::PoseSample>& pose = vision_.last();
  if (!pose || now_ns - pose->stamp_ns > kPoseTimeoutNs)
    return "PX4 must not be armed: no pose of motion capture";
  const double distance_m = (estimate_.position_ned - pose->position_ned).norm();
  if (distance_m > kGreatestJump_m)
    return fmt::format(
        "PX4 must not be armed: its position is {:.1f} m from that of motion capture, limit {:g} m",
        distance_m, kGreatestJump_m);
  const double angle_rad = estimate_.q_ned_from_frd.angularDistance(pose->q_ned_from_frd);
  if (angle_rad > kGreatestAngle_rad)
    return fmt::format(
        "PX4 must not be armed: its attitude is {:.1f} rad from that of motion capture, limit {:g} rad",
        angle_rad, kGreatestAngle_rad);
  return {};
}

OffboardInputs Px4Vehicle::inputs(std::int64_t now_ns) const {
  OffboardInputs inputs;
  inputs.now_ns = now_ns;
  inputs.rotors_wanted = rotors_wanted_;
  inputs.commanded_ns = commanded_ns_;
  inputs.streamed_since_ns = streamed_since_ns_;
  inputs.status = status_;
  inputs.status_ns = status_ns_;
  inputs.sampled_ns = sampled_ns_;
  inputs.flags = flags_;
  inputs.version_fault = version_.fault;
  inputs.arming_fault = arming_fault(now_ns);
  return inputs;
}

std::optional<msg::VehicleCommand> Px4Vehicle::update(std::int64_t now_ns) {
  return session_.update(inputs(now_ns));
}

}  // namespace swiftlet::px4

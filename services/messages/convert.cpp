#include "swiftlet/services/messages/convert.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::messages {
namespace {

using namespace wire;

constexpr double kMaxRotorSpeed = 1e5;  // rad/s, above any real rotor

void check_segments(const std::vector<msg::PolynomialSegment>& segments, Check& check) {
  if (!check.ok()) return;
  check.of_message();
  check.at_most("number of segments", segments.size(), control::kMaxTrajectorySegments);
  for (std::size_t i = 0; check.ok() && i < segments.size(); ++i) {
    check.of_item("segment", i + 1);
    check.at_least("duration_s", segments[i].duration_s(), 0.0)
        .finite("x", segments[i].x())
        .finite("y", segments[i].y())
        .finite("z", segments[i].z())
        .finite("yaw", segments[i].yaw());
  }
}

std::vector<control::PolynomialSegment> from_messages(const std::vector<msg::PolynomialSegment>& segments) {
  std::vector<control::PolynomialSegment> out;
  out.reserve(segments.size());
  for (const msg::PolynomialSegment& segment : segments)
    out.push_back({segment.duration_s(), segment.x(), segment.y(), segment.z(), segment.yaw()});
  return out;
}

std::vector<msg::PolynomialSegment> to_messages(const std::vector<control::PolynomialSegment>& segments) {
  std::vector<msg::PolynomialSegment> out;
  out.reserve(segments.size());
  for (const control::PolynomialSegment& segment : segments) {
    msg::PolynomialSegment& message = out.emplace_back();
    message.duration_s(segment.duration_s);
    message.x(segment.x);
    message.y(segment.y);
    message.z(segment.z);
    message.yaw(segment.yaw);
  }
  return out;
}

// What the commands of all levels have in common.
template <class Message>
void check_command(const Message& in, Check& check) {
  check.time(in.stamp_ns())
      .at_most("rotor_state", in.rotor_state(), msg::ActuatorCommand_Constants::ROTORS_RUNNING);
}

template <class Message>
void read_header(const Message& in, plant::CommandHeader& out) {
  out.stamp_ns = in.stamp_ns();
  out.sequence = in.sequence_number();
  out.imu_sequence = in.imu_sequence_number();
  out.mocap_sequence = in.mocap_sequence_number();
  out.rotor_state = static_cast<plant::RotorState>(in.rotor_state());
  out.term = in.term();
}

template <class Message>
Message with_header(const plant::CommandHeader& in) {
  Message out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.imu_sequence_number(in.imu_sequence);
  out.mocap_sequence_number(in.mocap_sequence);
  out.rotor_state(static_cast<std::uint8_t>(in.rotor_state));
  out.term(in.term);
  return out;
}

}  // namespace

Fault from_message(const msg::Imu& in, plant::ImuSample& out) {
  Check check;
  check.time(in.stamp_ns())
      .finite("specific_force_frd", in.specific_force_frd())
      .finite("body_rates_frd", in.body_rates_frd());
  if (!check.ok()) return check.fault();
  out = {in.stamp_ns(), in.sequence_number(), vector(in.specific_force_frd()), vector(in.body_rates_frd())};
  return {};
}

msg::Imu to_message(const plant::ImuSample& in) {
  msg::Imu out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.specific_force_frd(array(in.specific_force_frd));
  out.body_rates_frd(array(in.body_rates_frd));
  return out;
}

Fault from_message(const msg::MocapPose& in, plant::PoseSample& out) {
  Check check;
  check.time(in.stamp_ns());
  if (in.tracked())
    check.finite("position_ned", in.position_ned()).unit("q_ned_from_frd", in.q_ned_from_frd());
  if (!check.ok()) return check.fault();
  out = {};
  out.stamp_ns = in.stamp_ns();
  out.sequence = in.sequence_number();
  out.tracked = in.tracked();
  if (in.tracked()) {
    out.position_ned = vector(in.position_ned());
    out.q_ned_from_frd = quaternion(in.q_ned_from_frd());
  }
  return {};
}

msg::MocapPose to_message(const plant::PoseSample& in) {
  msg::MocapPose out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.tracked(in.tracked);
  out.position_ned(array(in.position_ned));
  out.q_ned_from_frd(array(in.q_ned_from_frd));
  return out;
}

Fault from_message(const msg::Battery& in, plant::BatterySample& out) {
  Check check;
  check.time(in.stamp_ns())
      .at_least("voltage_v", in.voltage_v(), 0.0)
      .finite("current_a", in.current_a())
      .within("state_of_charge", in.state_of_charge(), 0.0, 1.0);
  if (!check.ok()) return check.fault();
  out = {in.stamp_ns(), in.sequence_number(), in.voltage_v(), in.current_a(), in.state_of_charge()};
  return {};
}

msg::Battery to_message(const plant::BatterySample& in) {
  msg::Battery out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.voltage_v(in.voltage_v);
  out.current_a(in.current_a);
  out.state_of_charge(in.state_of_charge);
  return out;
}

Fault from_message(const msg::RotorSpeeds& in, plant::RotorSpeedSample& out) {
  Check check;
  check.time(in.stamp_ns()).per_rotor("speeds", in.rotor_count(), in.speeds(), 0.0, kMaxRotorSpeed);
  if (!check.ok()) return check.fault();
  out.stamp_ns = in.stamp_ns();
  out.sequence = in.sequence_number();
  out.rotor_count = in.rotor_count();
  copy_rotors(out.rotor_count, in.speeds(), out.speeds);
  return {};
}

msg::RotorSpeeds to_message(const plant::RotorSpeedSample& in) {
  msg::RotorSpeeds out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.rotor_count(static_cast<std::uint8_t>(in.rotor_count));
  out.speeds(in.speeds);
  return out;
}

Fault from_message(const msg::ActuatorCommand& in, plant::ActuatorCommand& out) {
  Check check;
  check_command(in, check);
  check.per_rotor("throttle", in.rotor_count(), in.throttle(), 0.0, 1.0);
  if (!check.ok()) return check.fault();
  read_header(in, out);
  out.rotor_count = in.rotor_count();
  copy_rotors(out.rotor_count, in.throttle(), out.throttle);
  return {};
}

msg::ActuatorCommand to_message(const plant::ActuatorCommand& in) {
  auto out = with_header<msg::ActuatorCommand>(in);
  out.rotor_count(static_cast<std::uint8_t>(in.rotor_count));
  out.throttle(in.throttle);
  return out;
}

Fault from_message(const msg::RatesSetpoint& in, plant::RatesSetpoint& out) {
  Check check;
  check_command(in, check);
  check.finite("body_rates_frd", in.body_rates_frd()).at_least("thrust_n", in.thrust_n(), 0.0);
  if (!check.ok()) return check.fault();
  read_header(in, out);
  out.body_rates_frd = vector(in.body_rates_frd());
  out.thrust_n = in.thrust_n();
  return {};
}

msg::RatesSetpoint to_message(const plant::RatesSetpoint& in) {
  auto out = with_header<msg::RatesSetpoint>(in);
  out.body_rates_frd(array(in.body_rates_frd));
  out.thrust_n(in.thrust_n);
  return out;
}

Fault from_message(const msg::AttitudeSetpoint& in, plant::AttitudeSetpoint& out) {
  Check check;
  check_command(in, check);
  check.unit("q_ned_from_frd", in.q_ned_from_frd())
      .finite("body_rates_frd", in.body_rates_frd())
      .at_least("thrust_n", in.thrust_n(), 0.0);
  if (!check.ok()) return check.fault();
  read_header(in, out);
  out.q_ned_from_frd = quaternion(in.q_ned_from_frd());
  out.body_rates_frd = vector(in.body_rates_frd());
  out.thrust_n = in.thrust_n();
  return {};
}

msg::AttitudeSetpoint to_message(const plant::AttitudeSetpoint& in) {
  auto out = with_header<msg::AttitudeSetpoint>(in);
  out.q_ned_from_frd(array(in.q_ned_from_frd));
  out.body_rates_frd(array(in.body_rates_frd));
  out.thrust_n(in.thrust_n);
  return out;
}

// Ignores a position that is not used.
Fault from_message(const msg::TrajectorySetpoint& in, plant::TrajectorySetpoint& out) {
  Check check;
  check_command(in, check);
  if (in.position_used()) check.finite("position_ned", in.position_ned());
  check.finite("velocity_ned", in.velocity_ned())
      .finite("acceleration_ned", in.acceleration_ned())
      .finite("yaw", in.yaw())
      .finite("yaw_rate", in.yaw_rate());
  if (!check.ok()) return check.fault();
  read_header(in, out);
  out.position_used = in.position_used();
  out.position_ned = in.position_used() ? vector(in.position_ned()) : Vector3d(Vector3d::Zero());
  out.velocity_ned = vector(in.velocity_ned());
  out.acceleration_ned = vector(in.acceleration_ned());
  out.yaw_rad = in.yaw();
  out.yaw_rate = in.yaw_rate();
  return {};
}

msg::TrajectorySetpoint to_message(const plant::TrajectorySetpoint& in) {
  auto out = with_header<msg::TrajectorySetpoint>(in);
  out.position_used(in.position_used);
  out.position_ned(array(in.position_ned));
  out.velocity_ned(array(in.velocity_ned));
  out.acceleration_ned(array(in.acceleration_ned));
  out.yaw(in.yaw_rad);
  out.yaw_rate(in.yaw_rate);
  return out;
}

Fault from_message(const msg::GroundTruth& in, plant::TruthSample& out) {
  Check check;
  check.time(in.stamp_ns())
      .finite("position_ned", in.position_ned())
      .finite("velocity_ned", in.velocity_ned())
      .unit("q_ned_from_frd", in.q_ned_from_frd())
      .finite("body_rates_frd", in.body_rates_frd())
      .per_rotor("rotor_speeds", in.rotor_count(), in.rotor_speeds(), 0.0, kMaxRotorSpeed)
      .finite("supply_voltage_v", in.supply_voltage_v());
  if (!check.ok()) return check.fault();
  out.stamp_ns = in.stamp_ns();
  out.sequence = in.sequence_number();
  out.position_ned = vector(in.position_ned());
  out.velocity_ned = vector(in.velocity_ned());
  out.q_ned_from_frd = quaternion(in.q_ned_from_frd());
  out.body_rates_frd = vector(in.body_rates_frd());
  out.rotor_count = in.rotor_count();
  copy_rotors(out.rotor_count, in.rotor_speeds(), out.rotor_speeds);
  out.supply_voltage_v = in.supply_voltage_v();
  out.on_ground = in.on_ground();
  return {};
}

msg::GroundTruth to_message(const plant::TruthSample& in) {
  msg::GroundTruth out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.position_ned(array(in.position_ned));
  out.velocity_ned(array(in.velocity_ned));
  out.q_ned_from_frd(array(in.q_ned_from_frd));
  out.body_rates_frd(array(in.body_rates_frd));
  out.rotor_count(static_cast<std::uint8_t>(in.rotor_count));
  out.rotor_speeds(in.rotor_speeds);
  out.supply_voltage_v(in.supply_voltage_v);
  out.on_ground(in.on_ground);
  return out;
}

Fault from_message(const msg::Setpoint& in, control::Setpoint& out) {
  using namespace msg;
  Check check;
  check.time(in.stamp_ns()).at_most("kind", in.kind(), Setpoint_Constants::BODY_RATES);
  const auto kind = static_cast<control::SetpointKind>(in.kind());
  const bool places = kind == control::SetpointKind::kPosition;
  const bool moves = places || kind == control::SetpointKind::kVelocity;
  const bool turns = kind == control::SetpointKind::kAttitude;
  const bool past_position = control::goes_past_position(kind);
  if (places) check.finite("position_ned", in.position_ned());
  if (moves) check.finite("velocity_ned", in.velocity_ned());
  if (turns) check.unit("q_ned_from_frd", in.q_ned_from_frd());
  if (past_position) {
    check.finite("body_rates_frd", in.body_rates_frd()).finite("specific_thrust", in.specific_thrust());
  } else {
    check.finite("acceleration_ned", in.acceleration_ned())
        .finite("yaw", in.yaw_free() ? 0.0 : in.yaw())
        .finite("yaw_rate", in.yaw_rate());
  }
  if (!check.ok()) return check.fault();
  out = {};
  out.stamp_ns = in.stamp_ns();
  out.sequence = in.sequence_number();
  out.kind = kind;
  if (places) out.position_ned = vector(in.position_ned());
  if (moves) out.velocity_ned = vector(in.velocity_ned());
  if (turns) out.q_ned_from_frd = quaternion(in.q_ned_from_frd());
  if (past_position) {
    out.body_rates_frd = vector(in.body_rates_frd());
    out.specific_thrust = in.specific_thrust();
    return {};
  }
  out.acceleration_ned = vector(in.acceleration_ned());
  out.yaw_free = in.yaw_free();
  if (!out.yaw_free) out.yaw_rad = in.yaw();
  out.yaw_rate = in.yaw_rate();
  return {};
}

msg::Setpoint to_message(const control::Setpoint& in) {
  msg::Setpoint out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.kind(static_cast<std::uint8_t>(in.kind));
  out.position_ned(array(in.position_ned));
  out.velocity_ned(array(in.velocity_ned));
  out.acceleration_ned(array(in.acceleration_ned));
  out.yaw_free(in.yaw_free);
  out.yaw(in.yaw_rad);
  out.yaw_rate(in.yaw_rate);
  out.q_ned_from_frd(array(in.q_ned_from_frd));
  out.body_rates_frd(array(in.body_rates_frd));
  out.specific_thrust(in.specific_thrust);
  return out;
}

Fault from_message(const msg::GroundLink& in, control::GroundHeartbeat& out) {
  Check check;
  check.at_least("client", static_cast<double>(in.client()), 1.0).time(in.stamp_ns());
  if (!check.ok()) return check.fault();
  out = {in.client(), in.depends()};
  return {};
}

Fault from_message(const msg::Command& in, control::Request& out) {
  Check check;
  check.at_most("kind", in.kind(), msg::Command_Constants::MISSION_CLEAR);
  const bool placed =
      in.kind() == msg::Command_Constants::GOTO || in.kind() == msg::Command_Constants::TAKEOFF;
  const bool moves = placed || in.kind() == msg::Command_Constants::LAND;
  if (placed) check.finite("position_ned", in.position_ned()).finite("yaw", in.yaw());
  if (moves) check.finite("speed", in.speed());
  if (!check.ok()) return check.fault();
  out = {};
  out.kind = static_cast<control::RequestKind>(in.kind());
  if (placed) {
    out.position_ned = vector(in.position_ned());
    out.yaw_rad = in.yaw();
  }
  out.yaw_free = in.yaw_free();
  if (moves) out.speed = in.speed();
  out.mission_id = in.mission_id();
  out.start_ns = in.start_ns();
  return {};
}

msg::Command to_message(const control::Request& in) {
  msg::Command out;
  out.kind(static_cast<std::uint8_t>(in.kind));
  out.position_ned(array(in.position_ned));
  out.yaw_free(in.yaw_free);
  out.yaw(in.yaw_rad);
  out.speed(in.speed);
  out.mission_id(in.mission_id);
  out.start_ns(in.start_ns);
  return out;
}

Fault from_message(const msg::Mission& in, control::Mission& out) {
  Check check;
  check.at_least("id", static_cast<double>(in.id()), 1.0)
      .at_least("max_speed", in.max_speed(), 0.0)
      .at_least("max_acceleration", in.max_acceleration(), 0.0)
      .at_least("max_jerk", in.max_jerk(), 0.0)
      .at_least("max_yaw_rate", in.max_yaw_rate(), 0.0)
      .finite("fence_min_ned", in.fence_min_ned())
      .finite("fence_max_ned", in.fence_max_ned());
  check.at_most("number of items", in.items().size(), control::kMaxMissionItems);
  for (std::size_t i = 0; check.ok() && i < in.items().size(); ++i) {
    const msg::MissionItem& item = in.items()[i];
    check.of_item("item", i + 1);
    check.at_most("kind", item.kind(), msg::MissionItem_Constants::WAIT)
        .finite("position_ned", item.position_ned())
        .finite("yaw", item.yaw())
        .finite("speed", item.speed())
        .at_least("hold_s", item.hold_s(), 0.0)
        .at_least("acceptance_radius_m", item.acceptance_radius_m(), 0.0);
  }
  check_segments(in.segments(), check);
  if (!check.ok()) return check.fault();
  out.id = in.id();
  out.items.clear();
  out.items.reserve(in.items().size());
  for (const msg::MissionItem& item : in.items()) {
    out.items.push_back({static_cast<control::MissionItemKind>(item.kind()), vector(item.position_ned()),
                         item.yaw(), item.yaw_free(), item.speed(), item.hold_s(), item.first_segment(),
                         item.segment_count(), item.acceptance_radius_m()});
  }
  out.segments = from_messages(in.segments());
  out.bounds = {in.max_speed(),
                in.max_acceleration(),
                in.max_jerk(),
                in.max_yaw_rate(),
                in.fenced(),
                vector(in.fence_min_ned()),
                vector(in.fence_max_ned())};
  return {};
}

msg::Mission to_message(const control::Mission& in) {
  msg::Mission out;
  out.id(in.id);
  out.items().reserve(in.items.size());
  for (const control::MissionItem& item : in.items) {
    msg::MissionItem message;
    message.kind(static_cast<std::uint8_t>(item.kind));
    message.position_ned(array(item.position_ned));
    message.yaw_free(item.yaw_free);
    message.yaw(item.yaw_rad);
    message.speed(item.speed);
    message.hold_s(item.hold_s);
    message.first_segment(item.first_segment);
    message.segment_count(item.segment_count);
    message.acceptance_radius_m(item.acceptance_radius_m);
    out.items().push_back(message);
  }
  out.segments(to_messages(in.segments));
  out.max_speed(in.bounds.max_speed);
  out.max_acceleration(in.bounds.max_acceleration);
  out.max_jerk(in.bounds.max_jerk);
  out.max_yaw_rate(in.bounds.max_yaw_rate);
  out.fenced(in.bounds.fenced);
  out.fence_min_ned(array(in.bounds.fence_min_ned));
  out.fence_max_ned(array(in.bounds.fence_max_ned));
  return out;
}

Fault from_message(const msg::Trajectory& in, control::Trajectory& out) {
  Check check;
  check_segments(in.segments(), check);
  if (!check.ok()) return check.fault();
  out.id = in.id();
  out.segments = from_messages(in.segments());
  return {};
}

msg::Trajectory to_message(const control::Trajectory& in) {
  msg::Trajectory out;
  out.id(in.id);
  out.segments(to_messages(in.segments));
  return out;
}

msg::Estimate to_message(const control::Estimate& in, const control::ErrorState& standard_deviation,
                         double pose_age_s) {
  msg::Estimate out;
  out.stamp_ns(in.stamp_ns);
  out.position_ned(array(in.position_ned));
  out.velocity_ned(array(in.velocity_ned));
  out.q_ned_from_frd(array(in.q_ned_from_frd));
  out.body_rates_frd(array(in.body_rates_frd));
  out.gyro_bias(array(in.gyro_bias));
  out.accelerometer_bias(array(in.accelerometer_bias));
  out.pose_age_s(pose_age_s);
  std::copy(standard_deviation.begin(), standard_deviation.end(), out.standard_deviation().begin());
  out.pose_fault(static_cast<std::uint8_t>(in.pose_fault));
  out.poses_accepted(in.poses_accepted);
  out.poses_refused(in.poses_refused);
  out.resets(in.resets);
  out.reset_position_ned(array(in.reset_position_ned));
  out.reset_rotation_ned(array(in.reset_rotation_ned));
  return out;
}

msg::Reference to_message(const control::Reference& in, const control::AttitudeSetpoint& setpoint,
                          control::Mode mode) {
  msg::Reference out;
  out.mode(static_cast<std::uint8_t>(mode));
  out.position_ned(array(in.position_ned));
  out.velocity_ned(array(in.velocity_ned));
  out.acceleration_ned(array(in.acceleration_ned));
  out.jerk_ned(array(in.jerk_ned));
  out.yaw(in.yaw_rad);
  out.yaw_rate(in.yaw_rate);
  out.attitude_setpoint(
      array(Eigen::Quaterniond(control::attitude_along(setpoint.body_z_ned, setpoint.yaw_rad))));
  out.thrust_setpoint(setpoint.thrust_n);
  out.moment_setpoint(array(setpoint.moment_frd));
  return out;
}

msg::RequestStatus to_message(const control::RequestStatus& in) {
  msg::RequestStatus out;
  out.client(in.key.client);
  out.id(in.key.id);
  out.kind(static_cast<std::uint8_t>(in.kind));
  out.state(static_cast<std::uint8_t>(in.state));
  out.progress(in.progress);
  out.ended_by(kind_of_end(in));
  if (in.state == control::RequestState::kAborted) out.reason_code(static_cast<std::uint8_t>(in.reason));
  out.result() = control::result_of(in);
  return out;
}

}  // namespace swiftlet::messages

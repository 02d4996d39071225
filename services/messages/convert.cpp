#include "swiftlet/services/messages/convert.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::messages {
namespace {

using namespace wire;

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

}  // namespace

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
  check.at_most("kind", in.kind(), msg::Command_Constants::HOVER_TEST);
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
    check.at_most("kind", item.kind(), std::size(control::kMissionItemKinds) - 1)
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

// Example messages with a distinct value in every field.
#pragma once

#include <array>
#include <cstddef>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/topics.hpp"
#include "swiftlet/services/messages/wire_version.hpp"

namespace swiftlet::messages::fixtures {

inline plant::PerRotor four_rotors(double first) { return {first, first + 0.1, first + 0.2, first + 0.3}; }

inline plant::ImuSample imu_sample() { return {1001, 11, {0.1, -0.2, -9.8}, {0.3, -0.4, 0.5}}; }
inline plant::OdometrySample odometry_sample() {
  plant::OdometrySample sample;
  sample.stamp_ns = 1012;
  sample.sequence = 23;
  sample.position_valid = true;
  sample.position_ned = {1.0, -2.0, -3.0};
  sample.velocity_valid = true;
  sample.velocity_ned = {0.4, -0.5, 0.6};
  sample.q_ned_from_frd = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  sample.body_rates_frd = {0.1, -0.2, 0.3};
  sample.position_deviation = {0.01, 0.02, 0.03};
  sample.velocity_deviation = {0.04, 0.05, 0.06};
  sample.rotation_deviation = {0.07, 0.08, 0.09};
  sample.resets = 3;
  sample.fuses_mocap = true;
  return sample;
}
inline plant::PoseSample pose_sample() {
  return {1002, 12, true, {1.0, -2.0, -3.0}, Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5)};
}
inline plant::BatterySample battery_sample() { return {1003, 13, 3.9, 2.5, 0.75}; }
inline plant::RotorSpeedSample rotor_speed_sample() { return {1004, 14, 4, four_rotors(1600.0)}; }
inline plant::CommandHeader command_header() { return {1005, 15, 11, 12, plant::RotorState::kRunning, 21}; }
inline plant::ActuatorCommand actuator_command() { return {command_header(), 4, four_rotors(0.3)}; }
inline plant::RatesSetpoint rates_setpoint() { return {command_header(), {0.1, -0.2, 0.3}, 1.25}; }
inline plant::AttitudeSetpoint attitude_setpoint() {
  return {command_header(), Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5), {0.1, -0.2, 0.3}, 1.25};
}
inline plant::TrajectorySetpoint trajectory_setpoint() {
  return {command_header(), true, {1.0, -2.0, -3.0}, {0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, 0.7, 0.8};
}
inline plant::TruthSample truth_sample() {
  return {1006,
          16,
          {1.0, 2.0, -3.0},
          {0.1, 0.2, 0.3},
          Eigen::Quaterniond(0.5, 0.5, -0.5, -0.5),
          {-0.1, 0.2, -0.3},
          4,
          four_rotors(1500.0),
          3.8,
          true};
}
inline control::Setpoint setpoint() {
  control::Setpoint setpoint;
  setpoint.stamp_ns = 1007;
  setpoint.sequence = 17;
  setpoint.position_ned = {1.0, 2.0, -1.0};
  setpoint.velocity_ned = {0.1, 0.2, 0.3};
  setpoint.acceleration_ned = {0.4, 0.5, 0.6};
  setpoint.yaw_rad = 0.7;
  setpoint.yaw_rate = 0.8;
  return setpoint;
}
inline control::Request request() {
  control::Request request;
  request.kind = control::RequestKind::kGoTo;
  request.position_ned = {1.0, -1.0, -1.5};
  request.yaw_rad = 0.3;
  request.yaw_free = false;
  request.speed = 0.4;
  request.start_ns = 7'000'000'000;
  return request;
}
inline std::vector<control::PolynomialSegment> polynomials(std::size_t count) {
  std::vector<control::PolynomialSegment> segments;
  for (std::size_t i = 0; i < count; ++i) {
    control::PolynomialSegment& segment = segments.emplace_back();
    segment.duration_s = 1.0 + static_cast<double>(i);
    for (std::size_t k = 0; k < segment.x.size(); ++k) {
      const double c = static_cast<double>(8 * i + k);
      segment.x[k] = c;
      segment.y[k] = -c;
      segment.z[k] = 0.5 * c;
      segment.yaw[k] = 0.25 * c;
    }
  }
  return segments;
}
inline control::Trajectory trajectory(std::size_t segments) { return {19, polynomials(segments)}; }
inline control::Mission mission(std::size_t items, std::size_t segments = 3) {
  control::Mission mission{18, {}, polynomials(segments), {}};
  mission.bounds = {1.1, 1.2, 1.3, 1.4, true, {-1.5, -1.6, -1.7}, {1.8, 1.9, 0.1}};
  for (std::size_t i = 0; i < items; ++i) {
    const double x = static_cast<double>(i);
    mission.items.push_back(
        {control::MissionItemKind::kWaypoint, {x, -x, -1.0 - x}, 0.001 * x, i % 2 == 0, 0.5, x});
  }
  mission.items.back().kind = control::MissionItemKind::kTrajectory;
  mission.items.back().first_segment = 1;
  mission.items.back().segment_count = 2;
  mission.items.front().acceptance_radius_m = 0.05;
  return mission;
}

// A distinct value in every gain.
inline control::ControlGains control_gains(double first) {
  return {{first, first + 0.1, first + 0.2},
          {3.0, 3.1, 3.2},
          {4.0, 4.1, 4.2},
          {5.0, 5.1, 5.2},
          {6.0, 6.1, 6.2},
          {7.0, 7.1, 7.2},
          8.0,
          first + 9.0,
          10.0};
}
inline control::SettingsRequest settings_request() {
  control::SettingsRequest request;
  request.name = "soft";
  request.ramp_s = 3.0;
  request.tunable.roll = {{1.0, 2.0, 3.0}, 4.0};
  request.tunable.pitch = {{5.0, 6.0, 7.0}, 8.0};
  request.tunable.yaw = {{9.0, 10.0, 11.0}, 12.0};
  request.tunable.position = {{1.1, 1.2, 1.3, 1.4}, {2.1, 2.2, 2.3, 2.4}, {3.1, 3.2, 3.3, 3.4}, 1.5};
  request.tunable.disturbance = {20.0, 2.5};
  request.fixed = {{"limits.max_speed_m_s", "2.0"}, {"attitude.error", "rotation"}};
  return request;
}
inline ControllerReport controller_report() {
  ControllerReport report;
  report.stamp_ns = 1010;
  report.sequence = 22;
  report.controller = 23;
  report.failover_priority = 24;
  report.term = 25;
  report.active = true;
  report.ready = true;
  control::SupervisorState& state = report.flight.supervisor;
  state.mode = control::Mode::kMission;
  state.reason = control::Reason::kRequested;
  state.guidance.phase = control::Phase::kPath;
  state.guidance.airborne = true;
  state.now_ns = report.stamp_ns;
  state.mode_since_ns = 26;
  state.guidance.phase_since_ns = 27;
  state.guidance.path.follow(trajectory(2).segments[1], 28);
  state.guidance.climb_to_z_ned = -1.5;
  state.guidance.climb_speed = 0.75;
  state.guidance.ground_z_ned = 0.25;
  state.guidance.mission = {29, control::MissionState::kRunning, 30, 31};
  state.guidance.item_end_ns = 32;
  state.guidance.path.clock = {false, 55, 56, 1.5, {1.0, 0.0, 0.0, -2.9, 2.9, -0.8, 0.0, 0.0}};
  state.guidance.pause = control::MissionPause::kReturning;
  state.guidance.paused_path = {trajectory(3).segments[2], 57, 58, 59};
  state.guidance.trajectory_id = 33;
  state.guidance.next_segment = 34;
  state.guidance.setpoint_ns = 35;
  state.guidance.setpoint_kind = control::SetpointKind::kBodyRates;
  state.guidance.direct = {{0.5, -0.5, 0.5, -0.5}, {0.1, 0.2, 0.3}, 9.5};
  state.contact_since_ns = 36;
  state.low_battery_since_ns = 37;
  state.critical_battery_since_ns = 46;
  state.land_on_return = true;
  state.ground_links = {{{47, 48}, {49, 50}, {51, 52}, {53, 54}}};
  using control::Event;
  using control::Reason;
  using control::RequestKind;
  using control::RequestState;
  state.requests = {
      {{{38, 39}, RequestKind::kMissionUpload, RequestState::kSucceeded, Event::kArm, Reason::kStarted, 1.0},
       {{40, 41}, RequestKind::kMissionStart, RequestState::kExecuting, Event::kArm, Reason::kStarted, 0.4},
       {{42, 43}, RequestKind::kGoTo, RequestState::kCanceled, Event::kHold, Reason::kRequested, 0.3},
       {{44, 45}, RequestKind::kLand, RequestState::kAborted, Event::kTippedOver, Reason::kTippedOver, 0.2}}};
  report.flight.position_integral = {0.1, -0.2, 0.3};
  report.flight.lift_ratio = 0.91;
  report.flight.gains = {control_gains(1.0), control_gains(2.0), control::settings_name("soft"), 60, 2.5};
  report.flight.rotor_state = plant::RotorState::kRunning;
  report.rotor_count = 4;
  report.flight.throttle = four_rotors(0.4);
  return report;
}

template <class T>
T example();
template <>
inline msg::Imu example() {
  return to_message(imu_sample());
}
template <>
inline msg::VehicleOdometry example() {
  return to_message(odometry_sample());
}
template <>
inline msg::MocapPose example() {
  return to_message(pose_sample());
}
template <>
inline msg::Battery example() {
  return to_message(battery_sample());
}
template <>
inline msg::RotorSpeeds example() {
  return to_message(rotor_speed_sample());
}
template <>
inline msg::ClockRequest example() {
  msg::ClockRequest message;
  message.client(7);
  message.sequence_number(2);
  message.sent_ns(1'000'000'000);
  return message;
}
template <>
inline msg::ClockReply example() {
  msg::ClockReply message;
  message.client(7);
  message.sequence_number(2);
  message.sent_ns(1'000'000'000);
  message.received_ns(5'000'000);
  message.answered_ns(5'020'000);
  return message;
}
template <>
inline msg::ClockStatus example() {
  msg::ClockStatus message;
  message.stamp_ns(5'000'000);
  message.sequence_number(3);
  message.offset_ns(3'000'000'000);
  message.drift(50e-6);
  message.drift_uncertainty(3e-6);
  message.uncertainty_ns(48e3);
  message.round_trip_ns(90e3);
  message.steps(1);
  message.known(true);
  return message;
}
template <>
inline msg::ActuatorCommand example() {
  return to_message(actuator_command());
}
template <>
inline msg::RatesSetpoint example() {
  return to_message(rates_setpoint());
}
template <>
inline msg::AttitudeSetpoint example() {
  return to_message(attitude_setpoint());
}
template <>
inline msg::TrajectorySetpoint example() {
  return to_message(trajectory_setpoint());
}
template <>
inline msg::GroundTruth example() {
  return to_message(truth_sample());
}
template <>
inline msg::ControllerState example() {
  return to_message(controller_report());
}
template <>
inline msg::Setpoint example() {
  return to_message(setpoint());
}
template <>
inline msg::GroundLink example() {
  msg::GroundLink message;
  message.client(3);
  message.sequence_number(4);
  message.stamp_ns(5);
  message.depends(true);
  return message;
}
template <>
inline msg::Command example() {
  msg::Command message = to_message(request());
  message.client(3);
  message.id(4);
  return message;
}
template <>
inline msg::Mission example() {
  msg::Mission message = to_message(mission(5));
  message.client(3);
  return message;
}
template <>
inline msg::Trajectory example() {
  msg::Trajectory message = to_message(trajectory(3));
  message.client(3);
  return message;
}
template <>
inline msg::ControlSettings example() {
  msg::ControlSettings message = to_message(settings_request());
  message.client(3);
  message.id(4);
  return message;
}
template <>
inline msg::SimulationClock example() {
  msg::SimulationClock message;
  message.sequence_number(6);
  message.advance_to_ns(100'000'000);
  return message;
}
template <>
inline msg::Estimate example() {
  control::Estimate estimate;
  estimate.stamp_ns = 1008;
  estimate.position_ned = {1.0, 2.0, 3.0};
  estimate.velocity_ned = {4.0, 5.0, 6.0};
  estimate.q_ned_from_frd = Eigen::Quaterniond(0.5, -0.5, -0.5, -0.5);
  estimate.body_rates_frd = {7.0, 8.0, 9.0};
  estimate.gyro_bias = {0.1, 0.2, 0.3};
  estimate.accelerometer_bias = {0.4, 0.5, 0.6};
  estimate.pose_fault = control::PoseFault::kSwapped;
  estimate.poses_accepted = 1010;
  estimate.poses_refused = 11;
  estimate.resets = 2;
  estimate.reset_position_ned = {0.7, 0.8, 0.9};
  estimate.reset_rotation_ned = {-0.1, -0.2, -0.3};
  return to_message(estimate, control::ErrorState::LinSpaced(0.01, 0.15), 0.02);
}
template <>
inline msg::Reference example() {
  control::Reference reference;
  reference.position_ned = {1.0, 2.0, 3.0};
  reference.velocity_ned = {4.0, 5.0, 6.0};
  reference.acceleration_ned = {0.1, 0.2, 0.3};
  reference.jerk_ned = {0.4, 0.5, 0.6};
  reference.yaw_rad = 0.7;
  reference.yaw_rate = 0.8;
  return to_message(reference, {{0.6, 0.0, 0.8}, 0.3, 0.39, {0.01, 0.02, 0.03}}, control::Mode::kMission);
}
template <>
inline msg::ControlStatus example() {
  msg::ControlStatus message;
  message.wire_version(kWireVersion);
  message.stamp_ns(1009);
  message.sequence_number(20);
  message.mode(msg::ControlStatus_Constants::MODE_HOLDING);
  message.reason_code(msg::ControlStatus_Constants::REASON_REQUESTED);
  message.reason() = "arrived";
  message.airborne(true);
  message.has_pose(true);
  message.pose_age_s(0.015);
  message.imu_age_s(0.001);
  message.mocap_age_s(0.012);
  message.battery_age_s(0.07);
  message.source_conflict() = "poses of b are ignored: those of a are used";
  message.supply_voltage_v(3.7);
  message.saturated(true);
  message.cycles(1000);
  message.deadline_misses(2);
  message.rate_hz(499.5);
  message.step_time_max_us(80.0);
  message.loop_delay_p50_s(0.003);
  message.loop_delay_p95_s(0.004);
  message.delay_margin_s(0.05);
  message.delay_near_margin(true);
  message.realtime_scheduling(true);
  message.low_battery_voltage_v(3.4);
  message.critical_battery_voltage_v(3.2);
  return message;
}
template <>
inline msg::MissionStatus example() {
  msg::MissionStatus message;
  message.stamp_ns(1010);
  message.sequence_number(21);
  message.mission_id(18);
  message.state(msg::MissionStatus_Constants::ABORTED);
  message.item_index(3);
  message.item_count(5);
  message.reason() = "mocap lost";
  return message;
}
template <>
inline msg::CommandAck example() {
  msg::CommandAck message;
  message.client(3);
  message.id(4);
  message.accepted(false);
  message.reason() = std::string(192, 'x');  // maximum length
  return message;
}
template <>
inline msg::VehicleInfo example() {
  msg::VehicleInfo message;
  message.wire_version(kWireVersion);
  message.stamp_ns(1011);
  message.sequence_number(22);
  message.name() = "kaylion";
  message.simulated(true);
  message.autopilot() = "MAVLink on TCP port 4560";
  message.rotor_count(4);
  message.mass_kg(0.04);
  message.imu_rate_hz(500.0);
  message.rotors_running(true);
  message.answered(100);
  message.unanswered(1);
  message.sense_to_actuate_p50_us(60.0);
  message.sense_to_actuate_p99_us(120.0);
  message.sense_to_actuate_max_us(400.0);
  message.fault() = "no actuator command for 0.2 s";
  message.boot(12345);
  message.full_battery_v(4.19);
  message.empty_battery_v(2.65);
  return message;
}
template <>
inline msg::FlownFiles example() {
  msg::FlownFiles message;
  message.program() = "swiftlet-control 0.1.0";
  message.vehicle().sha256() = std::string(64, 'a');
  message.vehicle().text() = std::string(65536, 'v');  // maximum length
  message.control().sha256() = std::string(64, 'b');
  message.control().text() = "n: 1";
  return message;
}

}  // namespace swiftlet::messages::fixtures

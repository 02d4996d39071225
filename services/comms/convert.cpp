#include "services/comms/convert.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "control/attitude/attitude_error.hpp"

namespace swiftlet::comms {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kQuaternionTolerance = 1e-3;  // of the norm
constexpr double kRounding = 1e-12;

using Vector3 = std::array<double, 3>;
using Vector4 = std::array<double, 4>;
using PerRotor = std::array<double, plant::kMaxRotors>;

Vector3d vector(const Vector3& in) { return {in[0], in[1], in[2]}; }
Vector3 array(const Vector3d& in) { return {in.x(), in.y(), in.z()}; }
// What differs from unit length by rounding only stays as it is: a sample that was sent is the one that was
// taken.
Quaterniond quaternion(const Vector4& in) {
  const Quaterniond q(in[0], in[1], in[2], in[3]);
  return std::abs(q.squaredNorm() - 1.0) < kRounding ? q : q.normalized();
}
Vector4 array(const Quaterniond& in) { return {in.w(), in.x(), in.y(), in.z()}; }

// Collects the first fault of a message; later checks are skipped.
class Check {
 public:
  // What follows is checked of the item of this number, counted from 1.
  void of_item(const char* item, std::size_t number) {
    item_ = item;
    number_ = number;
  }

  Check& finite(const char* field, double value) {
    if (ok() && !std::isfinite(value)) fail("%s is %g, must be finite", field, value);
    return *this;
  }
  template <std::size_t kSize>
  Check& finite(const char* field, const std::array<double, kSize>& values) {
    for (std::size_t i = 0; ok() && i < kSize; ++i) {
      if (!std::isfinite(values[i])) fail("%s[%zu] is %g, must be finite", field, i, values[i]);
    }
    return *this;
  }
  Check& within(const char* field, double value, double min, double max) {
    if (ok() && !(value >= min && value <= max))
      fail("%s is %g, must be between %g and %g", field, value, min, max);
    return *this;
  }
  Check& at_least(const char* field, double value, double min) {
    finite(field, value);
    if (ok() && value < min) fail("%s is %g, must be at least %g", field, value, min);
    return *this;
  }
  Check& at_most(const char* field, std::uint64_t value, std::uint64_t max) {
    if (ok() && value > max) {
      fail("%s is %llu, must be at most %llu", field, static_cast<unsigned long long>(value),
           static_cast<unsigned long long>(max));
    }
    return *this;
  }
  Check& unit(const char* field, const Vector4& q) {
    finite(field, q);
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (ok() && std::abs(norm - 1.0) > kQuaternionTolerance) {
      fail("%s has the length %g, must be 1 within %g", field, norm, kQuaternionTolerance);
    }
    return *this;
  }
  Check& time(std::int64_t stamp_ns) {
    if (ok() && stamp_ns < 0) fail("stamp_ns is %lld, must be at least 0", static_cast<long long>(stamp_ns));
    return *this;
  }
  // The first `count` of the values lie within the bounds, and there are no more than fit.
  Check& per_rotor(const char* field, int count, const PerRotor& values, double min, double max) {
    at_most("rotor_count", static_cast<std::uint64_t>(count), plant::kMaxRotors);
    for (std::size_t i = 0; ok() && i < static_cast<std::size_t>(count); ++i) {
      if (!(values[i] >= min && values[i] <= max)) {
        fail("%s[%zu] is %g, must be between %g and %g", field, i, values[i], min, max);
      }
    }
    return *this;
  }

  bool ok() const { return !fault_; }
  Fault fault() const { return fault_; }

 private:
  [[gnu::format(printf, 2, 3)]] void fail(const char* format, ...) {
    int length = 0;
    if (number_ > 0) length = std::snprintf(fault_.text, sizeof fault_.text, "%s %zu: ", item_, number_);
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(fault_.text + length, sizeof fault_.text - static_cast<std::size_t>(length), format,
                   values);
    va_end(values);
  }

  const char* item_ = "";
  std::size_t number_ = 0;  // 0: the message itself is checked
  Fault fault_;
};

constexpr std::uint64_t kMaxStrength = 1000;
constexpr std::size_t kReplicatedStateBytes = 488;
constexpr double kMaxRotorSpeed = 1e5;  // rad/s; none turns as fast

void copy_rotors(int count, const PerRotor& from, PerRotor& to) {
  to = {};
  std::copy_n(from.begin(), count, to.begin());
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

plant::ObeyedCommand obeyed_command(const msg::Imu& in) {
  const bool told = in.commands() != msg::Imu_Constants::COMMANDS_UNTOLD;
  return {told, in.commands() == msg::Imu_Constants::COMMANDS_OBEYED, in.command_term(),
          in.command_stamp_ns()};
}

void tell(const plant::ObeyedCommand& obeyed, msg::Imu& in) {
  using namespace msg::Imu_Constants;
  in.commands(!obeyed.told ? COMMANDS_UNTOLD : obeyed.any ? COMMANDS_OBEYED : COMMANDS_NONE);
  in.command_term(obeyed.term);
  in.command_stamp_ns(obeyed.stamp_ns);
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
  check.time(in.stamp_ns())
      .at_most("rotor_state", in.rotor_state(), msg::ActuatorCommand_Constants::ROTORS_RUNNING)
      .per_rotor("throttle", in.rotor_count(), in.throttle(), 0.0, 1.0);
  if (!check.ok()) return check.fault();
  out.stamp_ns = in.stamp_ns();
  out.sequence = in.sequence_number();
  out.imu_sequence = in.imu_sequence_number();
  out.mocap_sequence = in.mocap_sequence_number();
  out.rotor_state = static_cast<plant::RotorState>(in.rotor_state());
  out.rotor_count = in.rotor_count();
  copy_rotors(out.rotor_count, in.throttle(), out.throttle);
  out.term = in.term();
  return {};
}

msg::ActuatorCommand to_message(const plant::ActuatorCommand& in) {
  msg::ActuatorCommand out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.imu_sequence_number(in.imu_sequence);
  out.mocap_sequence_number(in.mocap_sequence);
  out.rotor_state(static_cast<std::uint8_t>(in.rotor_state));
  out.rotor_count(static_cast<std::uint8_t>(in.rotor_count));
  out.throttle(in.throttle);
  out.term(in.term);
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
  Check check;
  check.time(in.stamp_ns())
      .finite("position_ned", in.position_ned())
      .finite("velocity_ned", in.velocity_ned())
      .finite("acceleration_ned", in.acceleration_ned())
      .finite("yaw", in.yaw())
      .finite("yaw_rate", in.yaw_rate());
  if (!check.ok()) return check.fault();
  out = {in.stamp_ns(),
         in.sequence_number(),
         vector(in.position_ned()),
         vector(in.velocity_ned()),
         vector(in.acceleration_ned()),
         in.yaw(),
         in.yaw_rate()};
  return {};
}

msg::Setpoint to_message(const control::Setpoint& in) {
  msg::Setpoint out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.position_ned(array(in.position_ned));
  out.velocity_ned(array(in.velocity_ned));
  out.acceleration_ned(array(in.acceleration_ned));
  out.yaw(in.yaw_rad);
  out.yaw_rate(in.yaw_rate);
  return out;
}

Fault from_message(const msg::GroundLink& in, control::GroundSign& out) {
  Check check;
  check.at_least("client", static_cast<double>(in.client()), 1.0).time(in.stamp_ns());
  if (!check.ok()) return check.fault();
  out = {in.client(), in.depends()};
  return {};
}

Fault from_message(const msg::Command& in, control::Request& out) {
  Check check;
  check.at_most("kind", in.kind(), msg::Command_Constants::STOP);
  const bool placed =
      in.kind() == msg::Command_Constants::GOTO || in.kind() == msg::Command_Constants::TAKEOFF;
  if (placed) check.finite("position_ned", in.position_ned()).finite("yaw", in.yaw());
  check.finite("speed", in.speed());
  if (!check.ok()) return check.fault();
  out = {};
  out.kind = static_cast<control::RequestKind>(in.kind());
  if (placed) {
    out.position_ned = vector(in.position_ned());
    out.yaw_rad = in.yaw();
  }
  out.yaw_free = in.yaw_free();
  out.speed = in.speed();
  return {};
}

msg::Command to_message(const control::Request& in) {
  msg::Command out;
  out.kind(static_cast<std::uint8_t>(in.kind));
  out.position_ned(array(in.position_ned));
  out.yaw_free(in.yaw_free);
  out.yaw(in.yaw_rad);
  out.speed(in.speed);
  return out;
}

Fault from_message(const msg::Mission& in, control::Mission& out) {
  Check check;
  check.at_most("number of items", in.items().size(), control::kMaxMissionItems);
  for (std::size_t i = 0; check.ok() && i < in.items().size(); ++i) {
    const msg::MissionItem& item = in.items()[i];
    check.of_item("item", i + 1);
    check.at_most("kind", item.kind(), msg::MissionItem_Constants::LAND)
        .finite("position_ned", item.position_ned())
        .finite("yaw", item.yaw())
        .finite("speed", item.speed())
        .at_least("hold_s", item.hold_s(), 0.0);
  }
  if (!check.ok()) return check.fault();
  out.id = in.id();
  out.items.clear();
  out.items.reserve(in.items().size());
  for (const msg::MissionItem& item : in.items()) {
    out.items.push_back({static_cast<control::MissionItemKind>(item.kind()), vector(item.position_ned()),
                         item.yaw(), item.yaw_free(), item.speed(), item.hold_s()});
  }
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
    out.items().push_back(message);
  }
  return out;
}

Fault from_message(const msg::Trajectory& in, control::Trajectory& out) {
  Check check;
  check.at_most("number of segments", in.segments().size(), control::kMaxTrajectorySegments);
  for (std::size_t i = 0; check.ok() && i < in.segments().size(); ++i) {
    const msg::PolynomialSegment& segment = in.segments()[i];
    check.of_item("segment", i + 1);
    check.at_least("duration_s", segment.duration_s(), 0.0)
        .finite("x", segment.x())
        .finite("y", segment.y())
        .finite("z", segment.z())
        .finite("yaw", segment.yaw());
  }
  if (!check.ok()) return check.fault();
  out.id = in.id();
  out.segments.clear();
  out.segments.reserve(in.segments().size());
  for (const msg::PolynomialSegment& segment : in.segments()) {
    out.segments.push_back({segment.duration_s(), segment.x(), segment.y(), segment.z(), segment.yaw()});
  }
  return {};
}

msg::Trajectory to_message(const control::Trajectory& in) {
  msg::Trajectory out;
  out.id(in.id);
  out.segments().reserve(in.segments.size());
  for (const control::PolynomialSegment& segment : in.segments) {
    msg::PolynomialSegment message;
    message.duration_s(segment.duration_s);
    message.x(segment.x);
    message.y(segment.y);
    message.z(segment.z);
    message.yaw(segment.yaw);
    out.segments().push_back(message);
  }
  return out;
}

Fault from_message(const msg::ControllerState& in, ControllerReport& out) {
  using namespace msg;
  Check check;
  check.time(in.stamp_ns())
      .at_most("strength", in.strength(), kMaxStrength)
      .at_most("role", in.role(), ControllerState_Constants::ACTIVE)
      .at_most("mode", in.mode(), ControlStatus_Constants::MODE_STOPPED)
      .at_most("reason", in.reason(), control::kReasonCount - 1)
      .at_most("phase", in.phase(), static_cast<std::uint64_t>(control::Phase::kSink))
      .at_least("path_duration_s", in.path_duration_s(), 0.0)
      .finite("path_x", in.path_x())
      .finite("path_y", in.path_y())
      .finite("path_z", in.path_z())
      .finite("path_yaw", in.path_yaw())
      .finite("climb_to_z_ned", in.climb_to_z_ned())
      .finite("climb_speed", in.climb_speed())
      .finite("ground_z_ned", in.ground_z_ned())
      .at_most("mission_state", in.mission_state(), MissionStatus_Constants::ABORTED)
      .at_most("item_count", in.item_count(), control::kMaxMissionItems)
      .at_most("item_index", in.item_index(), in.item_count())
      .at_most("next_segment", in.next_segment(), control::kMaxTrajectorySegments)
      .finite("position_integral_ned", in.position_integral_ned())
      .at_most("rotor_state", in.rotor_state(), ActuatorCommand_Constants::ROTORS_RUNNING)
      .per_rotor("throttle", in.rotor_count(), in.throttle(), 0.0, 1.0);
  if (!check.ok()) return check.fault();
  out.stamp_ns = in.stamp_ns();
  out.sequence = in.sequence_number();
  out.controller = in.controller();
  out.strength = static_cast<int>(in.strength());
  out.term = in.term();
  out.active = in.role() == ControllerState_Constants::ACTIVE;
  out.ready = in.ready();

  control::SupervisorState& state = out.flight.supervisor;
  state.mode = static_cast<control::Mode>(in.mode());
  state.reason = static_cast<control::Reason>(in.reason());
  state.phase = static_cast<control::Phase>(in.phase());
  state.airborne = in.airborne();
  state.now_ns = in.stamp_ns();
  state.mode_since_ns = in.mode_since_ns();
  state.phase_since_ns = in.phase_since_ns();
  state.path.moving = in.path_moving();
  state.path.segment = {in.path_duration_s(), in.path_x(), in.path_y(), in.path_z(), in.path_yaw()};
  state.path.start_ns = in.path_start_ns();
  state.path.end_ns = in.path_end_ns();
  state.climb_to_z_ned = in.climb_to_z_ned();
  state.climb_speed = in.climb_speed();
  state.ground_z_ned = in.ground_z_ned();
  state.mission = {in.mission_id(), static_cast<control::MissionState>(in.mission_state()),
                   static_cast<int>(in.item_index()), static_cast<int>(in.item_count())};
  state.item_end_ns = in.item_end_ns();
  state.trajectory_id = in.trajectory_id();
  state.next_segment = in.next_segment();
  state.setpoint_ns = in.setpoint_ns();
  state.contact_since_ns = in.contact_since_ns();
  state.low_battery_since_ns = in.low_battery_since_ns();
  state.critical_battery_since_ns = in.critical_battery_since_ns();
  state.land_on_return = in.land_on_return();
  for (std::size_t i = 0; i < state.ground_links.size(); ++i)
    state.ground_links[i] = {in.ground_link_clients()[i], in.ground_link_heard_ns()[i]};
  out.flight.position_integral = vector(in.position_integral_ned());
  out.flight.rotor_state = static_cast<plant::RotorState>(in.rotor_state());
  out.rotor_count = in.rotor_count();
  copy_rotors(out.rotor_count, in.throttle(), out.flight.throttle);
  for (std::size_t i = 0; i < out.accepted.size(); ++i)
    out.accepted[i] = {in.accepted_clients()[i], in.accepted_ids()[i]};
  return {};
}

// Whoever adds to the state adds to the message: else a standby would go on without it.
static_assert(sizeof(control::SupervisorState) == kReplicatedStateBytes,
              "controller_state does not carry all of SupervisorState");

msg::ControllerState to_message(const ControllerReport& in) {
  const control::SupervisorState& state = in.flight.supervisor;
  msg::ControllerState out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.controller(in.controller);
  out.strength(static_cast<std::uint32_t>(in.strength));
  out.term(in.term);
  out.role(in.active ? msg::ControllerState_Constants::ACTIVE : msg::ControllerState_Constants::STANDBY);
  out.ready(in.ready);
  out.mode(static_cast<std::uint8_t>(state.mode));
  out.reason(static_cast<std::uint8_t>(state.reason));
  out.phase(static_cast<std::uint8_t>(state.phase));
  out.airborne(state.airborne);
  out.mode_since_ns(state.mode_since_ns);
  out.phase_since_ns(state.phase_since_ns);
  out.path_moving(state.path.moving);
  out.path_start_ns(state.path.start_ns);
  out.path_end_ns(state.path.end_ns);
  out.path_duration_s(state.path.segment.duration_s);
  out.path_x(state.path.segment.x);
  out.path_y(state.path.segment.y);
  out.path_z(state.path.segment.z);
  out.path_yaw(state.path.segment.yaw);
  out.climb_to_z_ned(state.climb_to_z_ned);
  out.climb_speed(state.climb_speed);
  out.ground_z_ned(state.ground_z_ned);
  out.mission_id(state.mission.id);
  out.mission_state(static_cast<std::uint8_t>(state.mission.state));
  out.item_index(static_cast<std::uint32_t>(state.mission.item_index));
  out.item_count(static_cast<std::uint32_t>(state.mission.item_count));
  out.item_end_ns(state.item_end_ns);
  out.trajectory_id(state.trajectory_id);
  out.next_segment(state.next_segment);
  out.setpoint_ns(state.setpoint_ns);
  out.contact_since_ns(state.contact_since_ns);
  out.low_battery_since_ns(state.low_battery_since_ns);
  out.critical_battery_since_ns(state.critical_battery_since_ns);
  out.land_on_return(state.land_on_return);
  for (std::size_t i = 0; i < state.ground_links.size(); ++i) {
    out.ground_link_clients()[i] = state.ground_links[i].client;
    out.ground_link_heard_ns()[i] = state.ground_links[i].heard_ns;
  }
  out.position_integral_ned(array(in.flight.position_integral));
  out.rotor_state(static_cast<std::uint8_t>(in.flight.rotor_state));
  out.rotor_count(static_cast<std::uint8_t>(in.rotor_count));
  out.throttle(in.flight.throttle);
  for (std::size_t i = 0; i < in.accepted.size(); ++i) {
    out.accepted_clients()[i] = in.accepted[i].client;
    out.accepted_ids()[i] = in.accepted[i].id;
  }
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

}  // namespace swiftlet::comms

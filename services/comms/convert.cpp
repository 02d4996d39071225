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

msg::Estimate to_message(const control::Estimate& in, double pose_age_s) {
  msg::Estimate out;
  out.stamp_ns(in.stamp_ns);
  out.position_ned(array(in.position_ned));
  out.velocity_ned(array(in.velocity_ned));
  out.q_ned_from_frd(array(in.q_ned_from_frd));
  out.body_rates_frd(array(in.body_rates_frd));
  out.gyro_bias(array(in.gyro_bias));
  out.accelerometer_bias(array(in.accelerometer_bias));
  out.pose_age_s(pose_age_s);
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

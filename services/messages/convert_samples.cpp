// Samples of sensors, the ground truth, and the commands of each level.
#include <cmath>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::messages {
namespace {

using namespace wire;

constexpr double kMaxRotorSpeed = 1e5;  // rad/s, above any real rotor

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

plant::LockstepInputs from_message(const msg::LockstepInputs& in) {
  return {in.mocap_pose(), in.battery(), in.rotor_speeds()};
}

msg::LockstepInputs to_message(const plant::LockstepInputs& in) {
  msg::LockstepInputs out;
  out.mocap_pose(in.mocap_pose);
  out.battery(in.battery);
  out.rotor_speeds(in.rotor_speeds);
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

}  // namespace swiftlet::messages

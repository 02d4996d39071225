#include "swiftlet/services/vehicle_template/wire.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::services {
namespace {

constexpr double kFullThrottle = 65535.0;

std::array<double, 3> widened(const std::array<float, 3>& vector) {
  return {vector[0], vector[1], vector[2]};
}

}  // namespace

messages::msg::Imu to_message(const protocol::Imu& in) {
  using namespace messages::msg::ObeyedCommand_Constants;
  messages::msg::Imu out;
  out.stamp_ns(protocol::ns_of_us(in.stamp_us));
  out.specific_force_frd(widened(in.specific_force_frd));
  out.body_rates_frd(widened(in.body_rates_frd));
  out.obeyed().state(in.has_command != 0 ? OBEYED : NONE);
  out.obeyed().term(in.command_term);
  out.obeyed().stamp_ns(protocol::ns_of_us(in.command_stamp_us));
  return out;
}

messages::msg::RotorSpeeds to_message(const protocol::RotorSpeeds& in) {
  messages::msg::RotorSpeeds out;
  out.stamp_ns(protocol::ns_of_us(in.stamp_us));
  out.rotor_count(in.rotor_count);
  std::copy(in.speeds.begin(), in.speeds.end(), out.speeds().begin());
  return out;
}

messages::msg::Battery to_message(const protocol::Battery& in) {
  messages::msg::Battery out;
  out.stamp_ns(protocol::ns_of_us(in.stamp_us));
  out.voltage_v(in.voltage_v);
  out.current_a(in.current_a);
  out.state_of_charge(in.state_of_charge);
  return out;
}

protocol::Command to_wire(const plant::ActuatorCommand& in) {
  protocol::Command out;
  out.stamp_us = in.stamp_ns / 1000;
  out.term = in.term;
  out.rotors_running = in.rotor_state == plant::RotorState::kRunning ? 1 : 0;
  out.rotor_count = static_cast<std::uint8_t>(in.rotor_count);
  std::transform(in.throttle.begin(), in.throttle.end(), out.throttle_u16.begin(), [](double throttle) {
    return static_cast<std::uint16_t>(std::lround(throttle * kFullThrottle));
  });
  return out;
}

}  // namespace swiftlet::services

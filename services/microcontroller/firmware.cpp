#include "swiftlet/services/microcontroller/firmware.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "swiftlet/services/microcontroller/protocol/layout.hpp"

namespace swiftlet::services {
namespace {

constexpr std::int64_t kStatePeriodUs = 100'000;
constexpr std::int64_t kNsPerUs = 1000;

std::array<float, 3> to_wire(const Eigen::Vector3d& vector) {
  return {static_cast<float>(vector.x()), static_cast<float>(vector.y()), static_cast<float>(vector.z())};
}

plant::ActuatorCommand from_wire(const protocol::Command& in) {
  plant::ActuatorCommand out;
  out.stamp_ns = protocol::ns_of_us(in.stamp_us);
  out.term = in.term;
  out.rotor_state = in.rotors_running != 0 ? plant::RotorState::kRunning : plant::RotorState::kOff;
  out.rotor_count = in.rotor_count;
  for (std::size_t i = 0; i < in.throttle_u16.size(); ++i) out.throttle[i] = in.throttle_u16[i] / 65535.0;
  return out;
}

}  // namespace

Firmware::Firmware(const FirmwareSettings& settings, Send send)
    : settings_(settings),
      send_(std::move(send)),
      watchdog_(settings.rotor_count, std::llround(settings.command_timeout_s * 1e9)) {}

bool Firmware::take(const std::uint8_t* bytes, std::size_t size, std::int64_t now_us) {
  bool received = false;
  for (std::size_t i = 0; i < size; ++i) {
    if (!decoder_.take(bytes[i])) continue;
    received = true;
    if (const auto hello = protocol::message_of<protocol::Hello>(decoder_.frame())) on_hello(*hello, now_us);
    if (!in_session(now_us)) continue;
    heard_us_ = now_us;
    if (const auto request = protocol::message_of<protocol::TimeRequest>(decoder_.frame()))
      on_time_request(*request, now_us);
    if (const auto command = protocol::message_of<protocol::Command>(decoder_.frame()))
      on_command(*command, now_us);
  }
  return received;
}

bool Firmware::in_session(std::int64_t now_us) const {
  return has_session_ && now_us - heard_us_ <= protocol::kSilenceUs;
}

bool Firmware::has_obeyed(std::int64_t stamp_us) const {
  const plant::ObeyedCommand obeyed = watchdog_.obeyed();
  return obeyed.any && obeyed.stamp_ns >= stamp_us * kNsPerUs;
}

void Firmware::on_hello(const protocol::Hello& hello, std::int64_t now_us) {
  has_session_ = hello.version == settings_.version;
  heard_us_ = now_us;
  decoder_.expect_any_sequence();
  protocol::HelloReply reply;
  reply.version = settings_.version;
  protocol::set_text(reply.name, settings_.name.c_str());
  reply.boot = settings_.boot;
  reply.simulated = 1;
  reply.rotor_count = static_cast<std::uint8_t>(settings_.rotor_count);
  reply.imu_rate_hz = static_cast<std::uint16_t>(std::lround(settings_.imu_rate_hz));
  reply.command_timeout_ms = static_cast<std::uint16_t>(std::lround(settings_.command_timeout_s * 1e3));
  transmit(reply);
}

void Firmware::on_time_request(const protocol::TimeRequest& request, std::int64_t now_us) {
  transmit(protocol::TimeReply{request.sent_ns, now_us, now_us});
}

void Firmware::on_command(const protocol::Command& message, std::int64_t now_us) {
  const bool running = message.rotors_running != 0;
  motor_command(now_us);  // a command that comes too late does not undo the time-out
  if (timed_out_ && running) return refuse("the command time-out needs rotors off first");
  const plant::CommandFault fault = watchdog_.accept(from_wire(message), now_us * kNsPerUs);
  if (fault != plant::CommandFault::kNone) return refuse(plant::to_string(fault));
  timed_out_ = false;
  if (running) state_.fault.fill('\0');
  command_age_us_ = static_cast<std::uint32_t>(
      std::min<std::int64_t>(now_us - message.stamp_us, std::numeric_limits<std::uint32_t>::max()));
  ++state_.commands_obeyed;
}

void Firmware::refuse(const char* reason) {
  ++state_.commands_refused;
  protocol::set_text(state_.refusal, reason);
}

plant::MotorCommand Firmware::motor_command(std::int64_t now_us) {
  const bool expired = watchdog_.expired(now_us * kNsPerUs);
  if (expired && state_.rotors_running != 0) {
    timed_out_ = true;
    protocol::set_text(state_.fault, "no command within the time-out");
  }
  const plant::MotorCommand command =
      timed_out_ ? plant::MotorCommand{} : watchdog_.motor_command(now_us * kNsPerUs);
  state_.rotors_running = command.state == plant::RotorState::kRunning ? 1 : 0;
  return command;
}

void Firmware::send(const plant::ImuSample& sample, std::int64_t stamp_us) {
  if (!in_session(stamp_us)) return;
  protocol::Imu message;
  message.stamp_us = stamp_us;
  message.specific_force_frd = to_wire(sample.specific_force_frd);
  message.body_rates_frd = to_wire(sample.body_rates_frd);
  const plant::ObeyedCommand obeyed = watchdog_.obeyed();
  if (obeyed.any) {
    message.has_command = 1;
    message.command_term = obeyed.term;
    message.command_stamp_us = obeyed.stamp_ns / kNsPerUs;
    message.command_age_us = command_age_us_;
  }
  transmit(message);
}

void Firmware::send(const plant::RotorSpeedSample& sample, std::int64_t stamp_us) {
  if (!in_session(stamp_us)) return;
  protocol::RotorSpeeds message;
  message.stamp_us = stamp_us;
  message.rotor_count = static_cast<std::uint8_t>(sample.rotor_count);
  for (std::size_t i = 0; i < message.speeds.size(); ++i)
    message.speeds[i] = static_cast<float>(sample.speeds[i]);
  transmit(message);
}

void Firmware::send(const plant::BatterySample& sample, std::int64_t stamp_us) {
  if (!in_session(stamp_us)) return;
  protocol::Battery message;
  message.stamp_us = stamp_us;
  message.voltage_v = static_cast<float>(sample.voltage_v);
  message.current_a = static_cast<float>(sample.current_a);
  message.state_of_charge = static_cast<float>(sample.state_of_charge);
  transmit(message);
}

void Firmware::send_state_if_due(std::int64_t now_us) {
  const bool changed = rotors_reported_ != (state_.rotors_running != 0);
  if (!in_session(now_us) || (now_us < state_due_us_ && !changed)) return;
  rotors_reported_ = state_.rotors_running != 0;
  state_due_us_ = now_us + kStatePeriodUs;
  state_.stamp_us = now_us;
  state_.frames_received = decoder_.counts().received;
  state_.frames_refused = decoder_.counts().refused;
  state_.frames_lost = decoder_.counts().lost;
  transmit(state_);
}

template <class Message>
void Firmware::transmit(const Message& message) {
  const protocol::FrameEncoder::Bytes frame = encoder_.encode(message);
  send_(frame.data, frame.size);
}

}  // namespace swiftlet::services

// The messages between a vehicle process, the host, and its microcontroller: plain structs of fixed layout. On the wire each
// field follows the one before it without padding, in the order of visit(), integers and floats little-endian. The page
// docs/microcontroller-protocol.md has the same as a table, and a test compares them. No heap, no exceptions: firmware can
// use these headers as they are.
//
// Units are SI and radians, frames FRD, as in the topics. Stamps are the microcontroller's clock in us, which starts
// anywhere, rises, and is never set.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace swiftlet::protocol {

constexpr std::uint16_t kVersion = 1;
constexpr std::size_t kMaxRotors = 8;

// A stamp in ns. Any number may come over the wire: beyond 73 years, which no clock shows, it is limited, so that neither this
// nor a difference of two such stamps overflows.
constexpr std::int64_t ns_of_us(std::int64_t stamp_us) {
  constexpr std::int64_t kLimitUs = (std::int64_t{1} << 61) / 1000;
  if (stamp_us > kLimitUs) return kLimitUs * 1000;
  return (stamp_us < -kLimitUs ? -kLimitUs : stamp_us) * 1000;
}

// ---- host -> microcontroller: kinds below 0x80

// Begins a session. The microcontroller answers with HelloReply, whatever the version. It sends nothing else and obeys
// nothing without a session, that is until a Hello of its own version, and after kSilenceUs without a frame from the host.
// Hello and HelloReply are the same in all versions.
struct Hello {
  static constexpr std::uint8_t kKind = 0x01;
  std::uint16_t version = kVersion;

  template <class Self, class Visit>
  static constexpr void visit(Self& m, Visit&& field) {
    field("version", m.version);
  }
};

// At least 10 per second in a session, so that the microcontroller knows that the host lives.
struct TimeRequest {
  static constexpr std::uint8_t kKind = 0x02;
  std::int64_t sent_ns = 0;  // host's clock

  template <class Self, class Visit>
  static constexpr void visit(Self& m, Visit&& field) {
    field("sent_ns", m.sent_ns);
  }
};

struct Command {
  static constexpr std::uint8_t kKind = 0x03;
  std::int64_t stamp_us = 0;                             // of the answered Imu
  std::uint32_t term = 0;                                // of the controller
  std::uint8_t rotors_running = 0;                       // 0: off, which differs from throttle 0
  std::uint8_t rotor_count = 0;                          // valid entries of throttle
  std::array<std::uint16_t, kMaxRotors> throttle_u16{};  // 0: 0, 65535: 1

  template <class Self, class Visit>
  static constexpr void visit(Self& m, Visit&& field) {
    field("stamp_us", m.stamp_us);
    field("term", m.term);
    field("rotors_running", m.rotors_running);
    field("rotor_count", m.rotor_count);
    field("throttle_u16", m.throttle_u16);
  }
};

// ---- microcontroller -> host: kinds from 0x80

struct HelloReply {
  static constexpr std::uint8_t kKind = 0x81;
  std::uint16_t version = kVersion;
  std::array<char, 24> name{};  // of the firmware, filled up with zeros
  std::uint32_t boot = 0;       // another number after each start: its clock may have started again
  std::uint8_t simulated = 0;   // 1: no motor turns
  std::uint8_t rotor_count = 0;
  std::uint16_t imu_rate_hz = 0;
  std::uint16_t command_timeout_ms = 0;

  template <class Self, class Visit>
  static constexpr void visit(Self& m, Visit&& field) {
    field("version", m.version);
    field("name", m.name);
    field("boot", m.boot);
    field("simulated", m.simulated);
    field("rotor_count", m.rotor_count);
    field("imu_rate_hz", m.imu_rate_hz);
    field("command_timeout_ms", m.command_timeout_ms);
  }
};

struct TimeReply {
  static constexpr std::uint8_t kKind = 0x82;
  std::int64_t sent_ns = 0;  // of the request
  std::int64_t received_us = 0;
  std::int64_t answered_us = 0;

  template <class Self, class Visit>
  static constexpr void visit(Self& m, Visit&& field) {
    field("sent_ns", m.sent_ns);
    field("received_us", m.received_us);
    field("answered_us", m.answered_us);
  }
};

struct Imu {
  static constexpr std::uint8_t kKind = 0x83;
  std::int64_t stamp_us = 0;
  std::array<float, 3> specific_force_frd{};  // m/s^2; (0, 0, -g) at rest and level
  std::array<float, 3> body_rates_frd{};      // rad/s
  // The last obeyed command.
  std::uint8_t has_command = 0;    // 0: none since the start, the next three are 0
  std::uint32_t command_term = 0;  // as in the command, as the next one
  std::int64_t command_stamp_us = 0;
  std::uint32_t command_age_us = 0;  // from that stamp until it was obeyed

  template <class Self, class Visit>
  static constexpr void visit(Self& m, Visit&& field) {
    field("stamp_us", m.stamp_us);
    field("specific_force_frd", m.specific_force_frd);
    field("body_rates_frd", m.body_rates_frd);
    field("has_command", m.has_command);
    field("command_term", m.command_term);
    field("command_stamp_us", m.command_stamp_us);
    field("command_age_us", m.command_age_us);
  }
};

struct RotorSpeeds {
  static constexpr std::uint8_t kKind = 0x84;
  std::int64_t stamp_us = 0;
  std::uint8_t rotor_count = 0;            // valid entries of speeds
  std::array<float, kMaxRotors> speeds{};  // rad/s

  template <class Self, class Visit>
  static constexpr void visit(Self& m, Visit&& field) {
    field("stamp_us", m.stamp_us);
    field("rotor_count", m.rotor_count);
    field("speeds", m.speeds);
  }
};

struct Battery {
  static constexpr std::uint8_t kKind = 0x85;
  std::int64_t stamp_us = 0;
  float voltage_v = 0.0F;  // at the terminals
  float current_a = 0.0F;
  float state_of_charge = 0.0F;  // 0 empty .. 1 full

  template <class Self, class Visit>
  static constexpr void visit(Self& m, Visit&& field) {
    field("stamp_us", m.stamp_us);
    field("voltage_v", m.voltage_v);
    field("current_a", m.current_a);
    field("state_of_charge", m.state_of_charge);
  }
};

struct State {
  static constexpr std::uint8_t kKind = 0x86;
  std::int64_t stamp_us = 0;
  std::uint8_t rotors_running = 0;
  std::uint32_t frames_received = 0;  // since the start, as all below
  std::uint32_t frames_refused = 0;   // broken on the way
  std::uint32_t frames_lost = 0;      // missing sequence numbers
  std::uint32_t commands_obeyed = 0;
  std::uint32_t commands_refused = 0;
  std::array<char, 48> fault{};    // why it stopped the rotors by itself; empty: it did not
  std::array<char, 48> refusal{};  // why it refused the last refused command

  template <class Self, class Visit>
  static constexpr void visit(Self& m, Visit&& field) {
    field("stamp_us", m.stamp_us);
    field("rotors_running", m.rotors_running);
    field("frames_received", m.frames_received);
    field("frames_refused", m.frames_refused);
    field("frames_lost", m.frames_lost);
    field("commands_obeyed", m.commands_obeyed);
    field("commands_refused", m.commands_refused);
    field("fault", m.fault);
    field("refusal", m.refusal);
  }
};

constexpr std::int64_t kSilenceUs = 1'000'000;  // without a frame from the host: the session has ended

}  // namespace swiftlet::protocol

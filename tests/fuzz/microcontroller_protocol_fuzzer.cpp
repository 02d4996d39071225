// Fuzzes both ends of the link to a microcontroller. With an even first byte the rest are bytes on the line; with an odd one,
// contents of frames, each with its length before it, which get the right CRC.
#include <algorithm>
#include <cmath>
#include <vector>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/microcontroller/firmware.hpp"
#include "swiftlet/services/microcontroller/protocol/frame.hpp"
#include "swiftlet/services/microcontroller/protocol/messages.hpp"
#include "swiftlet/services/vehicle_template/wire.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

namespace {

using Bytes = std::vector<std::uint8_t>;

void append_frame(const std::uint8_t* content, std::size_t size, Bytes& wire) {
  Bytes bytes(content, content + size);
  const std::uint32_t crc = protocol::crc32(bytes.data(), bytes.size());
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(crc >> shift));
  Bytes coded(protocol::longest_cobs(bytes.size()));
  coded.resize(protocol::cobs_encode(bytes.data(), bytes.size(), coded.data()));
  wire.push_back(0);
  wire.insert(wire.end(), coded.begin(), coded.end());
  wire.push_back(0);
}

Bytes wire_of(const std::uint8_t* data, std::size_t size) {
  Bytes wire;
  if (*data % 2 == 0) return {data + 1, data + size};
  for (std::size_t at = 1; at < size;) {
    const std::size_t length = std::min<std::size_t>(data[at], size - at - 1);
    append_frame(data + at + 1, length, wire);
    at += 1 + length;
  }
  return wire;
}

template <class Message>
void check(const protocol::Frame& frame) {
  const auto message = protocol::message_of<Message>(frame);
  if (!message) return;
  Bytes fields(frame.size);
  protocol::write_fields(*message, fields.data());
  // A signalling NaN may become a quiet one where a float is copied.
  const bool same = std::equal(fields.begin(), fields.end(), frame.fields);
  const bool has_floats = frame.kind == protocol::Imu::kKind || frame.kind == protocol::RotorSpeeds::kKind ||
                          frame.kind == protocol::Battery::kKind;
  tests::demand(same || has_floats, "a message has all bytes of its frame");
}

// The host: what it reads becomes a message that control accepts or refuses.
void read_as_host(const Bytes& wire) {
  protocol::FrameDecoder decoder;
  for (const std::uint8_t byte : wire) {
    if (!decoder.take(byte)) continue;
    const protocol::Frame& frame = decoder.frame();
    check<protocol::Hello>(frame);
    check<protocol::TimeRequest>(frame);
    check<protocol::Command>(frame);
    check<protocol::HelloReply>(frame);
    check<protocol::TimeReply>(frame);
    check<protocol::Imu>(frame);
    check<protocol::RotorSpeeds>(frame);
    check<protocol::Battery>(frame);
    check<protocol::State>(frame);
    plant::ImuSample imu;
    plant::RotorSpeedSample speeds;
    plant::BatterySample battery;
    if (const auto message = protocol::message_of<protocol::Imu>(frame))
      messages::from_message(services::to_message(*message), imu);
    if (const auto message = protocol::message_of<protocol::RotorSpeeds>(frame))
      messages::from_message(services::to_message(*message), speeds);
    if (const auto message = protocol::message_of<protocol::Battery>(frame))
      messages::from_message(services::to_message(*message), battery);
  }
}

// The microcontroller: without Hello it neither answers nor turns a motor, and it never leaves 0 .. 1.
void read_as_firmware(const Bytes& wire) {
  constexpr std::int64_t kStepUs = 100;
  std::int64_t now_us = 1'000'000;
  std::size_t answers = 0;
  services::Firmware firmware({}, [&](const std::uint8_t*, std::size_t size) {
    tests::demand(size <= protocol::kMaxFrame, "no frame is longer than kMaxFrame");
    ++answers;
  });
  for (const std::uint8_t byte : wire) {
    firmware.take(&byte, 1, now_us);
    const plant::MotorCommand command = firmware.motor_command(now_us);
    const bool running = command.state == plant::RotorState::kRunning;
    tests::demand(!running || answers > 0, "no motor turns before a session");
    for (const double throttle : command.throttle)
      tests::demand(throttle >= 0.0 && throttle <= 1.0, "throttles are from 0 to 1");
    now_us += kStepUs;
  }
  tests::demand(firmware.motor_command(now_us + 100'001).state == plant::RotorState::kOff,
                "the rotors stop when the bytes do");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Bytes wire = wire_of(data, size);
  read_as_host(wire);
  read_as_firmware(wire);
  return 0;
}

#include "swiftlet/io/mavlink/frame.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/mavlink/crc.hpp"
#include "swiftlet/io/mavlink/frame_parser.hpp"
#include "swiftlet/io/mavlink/messages.hpp"
#include "swiftlet/io/mavlink/payload.hpp"
#include "swiftlet/math/random.hpp"

namespace swiftlet::mavlink::frame_test {

using Bytes = std::vector<std::uint8_t>;

constexpr Address kSimulator{1, 200};

Bytes bytes_of(const std::string& hex) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

template <class Message>
Bytes sent(const Message& message, std::uint8_t sequence) {
  const FrameBytes bytes = encode(to_frame(message, kSimulator, sequence), Message::kCrcExtra);
  return {bytes.data.begin(), bytes.data.begin() + static_cast<std::ptrdiff_t>(bytes.size)};
}

std::vector<Frame> parsed(FrameParser& parser, const Bytes& bytes) {
  std::vector<Frame> frames;
  parser.feed(bytes.data(), bytes.size(), [&](const Frame& frame) { frames.push_back(frame); });
  return frames;
}
std::vector<Frame> parsed(const Bytes& bytes) {
  FrameParser parser;
  return parsed(parser, bytes);
}

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

HilActuatorControls some_controls() {
  HilActuatorControls controls;
  controls.time_usec = 1'004'000;
  controls.flags = HilActuatorControls::kLockstep;
  controls.controls = {0.5F, 0.625F, 0.25F, 0.75F};
  controls.mode = 129;
  return controls;
}

// The published check value of CRC-16/MCRF4XX.
TEST(MavlinkCrc, MatchesThePublishedCheckValue) {
  const std::string text = "123456789";
  Crc crc;
  crc.add(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  EXPECT_EQ(crc.value(), 0x6f91);
}

// The frames below are those of the generator of the MAVLink project for the same values.
TEST(MavlinkFrame, HeartbeatAndTimeMatchTheReference) {
  EXPECT_EQ(sent(Heartbeat{}, 7), bytes_of("fd0900000701c80000000000000000080004038b7e"));
  EXPECT_EQ(sent(SystemTime{1'767'225'600'000'000, 4000}, 8),
            bytes_of("fd0a00000801c80200000040204648470600a00fab10"));
}

TEST(MavlinkFrame, SensorMatchesTheReference) {
  HilSensor sensor;
  sensor.time_usec = 1'004'000;
  sensor.acceleration = {0.125F, -0.25F, -9.8125F};
  sensor.gyro = {0.01F, -0.02F, 0.03F};
  sensor.mag = {0.21F, 0.01F, 0.43F};
  sensor.abs_pressure = 955.5F;
  sensor.pressure_alt = 488.25F;
  sensor.temperature = 11.75F;
  sensor.fields_updated = 0x1fff;
  EXPECT_EQ(
      sent(sensor, 9),
      bytes_of(
          "fd3e00000901c86b0000e0510f00000000000000003e000080be00001dc10ad7233c0ad7a3bc8fc2f53c3d0a573e0a"
          "d7233cf628dc3e00e06e44000000000020f44300003c41ff1f7c4d"));
}

TEST(MavlinkFrame, GpsMatchesTheReference) {
  HilGps gps;
  gps.time_usec = 1'767'225'601'004'000;
  gps.fix_type = HilGps::kFix3d;
  gps.lat = 473'977'418;
  gps.lon = 85'455'938;
  gps.alt = 488'250;
  gps.eph = 30;
  gps.epv = 40;
  gps.vel = 125;
  gps.vn = 100;
  gps.ve = -75;
  gps.vd = -12;
  gps.cog = 32'313;
  gps.satellites_visible = 10;
  EXPECT_EQ(sent(gps, 10), bytes_of("fd2400000a01c8710000e0912f46484706004a52401c42f417053a7307001e0028007d00"
                                    "6400b5fff4ff397e030ab048"));
}

TEST(MavlinkFrame, StateMatchesTheReference) {
  HilStateQuaternion state;
  state.time_usec = 1'004'000;
  state.attitude_quaternion = {1.0F, 0.0F, -0.5F, 0.25F};
  state.body_rates = {0.1F, -0.2F, 0.3F};
  state.lat = 473'977'418;
  state.lon = -85'455'938;
  state.alt = 488'250;
  state.velocity = {100, -75, -12};
  state.true_airspeed = 125;
  state.acceleration = {-3, 4, -1000};
  EXPECT_EQ(
      sent(state, 11),
      bytes_of(
          "fd4000000b01c8730000e0510f00000000000000803f00000000000000bf0000803ecdcccc3dcdcc4cbe9a99993e4a52"
          "401cbe0be8fa3a7307006400b5fff4ff00007d00fdff040018fcd8d3"));
}

TEST(MavlinkFrame, ControlsAndCommandMatchTheReference) {
  const std::string zeros(96, '0');
  EXPECT_EQ(sent(some_controls(), 12),
            bytes_of("fd5100000c01c85d0000e0510f000000000001000000000000000000003f0000203f0000803e0000403f" +
                     zeros + "816b38"));
  CommandLong command;
  command.command = CommandLong::kSetMessageInterval;
  command.params = {115.0F, 5000.0F};
  EXPECT_EQ(sent(command, 13),
            bytes_of("fd1e00000d01c84c00000000e64200409c450000000000000000000000000000000000000000ff01d123"));
}

TEST(MavlinkFrame, KeepsOneByteOfAPayloadOfZeros) {
  EXPECT_EQ(sent(SystemTime{}, 14), bytes_of("fd0100000e01c8020000000823"));
}

TEST(MavlinkParser, ReadsBothVersionsAndSignedFrames) {
  const std::string zeros(96, '0');
  const Bytes first = bytes_of(
      "fe510c01c85de0510f000000000001000000000000000000003f0000203f0000803e0000403f" + zeros + "81588c");
  const Bytes is_signed = bytes_of("fd0901001001c800000000000000020c000403e1b0000500000000008808fb1f56eb");
  const std::vector<Frame> frames = parsed(first + sent(some_controls(), 13) + is_signed);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].version, 1);
  EXPECT_EQ(frames[0].sequence, 12);
  EXPECT_EQ(frames[0].system_id, 1);
  EXPECT_EQ(frames[0].component_id, 200);
  EXPECT_EQ(frames[1].version, 2);
  for (const std::size_t i : {0U, 1U}) {
    const auto controls = from_frame<HilActuatorControls>(frames[i]);
    EXPECT_EQ(controls.time_usec, 1'004'000U);
    EXPECT_EQ(controls.flags, HilActuatorControls::kLockstep);
    EXPECT_EQ(controls.controls, some_controls().controls);
    EXPECT_EQ(controls.mode, 129);
  }
  EXPECT_EQ(from_frame<Heartbeat>(frames[2]).autopilot, 12);
}

TEST(MavlinkParser, SkipsFramesOfOtherMessages) {
  FrameParser parser;
  const Bytes attitude = bytes_of("fd0100000f01c81e0000016b34");
  EXPECT_EQ(parsed(parser, attitude + sent(Heartbeat{}, 1)).size(), 1U);
  EXPECT_EQ(parser.counts().unknown, 1U);
  EXPECT_EQ(parser.counts().skipped, 0U);
}

TEST(MavlinkParser, RefusesEveryFrameWithOneWrongBit) {
  const Bytes sound = sent(some_controls(), 1);
  for (std::size_t byte = 1; byte < sound.size(); ++byte) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      Bytes wrong = sound;
      wrong[byte] = static_cast<std::uint8_t>(wrong[byte] ^ (1U << bit));
      EXPECT_TRUE(parsed(wrong).empty()) << byte << "." << bit;
    }
  }
}

TEST(MavlinkParser, RefusesUnknownFeaturesOfTheFrame) {
  Bytes frame = sent(Heartbeat{}, 1);
  frame[2] = 0x02;
  FrameParser parser;
  EXPECT_TRUE(parsed(parser, frame).empty());
  EXPECT_GT(parser.counts().skipped, 0U);
}

TEST(MavlinkParser, FindsAFrameThatBeginsWithinAWrongOne) {
  // A start byte and the id of a known message within noise, which claims that the next frame belongs to it.
  const Bytes noise = bytes_of("00fdc8000001010000000000");
  FrameParser parser;
  const std::vector<Frame> frames =
      parsed(parser, noise + sent(some_controls(), 1) + sent(some_controls(), 2) + sent(some_controls(), 3));
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].sequence, 1);
  EXPECT_EQ(parser.counts().wrong_checksum, 1U);
  EXPECT_EQ(parser.counts().skipped, noise.size());
}

TEST(MavlinkParser, ResultsDoNotDependOnHowTheBytesAreSplit) {
  math::RandomStream random(7, 1);
  Bytes stream;
  for (std::uint8_t i = 0; i < 50; ++i) {
    for (std::uint64_t noise = random.next() % 20; noise > 0; --noise)
      stream.push_back(static_cast<std::uint8_t>(random.next()));
    stream = stream + (i % 2 == 0 ? sent(some_controls(), i) : sent(HilSensor{}, i));
  }
  const std::vector<Frame> whole = parsed(stream);
  EXPECT_GE(whole.size(),
            45U);  // noise may hold a start byte with the length of a long frame of another message
  FrameParser parser;
  std::vector<Frame> split;
  for (std::size_t at = 0; at < stream.size();) {
    const std::size_t size = std::min<std::size_t>(1 + random.next() % 40, stream.size() - at);
    parser.feed(stream.data() + at, size, [&](const Frame& frame) { split.push_back(frame); });
    at += size;
  }
  ASSERT_EQ(split.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(split[i].sequence, whole[i].sequence);
    EXPECT_EQ(split[i].payload, whole[i].payload);
  }
}

}  // namespace swiftlet::mavlink::frame_test

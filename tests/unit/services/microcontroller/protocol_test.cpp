// The protocol between a vehicle process and its microcontroller: whatever happens to the bytes on the way, the far end receives a
// message as it was sent, or not at all.
#include <algorithm>
#include <fstream>
#include <iomanip>
#include <optional>
#include <random>
#include <regex>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/services/microcontroller/protocol/frame.hpp"
#include "swiftlet/services/microcontroller/protocol/messages.hpp"
#include "tests/support/malloc_guard.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::protocol::protocol_test {

using Bytes = std::vector<std::uint8_t>;

Bytes encoded(const Bytes& bytes) {
  Bytes out(longest_cobs(bytes.size()), 0xee);
  out.resize(cobs_encode(bytes.data(), bytes.size(), out.data()));
  return out;
}

std::optional<Bytes> decoded(const Bytes& bytes) {
  Bytes out(bytes.size() + 1, 0xee);
  const Decoded result = cobs_decode(bytes.data(), bytes.size(), out.data());
  EXPECT_EQ(out.back(), 0xee) << "never more bytes than it was given";
  if (!result.valid) return std::nullopt;
  out.resize(result.size);
  return out;
}

Bytes counting(std::size_t size) {
  Bytes out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(1 + i % 255);
  return out;
}

TEST(Cobs, EncodesTheExamplesOfItsPaper) {
  EXPECT_EQ(encoded({}), (Bytes{0x01}));
  EXPECT_EQ(encoded({0x00}), (Bytes{0x01, 0x01}));
  EXPECT_EQ(encoded({0x00, 0x00}), (Bytes{0x01, 0x01, 0x01}));
  EXPECT_EQ(encoded({0x11, 0x22, 0x00, 0x33}), (Bytes{0x03, 0x11, 0x22, 0x02, 0x33}));
  EXPECT_EQ(encoded({0x11, 0x00, 0x00, 0x00}), (Bytes{0x02, 0x11, 0x01, 0x01, 0x01}));
  EXPECT_EQ(encoded(counting(254)).front(), 0xff);
  EXPECT_EQ(encoded(counting(255)).size(), 257U);
}

TEST(Cobs, ReturnsAllBytesAndSendsNoZero) {
  std::mt19937 random(1);
  for (int run = 0; run < 4000; ++run) {
    Bytes bytes(random() % 800);
    const unsigned zero_in = 1 + random() % 400;  // from zeros everywhere to almost none
    for (std::uint8_t& byte : bytes)
      byte = static_cast<std::uint8_t>(random() % zero_in == 0 ? 0 : 1 + random() % 255);
    const Bytes wire = encoded(bytes);
    ASSERT_LE(wire.size(), longest_cobs(bytes.size()));
    ASSERT_EQ(std::count(wire.begin(), wire.end(), 0), 0);
    ASSERT_EQ(decoded(wire), bytes);
    Bytes in_place = wire;
    ASSERT_EQ(cobs_decode(in_place.data(), in_place.size(), in_place.data()).size, bytes.size());
    in_place.resize(bytes.size());
    ASSERT_EQ(in_place, bytes);
  }
}

TEST(Cobs, RefusesBytesThatNoEncoderWrites) {
  EXPECT_FALSE(decoded({0x00}));
  EXPECT_FALSE(decoded({0x03, 0x11})) << "ends within a block";
  EXPECT_FALSE(decoded({0x03, 0x11, 0x00})) << "a zero within a block";
  EXPECT_FALSE(decoded({0xff, 0x11}));
}

// Its check value in catalogues of CRCs.
TEST(Crc32, IsThatOfIeee802) {
  const std::string check = "123456789";
  EXPECT_EQ(crc32(reinterpret_cast<const std::uint8_t*>(check.data()), check.size()), 0xcbf43926U);
}

// ---- messages

struct Randomise {
  std::mt19937& random;
  template <class T>
  void operator()(const char*, T& value) {
    set(value);
  }
  template <class T, std::size_t N>
  void set(std::array<T, N>& values) {
    for (T& value : values) set(value);
  }
  void set(float& value) { value = std::uniform_real_distribution<float>(-1e6F, 1e6F)(random); }
  template <class T, class = std::enable_if_t<std::is_integral_v<T>>>
  void set(T& value) {
    const std::uint64_t bits = (std::uint64_t{random()} << 32) | random();
    value = static_cast<T>(random() % 3 == 0 ? 0 : bits);
  }
};

template <class Message>
Message random_message(std::mt19937& random) {
  Message message;
  Message::visit(message, Randomise{random});
  return message;
}

template <class Message>
Bytes fields_of(const Message& message) {
  Bytes out(wire_size<Message>());
  write_fields(message, out.data());
  return out;
}

template <class Message>
Bytes frame_of(FrameEncoder& encoder, const Message& message) {
  const FrameEncoder::Bytes frame = encoder.encode(message);
  return {frame.data, frame.data + frame.size};
}

// The messages of one kind that a decoder finds; other kinds are a failure.
template <class Message>
std::vector<Bytes> received(FrameDecoder& decoder, const Bytes& wire) {
  std::vector<Bytes> out;
  for (const std::uint8_t byte : wire) {
    if (!decoder.take(byte)) continue;
    const auto message = message_of<Message>(decoder.frame());
    EXPECT_TRUE(message) << "of kind " << int{decoder.frame().kind};
    if (message) out.push_back(fields_of(*message));
  }
  return out;
}

template <class Message>
class EachMessage : public testing::Test {};
using Messages =
    testing::Types<Hello, TimeRequest, Command, HelloReply, TimeReply, Imu, RotorSpeeds, Battery, State>;
TYPED_TEST_SUITE(EachMessage, Messages);

TYPED_TEST(EachMessage, ArrivesAsItWasSent) {
  std::mt19937 random(2);
  FrameEncoder encoder;
  FrameDecoder decoder;
  for (std::uint32_t run = 1; run <= 300; ++run) {
    const auto sent = random_message<TypeParam>(random);
    const auto got = received<TypeParam>(decoder, frame_of(encoder, sent));
    ASSERT_EQ(got, std::vector<Bytes>{fields_of(sent)});
    ASSERT_EQ(decoder.counts().received, run);
  }
  EXPECT_EQ(decoder.counts().refused, 0U);
  EXPECT_EQ(decoder.counts().lost, 0U);
}

TYPED_TEST(EachMessage, WithAWrongByteIsRefusedAndTakesNoOtherWithIt) {
  std::mt19937 random(3);
  const auto sent = random_message<TypeParam>(random);
  FrameEncoder encoder;
  const Bytes first = frame_of(encoder, sent);
  const Bytes second = frame_of(encoder, sent);
  for (std::size_t at = 0; at < first.size(); ++at) {
    for (int flip = 1; flip < 256; ++flip) {
      Bytes wire = first;
      wire[at] = static_cast<std::uint8_t>(wire[at] ^ flip);
      wire.insert(wire.end(), second.begin(), second.end());
      FrameDecoder decoder;
      ASSERT_EQ(received<TypeParam>(decoder, wire), std::vector<Bytes>{fields_of(sent)})
          << "byte " << at << " changed by " << flip;
    }
  }
}

TYPED_TEST(EachMessage, WithALostByteIsRefusedAndTakesNoOtherWithIt) {
  std::mt19937 random(4);
  const auto sent = random_message<TypeParam>(random);
  FrameEncoder encoder;
  const Bytes first = frame_of(encoder, sent);
  const Bytes second = frame_of(encoder, sent);
  for (std::size_t at = 0; at < first.size(); ++at) {
    Bytes wire = first;
    wire.erase(wire.begin() + static_cast<std::ptrdiff_t>(at));
    wire.insert(wire.end(), second.begin(), second.end());
    FrameDecoder decoder;
    const bool was_delimiter = at == 0 || at == first.size() - 1;
    ASSERT_EQ(received<TypeParam>(decoder, wire).size(), was_delimiter ? 2U : 1U) << "byte " << at;
    ASSERT_EQ(decoder.counts().refused, was_delimiter ? 0U : 1U);
  }
}

TEST(FrameDecoder, FindsEveryFrameBehindNoiseOfAnyLength) {
  std::mt19937 random(5);
  for (int run = 0; run < 500; ++run) {
    Bytes wire(random() % 1000);
    for (std::uint8_t& byte : wire) byte = static_cast<std::uint8_t>(random());
    FrameEncoder encoder;
    const auto sent = random_message<Imu>(random);
    const Bytes frame = frame_of(encoder, sent);
    wire.insert(wire.end(), frame.begin(), frame.end());
    FrameDecoder decoder;
    ASSERT_EQ(received<Imu>(decoder, wire), std::vector<Bytes>{fields_of(sent)});
  }
}

TEST(FrameDecoder, CountsLostFramesButNeitherCopiesNorLateOnes) {
  FrameEncoder encoder;
  std::vector<Bytes> frames;
  for (int i = 0; i < 10; ++i) frames.push_back(frame_of(encoder, TimeRequest{i}));
  FrameDecoder decoder;
  for (const std::size_t i : {0U, 1U, 4U, 3U, 4U, 4U, 5U, 9U}) received<TimeRequest>(decoder, frames[i]);
  EXPECT_EQ(decoder.counts().received, 8U);
  EXPECT_EQ(decoder.counts().lost, 2U + 3U);

  FrameEncoder restarted;
  decoder.expect_any_sequence();
  received<TimeRequest>(decoder, frame_of(restarted, TimeRequest{}));
  EXPECT_EQ(decoder.counts().lost, 5U);
}

TEST(FrameDecoder, CountsOnOverTheEndOfTheSequence) {
  FrameEncoder encoder;
  FrameDecoder decoder;
  for (int i = 0; i < 70'000; ++i) received<Hello>(decoder, frame_of(encoder, Hello{}));
  EXPECT_EQ(decoder.counts().received, 70'000U);
  EXPECT_EQ(decoder.counts().lost, 0U);
}

TEST(FrameDecoder, TakesNoMessageOfAnotherLength) {
  Frame frame;
  frame.kind = Command::kKind;
  const Bytes fields(200);
  frame.fields = fields.data();
  for (frame.size = 0; frame.size < fields.size(); ++frame.size)
    EXPECT_EQ(message_of<Command>(frame).has_value(), frame.size == wire_size<Command>());
}

TEST(Frames, AreEncodedAndDecodedWithoutHeap) {
  FrameEncoder encoder;
  FrameDecoder decoder;
  std::uint32_t messages = 0;
  const test::MallocGuard guard;
  for (int i = 0; i < 100; ++i) {
    const FrameEncoder::Bytes frame = encoder.encode(State{});
    for (std::size_t k = 0; k < frame.size; ++k) {
      if (decoder.take(frame.data[k]) && message_of<State>(decoder.frame())) ++messages;
    }
  }
  EXPECT_EQ(guard.calls(), 0U);
  EXPECT_EQ(messages, 100U);
}

TEST(Text, FillsItsFieldAtMostAndEndsAtTheFirstZero) {
  std::array<char, 4> field{};
  EXPECT_EQ(text_of(field), "");
  set_text(field, "ab");
  EXPECT_EQ(text_of(field), "ab");
  set_text(field, "abcdef");
  EXPECT_EQ(text_of(field), "abcd");
}

// ---- the page that firmware is written from

template <class T>
std::string type_name() {
  if (std::is_same_v<T, float>) return "f32";
  if (std::is_same_v<T, char>) return "char";
  return (std::is_signed_v<T> ? "i" : "u") + std::to_string(8 * sizeof(T));
}

// Rows of the table: offset in the fields, type, name.
struct Rows {
  std::vector<std::string>& rows;
  std::size_t offset = 0;
  template <class T>
  void operator()(const char* name, const T&) {
    add(name, type_name<T>(), sizeof(T));
  }
  template <class T, std::size_t N>
  void operator()(const char* name, const std::array<T, N>&) {
    add(name, type_name<T>() + "[" + std::to_string(N) + "]", N * sizeof(T));
  }
  void add(const char* name, const std::string& type, std::size_t size) {
    rows.push_back(std::to_string(offset) + " " + type + " " + name);
    offset += size;
  }
};

TYPED_TEST(EachMessage, HasItsTableInTheManual) {
  std::ostringstream kind;
  kind << "0x" << std::hex << std::setw(2) << std::setfill('0') << int{TypeParam::kKind};
  const std::string heading = "`" + kind.str() + "`, " + std::to_string(wire_size<TypeParam>()) + " bytes";

  std::ifstream page(tests::in_source("docs/microcontroller-protocol.md"));
  std::vector<std::string> documented;
  bool in_table = false;
  const std::regex row("\\| ([0-9]+) \\| `([^`]+)` \\| `([^`]+)` \\|.*");
  std::smatch cells;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("### ", 0) == 0) in_table = line.find(heading) != std::string::npos;
    if (in_table && std::regex_match(line, cells, row))
      documented.push_back(cells[1].str() + " " + cells[2].str() + " " + cells[3].str());
  }
  std::vector<std::string> coded;
  const TypeParam message{};
  TypeParam::visit(message, Rows{coded});
  EXPECT_EQ(documented, coded) << "under the heading with " << heading;
}

// The bytes of a command, one by one, as the manual shows them.
TEST(Command, HasTheBytesThatTheManualShows) {
  Command command;
  command.stamp_us = 0x0102030405;
  command.term = 7;
  command.rotors_running = 1;
  command.rotor_count = 4;
  command.throttle_u16 = {0, 0x8000, 0xffff, 1};
  FrameEncoder encoder;
  std::ostringstream bytes;
  bytes << std::hex << std::setfill('0');
  for (const std::uint8_t byte : frame_of(encoder, command)) bytes << std::setw(2) << int{byte} << ' ';
  std::string shown = bytes.str();
  shown.pop_back();
  std::ifstream page(tests::in_source("docs/microcontroller-protocol.md"));
  std::stringstream text;
  text << page.rdbuf();
  EXPECT_NE(std::regex_replace(text.str(), std::regex("\n"), " ").find(shown), std::string::npos) << shown;
}

}  // namespace swiftlet::protocol::protocol_test

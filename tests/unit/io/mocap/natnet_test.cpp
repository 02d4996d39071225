#include "swiftlet/io/mocap/natnet.hpp"

#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/mocap/capture_file.hpp"
#include "swiftlet/io/text_file.hpp"
#include "tests/support/mocap/natnet_packets.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::mocap::natnet::natnet_test {

namespace packets = tests::natnet;

const std::string kData = tests::in_source("tests/data/");
const std::vector<Version> kVersions = {{3, 0}, {3, 1}, {4, 0}, {4, 1}, {4, 2}};

std::vector<CapturedDatagram> traffic() {
  const std::string path = kData + "natnet_3.0_traffic.pcapng";
  return parse_capture(io::read_text_file(path), path);
}

// The first message of this kind in the capture.
CapturedDatagram captured(MessageId id) {
  for (const CapturedDatagram& datagram : traffic()) {
    const auto message = parse_message(datagram.payload.data(), datagram.payload.size());
    if (message && message->id == id) return datagram;
  }
  ADD_FAILURE() << "not captured";
  return {};
}

io::ByteReader payload_of(const std::vector<std::uint8_t>& datagram) {
  const auto message = parse_message(datagram.data(), datagram.size());
  EXPECT_TRUE(message);
  return message ? message->payload : io::ByteReader(nullptr, 0, true);
}

packets::Frame two_bodies() {
  packets::Frame frame;
  frame.number = 4711;
  frame.exposed_ticks = 1000;
  frame.received_ticks = 2000;
  frame.sent_ticks = 3000;
  frame.models_changed = true;
  frame.bodies = {{"kl1", 1, {1.0F, 2.0F, 3.0F}, {0.6F, 0.0F, 0.0F, 0.8F}, true, 4, 1},
                  {"kl2", 22, {-1.0F, 0.5F, 0.25F}, {0, 0, 0, 1}, false, 3, 3}};
  return frame;
}

// GIVEN the traffic of Motive 2.1 THEN what is read is what the vendor's sample client printed of the same session.
TEST(NatNetCapture, IsReadAsTheVendorsClientReadsIt) {
  const CapturedDatagram description = captured(MessageId::kServerInfo);
  ServerInfo server;
  ASSERT_EQ(parse_server_info(payload_of(description.payload), server), nullptr);
  EXPECT_EQ(server.application, "Motive");
  EXPECT_EQ(server.application_version, (Version{2, 1}));
  EXPECT_EQ(server.version, (Version{3, 0}));
  EXPECT_EQ(server.data_port, 1511);
  EXPECT_TRUE(server.multicast);
  EXPECT_EQ(server.group, kMulticastGroup);

  const io::Table printed =
      io::load_csv(kData + "natnet_3.0_sample_client.csv",
                   {"frame", "timestamp_s", "software_latency_ms", "system_latency_ms", "id", "valid", "x",
                    "y", "z", "qx", "qy", "qz", "qw", "markers", "occluded"});
  std::map<int, std::size_t> row_of;
  for (std::size_t row = 0; row < printed.row_count(); ++row)
    row_of[static_cast<int>(printed.number(row, 0))] = row;

  std::size_t compared = 0;
  std::size_t frames = 0;
  for (const CapturedDatagram& datagram : traffic()) {
    const auto message = parse_message(datagram.payload.data(), datagram.payload.size());
    if (!message || message->id != MessageId::kFrame) continue;
    ++frames;
    Frame frame;
    ASSERT_EQ(parse_frame(message->payload, server.version, frame), nullptr) << "frame " << frames;
    const auto found = row_of.find(frame.number);
    if (found == row_of.end()) continue;
    ++compared;
    const std::size_t row = found->second;
    const auto value = [&](std::size_t column) { return printed.number(row, column); };
    const auto hz = static_cast<double>(server.clock_hz);
    constexpr double kPrinted = 0.00501;  // two decimals
    EXPECT_NEAR(frame.timestamp_s, value(1), kPrinted);
    EXPECT_NEAR(1e3 * static_cast<double>(frame.sent_ticks - frame.received_ticks) / hz, value(2), kPrinted);
    EXPECT_NEAR(1e3 * static_cast<double>(frame.sent_ticks - frame.exposed_ticks) / hz, value(3), kPrinted);
    ASSERT_EQ(frame.bodies.size(), 1U);
    const RigidBody& body = frame.bodies[0];
    EXPECT_EQ(body.id, static_cast<int>(value(4)));
    EXPECT_EQ(body.tracked, value(5) == 1.0);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(body.position[i], value(6 + static_cast<std::size_t>(i)), kPrinted);
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(body.q_room_from_body.coeffs()[i], value(9 + static_cast<std::size_t>(i)), kPrinted);
    EXPECT_EQ(body.markers, static_cast<int>(value(13)));
    EXPECT_EQ(body.lost_markers, static_cast<int>(value(14)));
  }
  EXPECT_EQ(frames, 518U);
  EXPECT_EQ(compared, 251U);
}

TEST(NatNetCapture, HasTheDefinitionsAndAnswersOfTheServer) {
  std::vector<BodyDefinition> bodies;
  ASSERT_EQ(parse_models(payload_of(captured(MessageId::kModels).payload), {3, 0}, bodies), nullptr);
  ASSERT_EQ(bodies.size(), 1U);
  EXPECT_EQ(bodies[0].id, 2);
  EXPECT_FALSE(bodies[0].name.empty());

  EchoResponse response;
  ASSERT_EQ(parse_echo_response(payload_of(captured(MessageId::kEchoResponse).payload), response), nullptr);
  const std::vector<std::uint8_t> request = captured(MessageId::kEchoRequest).payload;
  EXPECT_EQ(echo_request(response.request), request);
}

// Ours are those of the vendor's client, but for its name and what servers of 4.x read behind the versions.
TEST(NatNetCapture, HasRequestsLikeOurs) {
  const std::vector<std::uint8_t> theirs = captured(MessageId::kConnect).payload;
  const std::vector<std::uint8_t> ours = connect_request({4, 1});
  EXPECT_EQ(theirs.size() + 5, ours.size());
  EXPECT_EQ(models_request(), captured(MessageId::kRequestModels).payload);
}

TEST(NatNetFrame, IsReadInEveryLayout) {
  const packets::Frame sent = two_bodies();
  for (const Version version : kVersions) {
    SCOPED_TRACE(version.to_string());
    for (const bool with_others : {false, true}) {
      packets::Frame variant = sent;
      variant.with_others = with_others;
      Frame frame;
      ASSERT_EQ(parse_frame(payload_of(packets::frame(version, variant)), version, frame), nullptr);
      EXPECT_EQ(frame.number, 4711);
      EXPECT_EQ(frame.timestamp_s, 12.5);
      EXPECT_EQ(frame.exposed_ticks, 1000U);
      EXPECT_EQ(frame.received_ticks, 2000U);
      EXPECT_EQ(frame.sent_ticks, 3000U);
      EXPECT_TRUE(frame.models_changed);
      ASSERT_EQ(frame.bodies.size(), 2U);
      EXPECT_EQ(frame.bodies[0].id, 1);
      EXPECT_EQ(frame.bodies[0].position, Eigen::Vector3d(1, 2, 3));
      EXPECT_NEAR(frame.bodies[0].q_room_from_body.x(), 0.6, 1e-6);
      EXPECT_TRUE(frame.bodies[0].tracked);
      EXPECT_EQ(frame.bodies[0].lost_markers, 1);
      EXPECT_EQ(frame.bodies[1].id, 22);
      EXPECT_FALSE(frame.bodies[1].tracked);
      EXPECT_EQ(frame.bodies[1].markers, 3);
      EXPECT_EQ(frame.bodies[1].lost_markers, 3);
    }
  }
}

TEST(NatNetFrame, WithAPoseThatIsNoneIsUntracked) {
  packets::Frame sent = two_bodies();
  sent.bodies[0].q_xyzw[3] = 0.1F;
  sent.bodies[1] = {"kl2", 22, {std::numeric_limits<float>::quiet_NaN(), 0, 0}, {0, 0, 0, 1}, true};
  Frame frame;
  ASSERT_EQ(parse_frame(payload_of(packets::frame({4, 1}, sent)), {4, 1}, frame), nullptr);
  EXPECT_FALSE(frame.bodies[0].tracked);
  EXPECT_FALSE(frame.bodies[1].tracked);
}

TEST(NatNetModels, AreReadInEveryLayout) {
  for (const Version version : kVersions) {
    SCOPED_TRACE(version.to_string());
    for (const bool with_others : {false, true}) {
      for (const bool bones_with_markers : {false, true}) {
        std::vector<BodyDefinition> bodies;
        const auto sent = packets::models(version, two_bodies().bodies, with_others, bones_with_markers);
        ASSERT_EQ(parse_models(payload_of(sent), version, bodies), nullptr);
        ASSERT_EQ(bodies.size(), 2U);
        EXPECT_EQ(bodies[0].name, "kl1");
        EXPECT_EQ(bodies[0].id, 1);
        EXPECT_EQ(bodies[1].name, "kl2");
        EXPECT_EQ(bodies[1].id, 22);
      }
    }
  }
}

// GIVEN a message that is cut anywhere THEN it is refused, and nothing beyond its end is read: the sanitizer would report it.
TEST(NatNetMessages, ThatAreCutAreRefused) {
  for (const Version version : kVersions) {
    SCOPED_TRACE(version.to_string());
    const auto frame_bytes = packets::frame(version, two_bodies());
    for (std::size_t size = 4; size + 4 < frame_bytes.size(); ++size) {
      const std::vector<std::uint8_t> cut(frame_bytes.begin() + 4,
                                          frame_bytes.begin() + static_cast<std::ptrdiff_t>(size));
      Frame frame;
      EXPECT_NE(parse_frame({cut.data(), cut.size(), true}, version, frame), nullptr) << size;
    }
    const auto models = packets::models(version, two_bodies().bodies);
    for (std::size_t size = 4; size < models.size(); ++size) {
      const std::vector<std::uint8_t> cut(models.begin() + 4,
                                          models.begin() + static_cast<std::ptrdiff_t>(size));
      std::vector<BodyDefinition> bodies;
      EXPECT_NE(parse_models({cut.data(), cut.size(), true}, version, bodies), nullptr) << size;
    }
  }
  const auto info = packets::server_info({});
  EXPECT_FALSE(parse_message(info.data(), info.size() - 1));
  EXPECT_FALSE(parse_message(info.data(), 3));
}

TEST(NatNetMessages, WithImpossibleCountsAreRefused) {
  for (const std::int32_t count : {-1, 2'000'000'000}) {
    auto bytes = packets::frame({3, 0}, two_bodies());
    std::memcpy(bytes.data() + 8, &count, sizeof count);  // of the marker sets
    Frame frame;
    EXPECT_NE(parse_frame(payload_of(bytes), {3, 0}, frame), nullptr);
  }
}

}  // namespace swiftlet::mocap::natnet::natnet_test

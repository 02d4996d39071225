#include "swiftlet/services/dds/discovery/repeated_discovery.hpp"

#include <gtest/gtest.h>

#include "tests/support/rtps_message.hpp"

namespace swiftlet::dds::repeated_discovery_test {

using tests::ByteWriter;
using tests::RtpsMessage;

bool is_announcement_of(const RtpsMessage& message) {
  return announcement_digest(message.bytes().data(), message.bytes().size()).has_value();
}

ByteWriter sample_of(const rtps::EntityId& reader, const rtps::EntityId& writer) {
  return tests::data_fields(reader, writer, 1);
}

// RTPS 2.5, 9.6.1.1: 7400 + 250 domain, + 0 for multicast of discovery, + 10 + 2 n for discovery of process n; the data
// ports are the odd ones.
TEST(DiscoveryPort, IsThatOfTheRtpsStandard) {
  EXPECT_TRUE(is_discovery_port(0, 7400));
  EXPECT_FALSE(is_discovery_port(0, 7401)) << "multicast of data";
  EXPECT_TRUE(is_discovery_port(0, 7410));
  EXPECT_FALSE(is_discovery_port(0, 7411));
  EXPECT_TRUE(is_discovery_port(0, 7412));
  EXPECT_FALSE(is_discovery_port(0, 7650)) << "of domain 1";
  EXPECT_TRUE(is_discovery_port(1, 7650));
  EXPECT_FALSE(is_discovery_port(0, 49'152)) << "a port of its own of a reader";
}

TEST(RepeatedDiscovery, KnowsAnnouncements) {
  RtpsMessage announcement = tests::announcement(tests::kAlice, tests::participant_parameters(tests::kAlice));
  EXPECT_TRUE(is_announcement_of(announcement));
  EXPECT_TRUE(is_announcement_of(announcement.add(0x80, 0, ByteWriter().zeros(56)))) << "with statistics";
  const rtps::EntityId liveliness_writer{0x00, 0x02, 0x00, 0xc2};
  EXPECT_TRUE(is_announcement_of(RtpsMessage()
                                     .add(0x0e, 0, ByteWriter().bytes(tests::kBob))
                                     .add(0x15, 4, sample_of(rtps::kUnknownEntity, liveliness_writer))));
}

TEST(RepeatedDiscovery, KnowsWhatTellsOfEndpoints) {
  const auto endpoint = [] { return sample_of(tests::kSedpReader, tests::kSedpWriter); };
  const ByteWriter participant = sample_of(tests::kSpdpReader, tests::kSpdpWriter);
  EXPECT_FALSE(is_announcement_of(RtpsMessage().add(0x15, 4, endpoint())));
  EXPECT_FALSE(is_announcement_of(RtpsMessage().add(0x15, 4, participant).add(0x15, 4, endpoint())))
      << "both";
  EXPECT_FALSE(is_announcement_of(RtpsMessage().add(0x07, 0, ByteWriter().zeros(28)))) << "a heartbeat";
  EXPECT_FALSE(is_announcement_of(RtpsMessage().add(0x15, 4, ByteWriter().zeros(3)))) << "too short";
  EXPECT_FALSE(is_announcement_of(RtpsMessage().add(0x15, 4, participant, 200))) << "longer than the message";
}

TEST(RepeatedDiscovery, TellsWhatIsAnnouncedFromWhen) {
  const auto digest_of = [](std::uint8_t time, const rtps::GuidPrefix& participant) {
    RtpsMessage message;
    message.add(0x09, 0, ByteWriter().bytes(std::vector<std::uint8_t>(8, time)))
        .add(0x15, 4, sample_of(tests::kSpdpReader, tests::kSpdpWriter).bytes(participant));
    return announcement_digest(message.bytes().data(), message.bytes().size());
  };
  ASSERT_TRUE(digest_of(1, tests::kAlice));
  EXPECT_EQ(digest_of(1, tests::kAlice), digest_of(2, tests::kAlice));
  EXPECT_NE(digest_of(1, tests::kAlice), digest_of(1, tests::kBob));
}

}  // namespace swiftlet::dds::repeated_discovery_test

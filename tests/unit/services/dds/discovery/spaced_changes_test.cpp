#include "swiftlet/services/dds/discovery/spaced_changes.hpp"

#include <gtest/gtest.h>

#include "tests/support/rtps_message.hpp"

namespace swiftlet::comms {
namespace {

using tests::ByteWriter;
using tests::RtpsMessage;
using Time = ChangeSpacing::Time;

std::optional<ParticipantChange> change_in(const RtpsMessage& message) {
  return participant_change(message.bytes().data(), message.bytes().size());
}

ByteWriter announcement(std::uint32_t number) {
  return tests::data_fields(tests::kSpdpReader, tests::kSpdpWriter, number);
}

TEST(ParticipantChange, IsFoundBesideOtherSubmessages) {
  const RtpsMessage message = RtpsMessage(tests::kAlice)
                                  .add(0x0e, 0, ByteWriter().bytes(tests::kBob))
                                  .add(0x15, 4, announcement(7))
                                  .add(0x07, 0, ByteWriter().zeros(28));
  const auto change = change_in(message);
  ASSERT_TRUE(change);
  EXPECT_EQ(change->participant, tests::kAlice);
  EXPECT_EQ(change->sequence_number, 7);
}

TEST(ParticipantChange, IsOnlyThatOfAParticipant) {
  EXPECT_FALSE(change_in(RtpsMessage(tests::kAlice)));
  EXPECT_FALSE(change_in(RtpsMessage(tests::kAlice)
                             .add(0x15, 4, tests::data_fields(tests::kSedpReader, tests::kSedpWriter, 1))));
  EXPECT_FALSE(change_in(RtpsMessage(tests::kAlice).add(0x15, 4, ByteWriter().zeros(3)))) << "too short";
  EXPECT_FALSE(change_in(RtpsMessage(tests::kAlice).add(0x15, 4, announcement(1), 200)))
      << "longer than the message";
  const std::uint8_t header[10] = {};
  EXPECT_FALSE(participant_change(header, sizeof header));
}

TEST(ChangeSpacing, KeepsTheChangesOfAParticipantApart) {
  ChangeSpacing spacing;
  const Time start{std::chrono::seconds(10)};
  EXPECT_EQ(spacing.due({tests::kAlice, 1}, start), start);
  EXPECT_EQ(spacing.due({tests::kAlice, 1}, start), start) << "a repetition";
  EXPECT_EQ(spacing.due({tests::kBob, 1}, start), start) << "another participant";
  EXPECT_EQ(spacing.due({tests::kAlice, 2}, start), start + kChangeSpacing);
  const Time then = start + kChangeSpacing;
  EXPECT_EQ(spacing.due({tests::kAlice, 3}, then), then + kChangeSpacing) << "measured from when 2 was due";
  const Time later = start + 5 * kChangeSpacing;
  EXPECT_EQ(spacing.due({tests::kAlice, 4}, later), later);
}

}  // namespace
}  // namespace swiftlet::comms

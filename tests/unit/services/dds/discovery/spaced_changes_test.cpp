#include "swiftlet/services/dds/discovery/spaced_changes.hpp"

#include <gtest/gtest.h>

#include "swiftlet/services/dds/datagram/heard_participants.hpp"
#include "tests/support/rtps_message.hpp"

namespace swiftlet::comms::spaced_changes_test {

using tests::ByteWriter;
using tests::RtpsMessage;
using Time = ChangeSpacing::Time;

const Time kStart{std::chrono::seconds(10)};
constexpr std::chrono::microseconds kTick{1};

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

// An INFO_TS may be empty: its length of 0 does not mean that it reaches to the end of the message (RTPS 2.5, 9.4.5.1.3).
TEST(ParticipantChange, IsNotHiddenBehindAnEmptySubmessage) {
  for (const unsigned kind : {0x01U, 0x09U})
    EXPECT_TRUE(
        change_in(RtpsMessage(tests::kAlice).add(kind, 2, ByteWriter()).add(0x15, 4, announcement(7))));
}

TEST(DivideChanges, PutsEachChangeIntoAMessageOfItsOwn) {
  const ByteWriter to_bob = ByteWriter().bytes(tests::kBob);
  const ByteWriter heartbeat = ByteWriter().zeros(28);
  const RtpsMessage all = RtpsMessage(tests::kAlice)
                              .add(0x07, 0, heartbeat)
                              .add(0x0e, 0, to_bob)
                              .add(0x15, 4, announcement(7))
                              .add(0x15, 4, announcement(8))
                              .add(0x07, 0, heartbeat);
  const RtpsMessage first =
      RtpsMessage(tests::kAlice).add(0x07, 0, heartbeat).add(0x0e, 0, to_bob).add(0x15, 4, announcement(7));
  const RtpsMessage second =
      RtpsMessage(tests::kAlice).add(0x0e, 0, to_bob).add(0x15, 4, announcement(8)).add(0x07, 0, heartbeat);
  EXPECT_EQ(divide_changes(all.bytes().data(), all.bytes().size()),
            (std::vector<tests::Bytes>{first.bytes(), second.bytes()}));
  EXPECT_EQ(divide_changes(first.bytes().data(), first.bytes().size()),
            std::vector<tests::Bytes>{first.bytes()});
}

TEST(ChangeSpacing, KeepsTheChangesOfAParticipantApart) {
  ChangeSpacing spacing;
  EXPECT_TRUE(spacing.admit({tests::kAlice, 1}, kStart));
  EXPECT_TRUE(spacing.admit({tests::kAlice, 1}, kStart)) << "a repetition";
  EXPECT_TRUE(spacing.admit({tests::kBob, 1}, kStart)) << "another participant";
  EXPECT_FALSE(spacing.admit({tests::kAlice, 2}, kStart + kChangeSpacing - kTick));
  EXPECT_TRUE(spacing.admit({tests::kAlice, 3}, kStart + kChangeSpacing))
      << "measured from the change that was handed on";
  EXPECT_FALSE(spacing.admit({tests::kAlice, 4}, kStart + 2 * kChangeSpacing - kTick));
  EXPECT_TRUE(spacing.admit({tests::kAlice, 4}, kStart + 2 * kChangeSpacing));
}

comms::GuidPrefix participant(std::size_t number) {
  comms::GuidPrefix prefix = tests::kAlice;
  prefix[10] = static_cast<std::uint8_t>(number >> 8U);
  prefix[11] = static_cast<std::uint8_t>(number);
  return prefix;
}

TEST(ChangeSpacing, RemembersABoundedNumberOfParticipants) {
  ChangeSpacing spacing;
  for (std::size_t i = 0; i < kMostParticipants; ++i)
    ASSERT_TRUE(spacing.admit({participant(i), 1}, kStart)) << i;
  EXPECT_FALSE(spacing.admit({participant(kMostParticipants), 1}, kStart));
  EXPECT_TRUE(spacing.admit({participant(0), 1}, kStart)) << "one that it remembers";
  EXPECT_TRUE(spacing.admit({participant(kMostParticipants), 1}, kStart + kChangeSpacing));
}

// GIVEN a participant that has just joined.
class TooEarly : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(spacing_.admit({tests::kAlice, 1}, kStart)); }
  void keep(std::int64_t number) { changes_.keep({{tests::kAlice, number}, {}, &receiver_, {}}); }
  // The number of the change that is taken at the time; 0 if none is.
  std::int64_t taken(Time now) {
    const auto datagram = changes_.take(&receiver_, spacing_, now);
    return datagram ? datagram->change.sequence_number : 0;
  }

  ChangeSpacing spacing_;
  EarlyChanges changes_;
  const int receiver_ = 0;
};

TEST_F(TooEarly, ChangesAreHandedOnWhenTheyAreDue) {
  keep(2);
  EXPECT_EQ(taken(kStart + kChangeSpacing - kTick), 0);
  EXPECT_EQ(taken(kStart + kChangeSpacing), 2);
  EXPECT_EQ(taken(kStart + kChangeSpacing), 0) << "once";
  keep(3);
  EXPECT_EQ(taken(kStart + 2 * kChangeSpacing - kTick), 0) << "measured from the one before";
  EXPECT_EQ(taken(kStart + 2 * kChangeSpacing), 3);
}

TEST_F(TooEarly, TheChangesOfAParticipantAreHandedOnInOrder) {
  keep(3);
  keep(2);
  keep(3);
  EXPECT_EQ(taken(kStart + kChangeSpacing), 2);
  EXPECT_EQ(taken(kStart + 2 * kChangeSpacing - kTick), 0);
  EXPECT_EQ(taken(kStart + 2 * kChangeSpacing), 3);
  EXPECT_EQ(taken(kStart + 9 * kChangeSpacing), 0);
}

TEST_F(TooEarly, ChangesAreHandedOnToTheirReceiver) {
  const int other = 0;
  keep(2);
  EXPECT_FALSE(changes_.take(&other, spacing_, kStart + kChangeSpacing));
  EXPECT_EQ(taken(kStart + kChangeSpacing), 2);
}

TEST_F(TooEarly, ABoundedNumberOfChangesIsKept) {
  for (std::size_t number = 2; number < 9; ++number) keep(static_cast<std::int64_t>(number));
  Time now = kStart;
  std::size_t of_one = 0;
  while (taken(now += kChangeSpacing) != 0) ++of_one;
  EXPECT_EQ(of_one, EarlyChanges::kMostOfParticipant);

  for (std::size_t i = 0; i < 2 * EarlyChanges::kMost; ++i)
    changes_.keep({{participant(i), 1}, {}, &receiver_, {}});
  std::size_t of_all = 0;
  while (taken(now + kChangeSpacing) != 0) ++of_all;
  EXPECT_EQ(of_all, EarlyChanges::kMost);
}

}  // namespace swiftlet::comms::spaced_changes_test

#include "swiftlet/services/rtps/reply_check.hpp"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/rtps_message.hpp"

namespace swiftlet::rtps::reply_check_test {

using namespace swiftlet::tests;

// "" if kAlice admits it.
std::string fault_of(const ReplyCheck& replies, const RtpsMessage& message) {
  const CheckedDatagram checked = check_datagram(message.bytes().data(), message.bytes().size(), {});
  const char* const fault = checked.fault != nullptr ? checked.fault : replies.fault_of(checked);
  return fault == nullptr ? "" : fault;
}
void send(ReplyCheck& replies, const RtpsMessage& message) {
  EXPECT_TRUE(ReplyCheck::concerns_replies(message.bytes().data(), message.bytes().size()));
  replies.note_sent(message.bytes().data(), message.bytes().size());
}

RtpsMessage request(std::uint32_t base, std::uint32_t fragments, std::uint32_t number = 1,
                    const EntityId& writer = kUserWriter) {
  ByteWriter out;
  out.bytes(kUserReader).bytes(writer).number(0, number).u32(base).u32(fragments);
  return RtpsMessage(kBob).add(0x12, 0, out.zeros(std::size_t{4} * ((fragments + 31) / 32)).u32(1));
}

// A request of fragment 0 made Fast DDS read 4 GiB beyond the sample, and one of a fragment too many beyond its end.
TEST(ReplyCheck, AdmitsRequestsOfFragmentsThatWereSent) {
  ReplyCheck replies(kGapsAhead);
  EXPECT_NE(fault_of(replies, request(1, 1)), "") << "nothing was sent";
  send(replies, RtpsMessage(kAlice).add(0x16, 0, fragment_fields(1, 1, 1024, 3000).zeros(1024)));
  EXPECT_EQ(fault_of(replies, request(1, 3)), "");
  EXPECT_EQ(fault_of(replies, request(3, 1)), "");
  EXPECT_NE(fault_of(replies, request(4, 1)), "");
  EXPECT_NE(fault_of(replies, request(3, 2)), "");
  EXPECT_NE(fault_of(replies, request(0, 2)), "");
  EXPECT_NE(fault_of(replies, request(0xffffffff, 2)), "");
  EXPECT_NE(fault_of(replies, request(0xffffff01, 256)), "");
  EXPECT_NE(fault_of(replies, request(1, 1, 2)), "") << "another sample";
  EXPECT_NE(fault_of(replies, request(1, 1, 1, {0, 0, 7, 3})), "") << "another writer";
}

// A reader asks the port of a process that has ended, or its own host's at an address that stands for every host, and who
// receives there now has sent no fragments. Fast DDS ignores what names another participant.
TEST(ReplyCheck, AdmitsRequestsToOtherParticipants) {
  const auto request_to = [](const GuidPrefix& destination, const GuidPrefix& then = {}) {
    ByteWriter out;
    out.bytes(kUserReader).bytes(kUserWriter).number(0, 1).u32(1).u32(1).zeros(4).u32(1);
    return RtpsMessage(kBob)
        .add(0x0e, 0, ByteWriter().bytes(destination))
        .add(0x0e, 0, ByteWriter().bytes(then))
        .add(0x12, 0, out);
  };
  const GuidPrefix carol{0xca, 0x01};
  ReplyCheck replies(kGapsAhead);
  EXPECT_EQ(fault_of(replies, request_to(carol)), "") << "the own one, not known yet, has no writers";
  replies.set_participant(kAlice);
  EXPECT_EQ(fault_of(replies, request_to(carol)), "");
  EXPECT_EQ(fault_of(replies, request_to(kAlice, carol)), "");
  EXPECT_NE(fault_of(replies, request_to(kAlice)), "");
  EXPECT_NE(fault_of(replies, request_to(carol, kAlice)), "");
  EXPECT_NE(fault_of(replies, request_to({})), "") << "it names nobody";
  EXPECT_NE(fault_of(replies, request(1, 1)), "") << "nor does it";
}

TEST(ReplyCheck, RemembersTheFragmentsOfTheNewestSamples) {
  ReplyCheck replies(kGapsAhead);
  for (std::uint32_t number = 1; number <= 1000; ++number) {
    ByteWriter fields;
    fields.u16(0).u16(28).bytes(kUserReader).bytes(kUserWriter).number(0, number);
    send(replies, RtpsMessage(kAlice).add(0x16, 0, fields.u32(1).u16(1).u16(1024).u32(3000).zeros(1024)));
  }
  EXPECT_EQ(fault_of(replies, request(1, 3, 937)), "");
  EXPECT_NE(fault_of(replies, request(1, 3, 936)), "");
}

// While number 1 is missing, a reader of Fast DDS keeps each number of a gap that follows it.
TEST(ReplyCheck, BoundsTheNumbersThatGapsFillTheMemoryWith) {
  ReplyCheck replies(kGapsAhead);
  std::uint32_t admitted = 0;
  for (std::uint32_t start = 3; start < 1'000'000; start += 200) {
    ByteWriter gap;
    gap.bytes(kSedpReader).bytes(kSedpWriter).number(0, start).number(0, start + 200).u32(0);
    admitted += fault_of(replies, RtpsMessage(kBob).add(0x08, 0, gap)).empty() ? 200U : 0U;
  }
  EXPECT_GT(admitted, kGapsAhead - 200);
  EXPECT_LE(admitted, kGapsAhead);
}

TEST(ReplyCheck, AdmitsGapsBehindWhatWasAcknowledged) {
  ReplyCheck replies(kGapsAhead);
  const auto gap = [](std::uint32_t start, std::uint32_t bits = 0) {
    ByteWriter out;
    out.bytes(kUserReader).bytes(kUserWriter).number(0, start).number(0, start + 8).u32(bits);
    return RtpsMessage(kBob).add(0x08, 0, out.zeros(std::size_t{4} * ((bits + 31) / 32)));
  };
  EXPECT_NE(fault_of(replies, gap(100'000)), "");
  ByteWriter acknack;
  acknack.bytes(kUserReader).bytes(kUserWriter).number(0, 99'000).u32(0).u32(1);
  send(replies, RtpsMessage(kAlice).add(0x0e, 0, ByteWriter().bytes(kBob)).add(0x06, 0, acknack));
  EXPECT_EQ(fault_of(replies, gap(100'000)), "");
  EXPECT_EQ(fault_of(replies, gap(99'000 + kGapsAhead - 8)), "");
  EXPECT_NE(fault_of(replies, gap(99'000 + kGapsAhead - 8, 32)), "") << "with the numbers of its set";
}

}  // namespace swiftlet::rtps::reply_check_test

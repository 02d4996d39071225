#include "swiftlet/services/rtps/check.hpp"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/rtps_message.hpp"

namespace swiftlet::rtps::check_test {

using namespace swiftlet::tests;

CheckedDatagram check(const Bytes& datagram, bool security = false) {
  DatagramLimits limits;
  limits.security = security;
  return check_datagram(datagram.data(), datagram.size(), limits);
}
CheckedDatagram check(const RtpsMessage& message, bool security = false) {
  return check(message.bytes(), security);
}

// "" if it is valid.
std::string fault_of(const RtpsMessage& message, bool security = false) {
  const char* const fault = check(message, security).fault;
  return fault == nullptr ? "" : fault;
}
bool refuses(const RtpsMessage& message, const std::string& what) {
  const std::string fault = fault_of(message);
  EXPECT_NE(fault.find(what), std::string::npos) << "said: '" << fault << "'";
  return fault.find(what) != std::string::npos;
}

ByteWriter payload(ByteWriter fields, std::size_t bytes = 32) { return fields.u32(0x0100).zeros(bytes); }

ByteWriter number_set(std::uint32_t base, std::uint32_t bits) {
  ByteWriter out;
  out.bytes(kUserReader)
      .bytes(kUserWriter)
      .number(0, base)
      .u32(bits)
      .zeros(std::size_t{4} * ((bits + 31) / 32))
      .u32(1);
  return out;
}

ByteWriter heartbeat(std::uint32_t high, std::uint32_t first, std::uint32_t last) {
  ByteWriter out;
  out.bytes(kUserReader).bytes(kUserWriter).number(0, first).number(high, last).u32(1);
  return out;
}

ByteWriter gap_of(const EntityId& writer, std::uint32_t start, std::uint32_t base) {
  ByteWriter out;
  out.bytes(kUserReader).bytes(writer).number(0, start).number(0, base).u32(0);
  return out;
}
ByteWriter gap(std::uint32_t start, std::uint32_t base) { return gap_of(kUserWriter, start, base); }

RtpsMessage endpoint_data(const ByteWriter& parameters) {
  ByteWriter body = data_fields(kSedpReader, kSedpWriter, 1);
  body.u16(0x0300).u16(0).bytes(parameters.take()).sentinel();
  return RtpsMessage().add(0x15, 4, body);
}
ByteWriter endpoint_parameters() { return ByteWriter().parameter(0x005a, guid(kAlice, kUserWriter)); }

TEST(Datagram, OfOrdinaryTrafficIsValid) {
  EXPECT_EQ(fault_of(RtpsMessage()
                         .add(0x0e, 0, ByteWriter().bytes(kBob))
                         .add(0x09, 0, ByteWriter().zeros(8))
                         .add(0x15, 4, payload(data_fields(kUserReader, kUserWriter, 7)))
                         .add(0x07, 0, heartbeat(0, 1, 7))),
            "");
  EXPECT_EQ(fault_of(RtpsMessage().add(0x06, 2, number_set(8, 33))), "");
  EXPECT_EQ(fault_of(RtpsMessage().add(0x08, 0, gap(3, 9))), "");
  EXPECT_EQ(fault_of(RtpsMessage().add(0x16, 0, fragment_fields(2, 1, 1024, 3000).zeros(1024))), "");
  EXPECT_EQ(fault_of(announcement(kAlice, participant_parameters(kAlice))), "");
  EXPECT_EQ(
      fault_of(endpoint_data(endpoint_parameters().parameter(0x0005, ByteWriter().string("rt/kl1/imu")))),
      "");
  EXPECT_EQ(fault_of(RtpsMessage().add(0x7f, 0, ByteWriter().zeros(8))), "") << "unknown kinds are skipped";
}

TEST(Datagram, ReportsItsSourceAndItsGaps) {
  const CheckedDatagram checked = check(RtpsMessage(kBob)
                                            .add(0x15, 4, payload(data_fields(kUserReader, kUserWriter, 7)))
                                            .add(0x07, 0, heartbeat(0, 3, 9))
                                            .add(0x08, 0, gap_of(kSedpWriter, 3, 4)));
  ASSERT_EQ(checked.fault, nullptr);
  EXPECT_EQ(checked.source, kBob);
  EXPECT_FALSE(checked.announces_itself);
  ASSERT_EQ(checked.gaps.size(), 1U);
  EXPECT_EQ(checked.gaps[0].writer, kSedpWriter);
  EXPECT_EQ(checked.gaps[0].end, 4U);
  const CheckedDatagram announced = check(announcement(kAlice, participant_parameters(kAlice)));
  EXPECT_TRUE(announced.announces_itself);
}

// A process that joined while its host had no network announces the loopback interface, which is that of who hears it.
TEST(Datagram, OfAHostWithoutNetworkIsGivenTheAddressOfItsSender) {
  const auto locator = [](const Bytes& address) {
    return ByteWriter().u32(1).u32(7411).zeros(12).bytes(address);
  };
  const Bytes here{127, 0, 0, 1}, there{10, 0, 0, 7};
  ByteWriter parameters = participant_parameters(kAlice);
  parameters.parameter(0x0031, locator(here))
      .parameter(0x0032, locator(here))
      .parameter(0x0032, locator(there));
  const RtpsMessage announced = announcement(kAlice, parameters);
  const CheckedDatagram checked = check(announced);
  ASSERT_EQ(checked.fault, nullptr);
  EXPECT_EQ(checked.places.loopback.size(), 2U);
  EXPECT_EQ(checked.announced.addresses.size(), 0U);
  Bytes copy = announced.bytes();
  name_source(checked, 0x0a000063, copy.data());
  EXPECT_EQ(std::search(copy.begin(), copy.end(), here.begin(), here.end()), copy.end());
  EXPECT_EQ(std::search(copy.begin(), copy.end(), there.begin(), there.end()) == copy.end(), false);
  const CheckedDatagram again = check_datagram(copy.data(), copy.size(), DatagramLimits());
  ASSERT_EQ(again.announced.addresses.size(), 1U);
  EXPECT_EQ(again.announced.addresses[0], 0x0a000063U);

  const RtpsMessage endpoint = endpoint_data(endpoint_parameters().parameter(0x002f, locator(here)));
  EXPECT_EQ(check(endpoint).places.loopback.size(), 1U);
}

TEST(Datagram, NeedsAHeaderOfThisProtocolAndASource) {
  Bytes other = RtpsMessage().add(0x01, 0, ByteWriter()).bytes();
  other[4] = 1;
  EXPECT_STREQ(check(other).fault, "not RTPS, version 2 (8.3.6.3)");
  EXPECT_STREQ(check(Bytes(19)).fault, "shorter than the header of a message (8.3.6)");
  EXPECT_TRUE(refuses(RtpsMessage(GuidPrefix{}).add(0x01, 0, ByteWriter()), "unknown participant"));
  EXPECT_TRUE(refuses(RtpsMessage(), "without submessages"));
}

TEST(Datagram, SubmessagesMustFitIntoIt) {
  EXPECT_TRUE(refuses(RtpsMessage().add(0x07, 0, heartbeat(0, 1, 2), 100), "longer than the message"));
  EXPECT_TRUE(refuses(
      RtpsMessage().add(0x15, 4, payload(data_fields(kUserReader, kUserWriter, 1)), 30).add(0x01, 0, {}),
      "multiple of 4"));
  Bytes cut = RtpsMessage().add(0x07, 0, heartbeat(0, 1, 2)).bytes();
  for (std::size_t size = 0; size < cut.size(); ++size) {
    EXPECT_NE(check(Bytes(cut.begin(), cut.begin() + static_cast<std::ptrdiff_t>(size))).fault, nullptr)
        << size;
  }
}

TEST(Datagram, StatisticsSubmessageIsCutOffAtTheEndAndRefusedElsewhere) {
  const Bytes without = RtpsMessage().add(0x07, 0, heartbeat(0, 1, 2)).bytes();
  const CheckedDatagram checked =
      check(RtpsMessage().add(0x07, 0, heartbeat(0, 1, 2)).add(0x80, 0, ByteWriter().zeros(56)));
  EXPECT_EQ(checked.fault, nullptr);
  EXPECT_EQ(checked.length, without.size());
  EXPECT_TRUE(refuses(RtpsMessage().add(0x80, 0, ByteWriter().zeros(56)).add(0x07, 0, heartbeat(0, 1, 2)),
                      "statistics"));
  EXPECT_TRUE(refuses(RtpsMessage().add(0x80, 0, ByteWriter().zeros(52)), "statistics"));
}

TEST(Datagram, MayNotNameAnotherSource) {
  EXPECT_TRUE(refuses(RtpsMessage().add(0x0c, 0, ByteWriter().zeros(8).bytes(kBob)), "INFO_SRC"));
}

TEST(Datagram, SequenceNumbersAreBounded) {
  EXPECT_TRUE(refuses(RtpsMessage().add(0x07, 0, heartbeat(0x7fffffff, 1, 0xffffffff)), "out of range"));
  EXPECT_TRUE(refuses(RtpsMessage().add(0x07, 0, heartbeat(0, 5, 3)), "ends before it begins"));
  EXPECT_EQ(fault_of(RtpsMessage().add(0x07, 0, heartbeat(0, 5, 4))), "") << "no sample is available";
  EXPECT_TRUE(
      refuses(RtpsMessage().add(0x15, 4, payload(data_fields(kUserReader, kUserWriter, 0))), "out of range"));
  EXPECT_TRUE(refuses(RtpsMessage().add(0x08, 0, gap(3, 5'000'003)), "more than 256 samples"));
  EXPECT_TRUE(refuses(RtpsMessage().add(0x08, 0, gap(3, 2)), "ends before it begins"));
  EXPECT_TRUE(refuses(RtpsMessage().add(0x06, 0, number_set(1, 257)), "more than 256 numbers"));
}

TEST(Datagram, DataMustHoldWhatItsFlagsSay) {
  const auto data = [](unsigned flags, const ByteWriter& body) {
    return RtpsMessage().add(0x15, flags, body);
  };
  EXPECT_TRUE(refuses(data(4, payload(data_fields(kUserReader, kUserWriter, 1, 400))), "unknown place"));
  EXPECT_TRUE(refuses(data(4, payload(data_fields(kUserReader, kUserWriter, 1, 0x8000))), "unknown place"));
  EXPECT_TRUE(refuses(data(12, payload(data_fields(kUserReader, kUserWriter, 1))), "both data and key"));
  EXPECT_TRUE(refuses(data(4, data_fields(kUserReader, kUserWriter, 1)), "shorter than its encapsulation"));
  EXPECT_TRUE(refuses(data(6, payload(data_fields(kUserReader, kUserWriter, 1).u16(0x70).u16(4000))),
                      "longer than its list"));
  EXPECT_TRUE(refuses(data(6, data_fields(kUserReader, kUserWriter, 1)), "without its end"));
}

TEST(Datagram, FragmentsMustBelongToTheirSample) {
  const auto fragment = [](ByteWriter fields, std::size_t bytes) {
    return RtpsMessage().add(0x16, 0, fields.zeros(bytes));
  };
  EXPECT_TRUE(refuses(fragment(fragment_fields(1, 1, 1024, 300'000'000), 1024), "unusual size"));
  EXPECT_TRUE(refuses(fragment(fragment_fields(1, 1, 2, 3000), 1024), "unusual size"));
  EXPECT_TRUE(refuses(fragment(fragment_fields(4, 1, 1024, 3000), 1024), "does not have"));
  EXPECT_TRUE(refuses(fragment(fragment_fields(0, 1, 1024, 3000), 1024), "does not have"));
  EXPECT_TRUE(refuses(fragment(fragment_fields(1, 2, 1024, 3000), 2048), "several fragments"));
  EXPECT_TRUE(refuses(fragment(fragment_fields(1, 1, 1024, 3000), 1020), "less data"));
  EXPECT_TRUE(refuses(fragment(fragment_fields(3, 1, 1024, 2050), 1024), "shorter than 4 bytes"));
  EXPECT_TRUE(refuses(RtpsMessage().add(0x16, 2, fragment_fields(1, 1, 1024, 3000).sentinel()), "less data"));
}

TEST(Datagram, DiscoveryIsAboutItsSource) {
  EXPECT_TRUE(refuses(announcement(kBob, participant_parameters(kAlice)), "about another participant"));
  EXPECT_TRUE(refuses(
      announcement(kAlice, participant_parameters(kAlice).parameter(0x0070, guid(kBob, kParticipantEntity))),
      "about another participant"));
  EXPECT_TRUE(refuses(announcement(kAlice, ByteWriter().u16(0x0300).u16(0).parameter(0x0002, lease(20))),
                      "without GUID"));
  EXPECT_TRUE(refuses(endpoint_data(ByteWriter().parameter(0x005a, guid(kBob, kUserWriter))),
                      "about another participant"));
}

TEST(Datagram, GoodbyeNamesItsSource) {
  const auto goodbye = [](const GuidPrefix& who) {
    ByteWriter body = data_fields(kSpdpReader, kSpdpWriter, 2);
    body.parameter(0x0070, guid(who, kParticipantEntity))
        .parameter(0x0071, ByteWriter().u32(0x03000000))
        .sentinel();
    return RtpsMessage(kAlice).add(0x15, 2, body);
  };
  EXPECT_EQ(fault_of(goodbye(kAlice)), "");
  EXPECT_TRUE(refuses(goodbye(kBob), "about another participant"));
}

TEST(Datagram, BuiltinReadersReceiveOnlyFromTheirWriters) {
  EXPECT_TRUE(refuses(RtpsMessage().add(0x15, 4, payload(data_fields(kSpdpReader, kUserWriter, 1))),
                      "do not belong together"));
  EXPECT_TRUE(refuses(RtpsMessage().add(0x15, 4, payload(data_fields(kSedpReader, kSpdpWriter, 1))),
                      "do not belong together"));
}

TEST(Datagram, NumbersSamplesOfWritersOnly) {
  const ByteWriter anonymous = payload(data_fields(kUserReader, kUnknownEntity, 1));
  EXPECT_TRUE(refuses(RtpsMessage().add(0x15, 4, anonymous), "do not belong together"));
  EXPECT_TRUE(refuses(RtpsMessage().add(0x08, 0, gap_of(kUserReader, 3, 9)), "writer that is none"));
}

TEST(Datagram, ParametersOfDiscoveryMustFitTheirLength) {
  const auto with = [](unsigned id, const ByteWriter& value) {
    return endpoint_data(endpoint_parameters().parameter(id, value));
  };
  EXPECT_TRUE(refuses(with(0x0005, ByteWriter().u32(400).u32(0)), "exceeds its length"))
      << "a string without end";
  EXPECT_TRUE(refuses(with(0x0005, ByteWriter().u32(4).u32(0x41414141)), "exceeds its length"))
      << "without NUL";
  EXPECT_TRUE(refuses(with(0x0029, ByteWriter().u32(0xffffffff)), "exceeds its length")) << "partitions";
  EXPECT_TRUE(refuses(with(0x002c, ByteWriter().u32(5).u32(0)), "exceeds its length")) << "user data";
  EXPECT_TRUE(refuses(with(0x0073, ByteWriter().u32(0x10000000)), "exceeds its length")) << "representations";
  EXPECT_TRUE(refuses(with(0x0059, ByteWriter().u32(1).string("key").u32(9)), "exceeds its length"))
      << "properties";
  EXPECT_TRUE(refuses(with(0x002f, ByteWriter().zeros(8)), "exceeds its length")) << "a locator";
  EXPECT_TRUE(refuses(announcement(kAlice, participant_parameters(kAlice).parameter(0x0002, lease(100'000))),
                      "lease"));
  EXPECT_TRUE(
      refuses(announcement(kAlice, participant_parameters(kAlice).parameter(0x0002, lease(0))), "lease"));
}

TEST(Datagram, SecurityTokensAreForSecurity) {
  const ByteWriter token = ByteWriter().string("DDS:Auth:PKI-DH:1.0").u32(0).u32(0);
  const ByteWriter vast = ByteWriter().string("DDS:Auth:PKI-DH:1.0").u32(5'000'000).u32(0);
  const auto with = [](const ByteWriter& value) {
    return announcement(kAlice, participant_parameters(kAlice).parameter(0x1001, value));
  };
  EXPECT_TRUE(refuses(with(token), "security is off"));
  EXPECT_EQ(fault_of(with(token), true), "");
  EXPECT_NE(fault_of(with(vast), true), "");
  EXPECT_TRUE(refuses(RtpsMessage().add(0x33, 0, ByteWriter().zeros(20)), "security is off"));
}

TEST(Datagram, WithSecurityOnlyAnnouncementsAndHandshakesAreClear) {
  const RtpsMessage encrypted = RtpsMessage()
                                    .add(0x33, 0, ByteWriter().zeros(20))
                                    .add(0x30, 0, ByteWriter().zeros(21))
                                    .add(0x34, 0, ByteWriter().zeros(20))
                                    .add(0x80, 0, ByteWriter().zeros(56));
  EXPECT_EQ(fault_of(encrypted, true), "");
  EXPECT_EQ(check(encrypted, true).length, encrypted.bytes().size() - 60);
  EXPECT_EQ(fault_of(announcement(kAlice, participant_parameters(kAlice)), true), "");
  const RtpsMessage sample =
      RtpsMessage().add(0x15, 4, data_fields(kUserReader, kUserWriter, 7).u32(0x0100).zeros(60));
  EXPECT_EQ(fault_of(sample), "");
  EXPECT_NE(fault_of(sample, true), "") << "a forged sample";
  EXPECT_NE(fault_of(endpoint_data(endpoint_parameters()), true), "") << "a forged endpoint";
  const ByteWriter endpoints = ByteWriter().bytes(kUserReader).bytes(kUserWriter);
  EXPECT_NE(
      fault_of(RtpsMessage().add(0x07, 0, ByteWriter(endpoints).number(0, 1).number(0, 9).u32(3)), true), "");
  EXPECT_NE(fault_of(RtpsMessage().add(0x06, 0, ByteWriter(endpoints).number(0, 4).u32(0).u32(3)), true), "");
  EXPECT_NE(
      fault_of(RtpsMessage().add(0x08, 0, ByteWriter(endpoints).number(0, 4).number(0, 9).u32(0)), true), "");
}

// Fast DDS looks for its statistics before it decrypts, and asserts that they are the last.
TEST(Datagram, NothingStandsBesideTheContentOfAnEncryptedMessage) {
  const auto with = [](const RtpsMessage& more) { return fault_of(more, true); };
  const RtpsMessage prefix = RtpsMessage().add(0x33, 0, ByteWriter().zeros(20));
  EXPECT_NE(with(RtpsMessage(prefix).add(0x80, 0, ByteWriter().zeros(56)).add(0x01, 0, ByteWriter())), "");
  EXPECT_NE(with(RtpsMessage(prefix).add(0x0c, 0, ByteWriter().zeros(20))), "");
  EXPECT_NE(with(RtpsMessage(prefix).add(0x15, 4, data_fields(kUserReader, kUserWriter, 7).zeros(64))), "");
}

TEST(Datagram, CountsOfAHandshakeAreBounded) {
  constexpr EntityId kHandshakeReader{0x00, 0x02, 0x01, 0xc4};
  constexpr EntityId kHandshakeWriter{0x00, 0x02, 0x01, 0xc3};
  const auto handshake = [&](const ByteWriter& tokens) {
    return fault_of(RtpsMessage().add(0x15, 4,
                                      data_fields(kHandshakeReader, kHandshakeWriter, 1)
                                          .u32(0x0100)
                                          .zeros(96)
                                          .string("dds.sec.auth")
                                          .bytes(tokens.take())),
                    true);
  };
  const ByteWriter token =
      ByteWriter().string("DDS:Auth:PKI-DH:1.0+Req").u32(0).u32(1).string("c.id").u32(6).zeros(8);
  EXPECT_EQ(handshake(ByteWriter().u32(1).bytes(token.take())), "");
  EXPECT_NE(handshake(ByteWriter().u32(2).bytes(token.take())), "") << "a token is missing";
  EXPECT_NE(handshake(ByteWriter().u32(0x10000000)), "") << "tokens";
  EXPECT_NE(handshake(ByteWriter().u32(1).string("x").u32(0x10000000).u32(0)), "") << "properties";
  EXPECT_NE(handshake(ByteWriter().u32(1).string("x").u32(0).u32(0x08000000)), "") << "binary properties";
  EXPECT_NE(handshake(ByteWriter().u32(1).string("x").u32(0).u32(1).string("c.id").u32(0x7fffffff)), "")
      << "value";
}

TEST(Datagram, TypeDescriptionsAreHiddenFromTheMiddleware) {
  const RtpsMessage message = endpoint_data(endpoint_parameters().parameter(0x0072, ByteWriter().zeros(16)));
  const CheckedDatagram checked = check(message);
  ASSERT_EQ(checked.fault, nullptr);
  ASSERT_EQ(checked.places.hidden.size(), 1U);
  Bytes copy = message.bytes();
  hide_parameters(checked, copy.data());
  const std::size_t at = checked.places.hidden[0];
  EXPECT_EQ(message.bytes()[at], 0x72);
  EXPECT_EQ(copy[at], 0);
  EXPECT_EQ(copy[at + 1], 0);
  copy[at] = 0x72;
  EXPECT_EQ(copy, message.bytes()) << "changes nothing else";
}

}  // namespace swiftlet::rtps::check_test

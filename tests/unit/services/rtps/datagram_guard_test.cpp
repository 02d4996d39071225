#include "swiftlet/services/rtps/datagram_guard.hpp"

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/services/rtps/key_rules.hpp"
#include "tests/support/malloc_guard.hpp"
#include "tests/support/rtps_message.hpp"

namespace swiftlet::rtps::datagram_guard_test {

using namespace swiftlet::tests;

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr Ipv4 kHost = 0x0a000001;

RtpsMessage sample(std::uint32_t number, const GuidPrefix& source = kAlice) {
  return RtpsMessage(source).add(0x15, 4, data_fields(kUserReader, kUserWriter, number).u32(0x0100).u32(0));
}

bool admits(DatagramGuard& guard, const RtpsMessage& message, std::int64_t now_ns, Ipv4 host = kHost) {
  return guard.admit(message.bytes().data(), message.bytes().size(), host, 7411, {now_ns, now_ns}).fault ==
         nullptr;
}

GuidPrefix numbered_participant(std::uint32_t number) {
  GuidPrefix prefix = kAlice;
  for (std::size_t i = 0; i < 4; ++i) prefix[i + 4] = static_cast<std::uint8_t>(number >> (8 * i));
  return prefix;
}
RtpsMessage newcomer(std::uint32_t number) {
  const GuidPrefix prefix = numbered_participant(number);
  return announcement(prefix, participant_parameters(prefix));
}

// What jumps, repeats and loss of a network do to numbers is the middleware's to judge; and hosts may announce as many
// participants as they like.
TEST(DatagramGuard, RefusesNoNumberAndNoNewcomer) {
  DatagramGuard guard;
  for (const std::uint32_t number : {1000U, 7U, 1000U, 1U << 20U, 1001U})
    EXPECT_TRUE(admits(guard, sample(number), kSecond_ns)) << number;
  const Now now{kSecond_ns, kSecond_ns};
  for (std::uint32_t i = 1; i <= 2 * kMostParticipants; ++i)
    ASSERT_TRUE(admits(guard, newcomer(i), kSecond_ns)) << i;
  EXPECT_EQ(guard.participants_heard(now), kMostParticipants);
  EXPECT_TRUE(admits(guard, announcement(kAlice, participant_parameters(kAlice).parameter(0x0002, lease(1))),
                     kSecond_ns))
      << "with another lease than before";
  EXPECT_EQ(guard.refusals().total(), 0U);
}

TEST(DatagramGuard, LetsWhoIsMetTakeTurnsWithSecurityOnly) {
  constexpr EntityId kHandshakeReader{0x00, 0x02, 0x01, 0xc4};
  constexpr EntityId kHandshakeWriter{0x00, 0x02, 0x01, 0xc3};
  const RtpsMessage handshake = RtpsMessage().add(
      0x15, 4,
      data_fields(kHandshakeReader, kHandshakeWriter, 1).u32(0x0100).zeros(96).string("dds.sec.auth").u32(0));
  DatagramGuard secure(io::NetworkKeys{}, DatagramLimits{true, false});
  DatagramGuard open;
  const auto takes_turns = [](DatagramGuard& guard, const RtpsMessage& message) {
    const CheckedDatagram checked =
        guard.admit(message.bytes().data(), message.bytes().size(), kHost, 7411, {kSecond_ns, kSecond_ns});
    EXPECT_STREQ(checked.fault, nullptr);
    return guard.takes_turns(checked);
  };
  EXPECT_TRUE(takes_turns(secure, handshake));
  EXPECT_TRUE(takes_turns(secure, newcomer(1)));
  EXPECT_FALSE(takes_turns(open, newcomer(1)));
  EXPECT_FALSE(takes_turns(open, sample(1)));
}

// The threads that receive are real-time: they hold a lock meanwhile for which the others wait.
TEST(DatagramGuard, AllocatesNothingWhileItReceives) {
  std::vector<Bytes> datagrams;
  for (std::uint32_t i = 0; i <= 2 * kMostParticipants; ++i) datagrams.push_back(newcomer(i).bytes());
  datagrams.push_back(sample(1).bytes());
  Bytes broken = sample(2).bytes();
  broken.resize(broken.size() / 2);
  datagrams.push_back(broken);
  DatagramGuard guard;
  const test::MallocGuard allocations;
  for (std::size_t i = 0; i < datagrams.size(); ++i) {
    const Ipv4 host = kHost + static_cast<Ipv4>(i);
    const auto now_ns = static_cast<std::int64_t>(i + 1) * kSecond_ns;
    guard.admit(datagrams[i].data(), datagrams[i].size(), host, 7411, {now_ns, now_ns});
  }
  EXPECT_EQ(allocations.calls(), 0U);
  EXPECT_EQ(guard.refusals().total(), 1U);
}

TEST(DatagramGuard, KnowsTheNamesOfParticipants) {
  DatagramGuard guard;
  const auto hear_of = [&](const GuidPrefix& participant, const std::string& name) {
    ASSERT_TRUE(
        admits(guard,
               announcement(participant,
                            participant_parameters(participant).parameter(0x0062, ByteWriter().string(name))),
               kSecond_ns));
  };
  hear_of(kAlice, "control");
  EXPECT_EQ(guard.name_of(kAlice), "control");
  EXPECT_EQ(guard.name_of(kBob), "");
  hear_of(kBob, std::string(200, 'b'));
  EXPECT_EQ(guard.name_of(kBob), std::string(32, 'b'));
  ASSERT_TRUE(admits(guard, announcement(kAlice, participant_parameters(kAlice)), kSecond_ns));
  EXPECT_EQ(guard.name_of(kAlice), "") << "it says none now";
}

// Announced by `participant`, which serves the vehicles and receives discovery at the port.
CheckedDatagram hear(DatagramGuard& guard, const GuidPrefix& participant, const std::string& user_data,
                     std::int64_t now_ns) {
  ByteWriter parameters = participant_parameters(participant);
  parameters.parameter(0x0032, ByteWriter().u32(1).u32(7412).zeros(12).bytes(Bytes{10, 0, 0, 1}));
  ByteWriter text;
  text.u32(static_cast<std::uint32_t>(user_data.size()))
      .bytes(user_data)
      .zeros((4 - user_data.size() % 4) % 4);
  const RtpsMessage message = announcement(participant, parameters.parameter(0x002c, text));
  return guard.admit(message.bytes().data(), message.bytes().size(), kHost, 7411, {now_ns, now_ns});
}

Bytes user_data_of(const std::string& text) { return {text.begin(), text.end()}; }

TEST(DatagramGuard, IgnoresParticipantsOfOtherVehicles) {
  DatagramGuard guard;
  const std::string of_kl2 = "vehicle=kl2;hears=own;";
  guard.ignore_apart_from(user_data_of("vehicle=kl1;hears=own;"));
  EXPECT_TRUE(hear(guard, kAlice, of_kl2, kSecond_ns).is_ignored);
  EXPECT_FALSE(hear(guard, kBob, "vehicle=kl2;", kSecond_ns).is_ignored) << "a tool";
  EXPECT_EQ(guard.refusals().total(), 0U);
  const Now now{kSecond_ns, kSecond_ns};
  EXPECT_EQ(guard.participants_heard(now), 2U);
  const std::vector<Joined> joined = guard.participants_joined(now);
  ASSERT_EQ(joined.size(), 1U);
  EXPECT_EQ(joined.front().discovery_port, 7412U);
  EXPECT_EQ(joined.front().since_ns, kSecond_ns);

  guard.ignore_apart_from(user_data_of("vehicle=kl1,kl2;hears=own;"));
  EXPECT_FALSE(hear(guard, kAlice, of_kl2, 2 * kSecond_ns).is_ignored) << "serves its vehicle now";
  guard.ignore_apart_from(user_data_of("vehicle=kl1;hears=own;"));
  EXPECT_FALSE(hear(guard, kAlice, of_kl2, 3 * kSecond_ns).is_ignored) << "the middleware knows it";
}

TEST(DatagramGuard, CountsTheParticipantsThatItExpects) {
  DatagramGuard guard;
  const auto heard = [&](std::int64_t now_ns) { return guard.participants_heard({now_ns, now_ns}); };
  guard.expect_participants(40, {kSecond_ns, kSecond_ns});
  hear(guard, kAlice, "", kSecond_ns);
  EXPECT_EQ(heard(kSecond_ns), 40U);
  EXPECT_EQ(heard(60 * kSecond_ns), 0U) << "all silent for long";
}

// What a receiver with these keys says of a sealed datagram, "" if it accepts it.
std::string fault_of(DatagramGuard& guard, const Bytes& datagram, std::int64_t now_ns,
                     std::uint32_t port = 7411) {
  const char* const fault =
      guard.admit(datagram.data(), datagram.size(), kHost, port, {now_ns, now_ns}).fault;
  return fault == nullptr ? "" : fault;
}

Bytes sealed(const io::NetworkKeys& keys, const RtpsMessage& message, std::int64_t now_ns) {
  DatagramGuard sender(keys);
  Bytes datagram = message.bytes();
  sender.seal(datagram, {now_ns, now_ns});
  return datagram;
}

const io::NetworkKey kOldKey{1};
const io::NetworkKey kNewKey{2};

TEST(Seal, IsAcceptedOnceOnEachPort) {
  DatagramGuard guard({kOldKey});
  const Bytes datagram = sealed({kOldKey}, sample(1), kSecond_ns);
  EXPECT_EQ(fault_of(guard, datagram, kSecond_ns), "");
  EXPECT_NE(fault_of(guard, datagram, kSecond_ns), "");
  EXPECT_EQ(fault_of(guard, datagram, kSecond_ns, 7000), "") << "of a reader with a port of its own";
}

// Fast DDS sends to each address of a host with two networks.
TEST(Seal, OfACopyIsNoAttack) {
  DatagramSealer sender({kOldKey});
  DatagramGuard guard({kOldKey});
  Bytes first = sample(1).bytes();
  Bytes later = first;
  sender.seal(first, kSecond_ns);
  sender.seal(later, 3 * kSecond_ns);
  EXPECT_EQ(fault_of(guard, first, kSecond_ns), "");
  EXPECT_EQ(fault_of(guard, first, kSecond_ns), kSentTwice);
  EXPECT_EQ(guard.refusals().total(), 0U);
  EXPECT_EQ(fault_of(guard, later, 3 * kSecond_ns), "");
  EXPECT_EQ(fault_of(guard, first, 3 * kSecond_ns), "received before");
  EXPECT_EQ(guard.refusals().total(), 1U);
}

TEST(Seal, IsAcceptedInAnyOrder) {
  DatagramGuard sender({kOldKey});
  DatagramGuard guard({kOldKey});
  std::vector<Bytes> datagrams(kSealWindow + 50, sample(1).bytes());
  for (Bytes& datagram : datagrams) sender.seal(datagram, {kSecond_ns, kSecond_ns});
  EXPECT_EQ(fault_of(guard, datagrams[100], kSecond_ns), "");
  EXPECT_EQ(fault_of(guard, datagrams[7], kSecond_ns), "");
  EXPECT_EQ(fault_of(guard, datagrams[7], kSecond_ns), kSentTwice);
  EXPECT_EQ(fault_of(guard, datagrams.back(), kSecond_ns), "");
  EXPECT_EQ(fault_of(guard, datagrams[100], kSecond_ns), kSentTwice);
  EXPECT_EQ(fault_of(guard, datagrams[50], kSecond_ns), "");
  EXPECT_EQ(fault_of(guard, datagrams[49], kSecond_ns), "older than 2048 others of its sender");
}

// A process of 16 vehicles sends some 17,000 datagrams a second to all others together, each delayed by up to 50 ms.
TEST(Seal, IsAcceptedThoughTheNetworkReordersAFleet) {
  DatagramGuard sender(io::NetworkKeys{kOldKey});
  DatagramGuard guard(io::NetworkKeys{kOldKey});
  std::mt19937 random(7);
  std::uniform_int_distribution<std::int64_t> delay_ns(0, 50'000'000);
  std::vector<std::pair<std::int64_t, Bytes>> arrivals;
  for (std::int64_t sent_ns = kSecond_ns; arrivals.size() < 17'000; sent_ns += kSecond_ns / 17'000) {
    Bytes datagram = sample(1).bytes();
    sender.seal(datagram, {sent_ns, sent_ns});
    arrivals.emplace_back(sent_ns + delay_ns(random), std::move(datagram));
  }
  std::stable_sort(arrivals.begin(), arrivals.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [arrived_ns, datagram] : arrivals) ASSERT_EQ(fault_of(guard, datagram, arrived_ns), "");
}

TEST(Seal, RefusesWhoHasNotTheKey) {
  DatagramGuard guard({kOldKey});
  EXPECT_EQ(fault_of(guard, sample(1).bytes(), kSecond_ns), "not sealed with a network key");
  EXPECT_EQ(fault_of(guard, sealed({kNewKey}, sample(1), kSecond_ns), kSecond_ns),
            "sealed with another network key");
  const Bytes datagram = sealed({kOldKey}, sample(1), kSecond_ns);
  for (std::size_t at = 20; at < datagram.size() - 20; ++at) {
    Bytes changed = datagram;
    changed[at] ^= 1U;
    EXPECT_NE(fault_of(guard, changed, kSecond_ns), "") << at;
  }
  EXPECT_EQ(fault_of(guard, datagram, kSecond_ns), "") << "forgeries do not use up its number";
}

// It would half discover a participant that refuses its answers, and take the network for a healthy one.
TEST(Seal, IsRefusedByWhoHasNoKey) {
  DatagramGuard guard;
  EXPECT_EQ(fault_of(guard, sealed({kOldKey}, sample(1), kSecond_ns), kSecond_ns),
            "sealed with a network key, and this process has none");
  const std::vector<RefusalLog::Refusal> last = guard.refusals().last();
  ASSERT_EQ(last.size(), 1U);
  EXPECT_EQ(last[0].sender, kHost);
  EXPECT_NE(std::string(remedy_of(last[0].rule)).find("--network-key"), std::string::npos);
  EXPECT_EQ(remedy_of("message without submessages (8.3.3)"), nullptr);
}

TEST(Seal, RefusesRecordings) {
  DatagramGuard guard({kOldKey});
  EXPECT_NE(fault_of(guard, sealed({kOldKey}, sample(1), kSecond_ns), 40 * kSecond_ns), "");
  EXPECT_NE(fault_of(guard, sealed({kOldKey}, sample(1), 80 * kSecond_ns), 40 * kSecond_ns), "");
  EXPECT_EQ(fault_of(guard, sealed({kOldKey}, sample(1), 43 * kSecond_ns), 40 * kSecond_ns), "")
      << "a clock 3 s ahead";
}

TEST(Seal, AcceptsTwoKeysWhileOneIsExchanged) {
  DatagramGuard before({kOldKey});
  DatagramGuard first_step({kOldKey, kNewKey});
  DatagramGuard second_step({kNewKey, kOldKey});
  DatagramGuard after({kNewKey});
  const Bytes old_one = sealed({kOldKey, kNewKey}, sample(1), kSecond_ns);
  const Bytes new_one = sealed({kNewKey, kOldKey}, sample(1), kSecond_ns);
  EXPECT_EQ(fault_of(before, old_one, kSecond_ns), "");
  EXPECT_EQ(fault_of(first_step, old_one, kSecond_ns), "");
  EXPECT_EQ(fault_of(first_step, new_one, kSecond_ns), "");
  EXPECT_EQ(fault_of(second_step, old_one, kSecond_ns), "");
  EXPECT_EQ(fault_of(after, new_one, kSecond_ns), "");
  EXPECT_NE(fault_of(after, old_one, kSecond_ns), "");
}

TEST(Seal, ReplacesTheStatisticsSubmessage) {
  const RtpsMessage with =
      RtpsMessage().add(0x07, 0, ByteWriter().zeros(4)).add(0x80, 0, ByteWriter().zeros(56));
  EXPECT_EQ(sealed({kOldKey}, with, kSecond_ns).size(), with.bytes().size());
  const RtpsMessage without = RtpsMessage().add(0x07, 0, ByteWriter().zeros(80));
  EXPECT_EQ(sealed({kOldKey}, without, kSecond_ns).size(), without.bytes().size() + kSealBytes);
}

}  // namespace swiftlet::rtps::datagram_guard_test

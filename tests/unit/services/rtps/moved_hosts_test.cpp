#include "swiftlet/services/rtps/moved_hosts.hpp"

#include <initializer_list>

#include <gtest/gtest.h>

namespace swiftlet::rtps::moved_hosts_test {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr Ipv4 kWired = 0x0a000001;
constexpr Ipv4 kWireless = 0x0a010001;
constexpr Ipv4 kNew = 0x0a000063;
constexpr Ipv4 kStranger = 0x0a0000ff;
constexpr Ipv4 kHere = 0x0a000002;
constexpr Ipv4 kLoopback = 0x7f000001;

Announced at(std::initializer_list<Ipv4> addresses) {
  Announced said;
  said.addresses.assign(addresses.begin(), addresses.end());
  return said;
}

TEST(MovedHosts, AreReachedWhereTheyAreHeardWhenTheirAddressHasFallenSilent) {
  MovedHosts hosts;
  hosts.set_own({kHere});
  hosts.heard(at({kWired}), kWired, kSecond_ns);
  EXPECT_FALSE(hosts.any());
  hosts.heard(at({kWired}), kNew, kSecond_ns + MovedHosts::kSilence_ns - 1);
  EXPECT_EQ(hosts.now_at(kWired), kWired) << "it may be a recording";
  hosts.heard(at({kWired}), kNew, kSecond_ns + MovedHosts::kSilence_ns);
  EXPECT_TRUE(hosts.any());
  EXPECT_EQ(hosts.now_at(kWired), kNew);
  EXPECT_EQ(hosts.now_at(kWireless), kWireless);
  hosts.heard(at({kWired}), kStranger, 2 * kSecond_ns + 1);
  EXPECT_EQ(hosts.now_at(kWired), kNew) << "it is heard there";
  hosts.heard(at({kWired}), kWired, 2 * kSecond_ns + 2);
  EXPECT_EQ(hosts.now_at(kWired), kWired) << "back";
  EXPECT_FALSE(hosts.any());
  const auto news = hosts.take_news();
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(news[0].announced, kWired);
  EXPECT_EQ(news[0].heard_at, kNew);
  EXPECT_EQ(news[1].heard_at, kWired);
  EXPECT_TRUE(hosts.take_news().empty());
}

TEST(MovedHosts, AreHeardAtAnyOfTheirAddresses) {
  MovedHosts hosts;
  hosts.set_own({kHere});
  const Announced both = at({kWired, kWireless});
  for (std::int64_t now_ns = kSecond_ns; now_ns < 10 * kSecond_ns; now_ns += kSecond_ns / 2) {
    hosts.heard(both, kWireless, now_ns);
    hosts.heard(both, kNew, now_ns + 1);
  }
  EXPECT_EQ(hosts.now_at(kWired), kWired);
  EXPECT_EQ(hosts.now_at(kWireless), kWireless);
}

// A process that joined late knows a host only as it is now. What comes over the loopback interface is of this host.
TEST(MovedHosts, ThatMovedBeforeTheyWereHeardAreReached) {
  MovedHosts hosts;
  hosts.set_own({kHere});
  hosts.heard(at({kWired}), kNew, kSecond_ns);
  EXPECT_EQ(hosts.now_at(kWired), kNew);
  hosts.heard(at({kWireless}), kLoopback, kSecond_ns);
  EXPECT_EQ(hosts.now_at(kWireless), kLoopback) << "which it had before";
  hosts.heard(at({kHere}), kLoopback, kSecond_ns);
  EXPECT_EQ(hosts.now_at(kHere), kHere);
  EXPECT_EQ(hosts.take_news().size(), 1U) << "the loopback interface is no news";
}

TEST(MovedHosts, AreForgottenBySilence) {
  MovedHosts hosts;
  hosts.set_own({kHere});
  hosts.heard(at({kWired}), kNew, kSecond_ns);
  for (Ipv4 host = 1; host <= 256; ++host)
    hosts.heard(at({kStranger + host}), kStranger + host, 2 * kSecond_ns + host);
  EXPECT_FALSE(hosts.any());
  EXPECT_EQ(hosts.now_at(kWired), kWired);
}

}  // namespace swiftlet::rtps::moved_hosts_test

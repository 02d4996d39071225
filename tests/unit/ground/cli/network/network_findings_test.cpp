#include "swiftlet/ground/cli/network/network_findings.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::ground::network_findings_test {

ground::ProbedHost good_host() {
  ground::ProbedHost host;
  host.name = "lab2";
  host.address = "10.0.0.2";
  host.multicast_heard = host.multicast_answered = true;
  host.sent = host.answered = 20;
  host.round_trip_min_ms = host.round_trip_median_ms = host.round_trip_max_ms = 0.2;
  return host;
}

NetworkFacts good_network() {
  NetworkFacts facts;
  facts.settings.open_network = true;
  facts.interfaces = {{"eth0", "10.0.0.1", false, true, 1500}};
  facts.probe.own_multicast = {"10.0.0.1"};
  facts.probe.hosts = {good_host()};
  return facts;
}

std::vector<std::string> sentences(const NetworkFacts& facts, bool faults) {
  std::vector<std::string> texts;
  for (const NetworkFinding& finding : findings(facts)) {
    if (finding.is_fault == faults) texts.push_back(finding.sentence);
  }
  return texts;
}
std::vector<std::string> faults(const NetworkFacts& facts) { return sentences(facts, true); }
std::vector<std::string> hints(const NetworkFacts& facts) { return sentences(facts, false); }

TEST(NetworkFindings, AreNoneInAGoodNetwork) { EXPECT_TRUE(findings(good_network()).empty()); }

TEST(NetworkFindings, TellInWhichDirectionMulticastFails) {
  NetworkFacts facts = good_network();
  facts.probe.hosts[0].multicast_heard = false;
  EXPECT_EQ(faults(facts),
            std::vector<std::string>{"multicast reaches lab2 (10.0.0.2), but none comes from there: "
                                     "look at its firewall"});
  facts.probe.hosts[0].multicast_answered = false;
  EXPECT_EQ(faults(facts),
            std::vector<std::string>{"no multicast between this host and lab2 (10.0.0.2): use --peer "
                                     "or --discovery-server"});
  facts.probe.hosts[0].multicast_heard = true;
  EXPECT_EQ(faults(facts),
            std::vector<std::string>{"multicast comes from lab2 (10.0.0.2), but none of this host is "
                                     "answered there: look at the firewall, and at IGMP snooping of "
                                     "the switch"});
  facts.settings.network.peers = {"lab2"};  // without multicast
  EXPECT_TRUE(findings(facts).empty());
}

TEST(NetworkFindings, NameAnInterfaceWithoutMulticast) {
  NetworkFacts facts = good_network();
  facts.probe.own_multicast.clear();
  EXPECT_EQ(faults(facts),
            std::vector<std::string>{"multicast that was sent on eth0 (10.0.0.1) did not come back: use "
                                     "--peer or --discovery-server"});
  facts.interfaces[0].has_multicast = false;
  EXPECT_NE(faults(facts).at(0).find("as the interface is set to carry none"), std::string::npos);
}

TEST(NetworkFindings, NameTheFirewallIfNothingIsAnswered) {
  NetworkFacts facts = good_network();
  facts.probe.hosts[0].answered = 0;
  EXPECT_EQ(faults(facts),
            std::vector<std::string>{"datagrams come from lab2 (10.0.0.2), but none is answered there: "
                                     "its firewall has to let UDP 7400 to 7649 and 7000 to 7399 "
                                     "through"});
  facts = good_network();
  facts.probe.silent_peers = {"10.0.0.9"};
  ASSERT_EQ(hints(facts).size(), 1U);
  EXPECT_EQ(hints(facts)[0].rfind("peer 10.0.0.9 did not answer: run `swiftlet doctor network` there", 0),
            0U);
}

TEST(NetworkFindings, HintAtLossDelayClockAndSize) {
  NetworkFacts facts = good_network();
  facts.interfaces[0].mtu_bytes = 1280;
  facts.probe.hosts[0].answered = 15;
  facts.probe.hosts[0].round_trip_median_ms = 25.0;
  facts.probe.hosts[0].clock_offset_ms = -1500.0;
  facts.probe.hosts[0].clock_steps = 1;
  EXPECT_TRUE(faults(facts).empty());
  EXPECT_EQ(hints(facts),
            (std::vector<std::string>{
                "eth0 has an MTU of 1280 bytes: longer datagrams are sent in fragments, and lost with "
                "each of them",
                "lab2 (10.0.0.2) lost 5 of 20 datagrams",
                "lab2 (10.0.0.2) answers after 25.0 ms: too late for control of a vehicle there",
                "the clock of lab2 (10.0.0.2) is -1500 ms off: logs do not compare; flights do not need "
                "it",
                "the clock of lab2 (10.0.0.2) stepped while it was measured: something sets it"}));
}

TEST(NetworkFindings, AreFaultsWithoutInterfaceOrAnswer) {
  NetworkFacts facts;
  facts.settings.open_network = true;
  facts.settings.domain = 5;
  const std::string nobody =
      ": no process, and no `swiftlet doctor network` on another host; check that it runs, with this domain "
      "(--domain, ROS_DOMAIN_ID) and the key of this process (--network-key, --security)";
  EXPECT_EQ(faults(facts), (std::vector<std::string>{
                               "no IPv4 address on an interface to other hosts that is up: they cannot be "
                               "reached; IPv6 is not used",
                               "nobody answers in domain 5" + nobody +
                                   "; in a network without multicast give --peer or --discovery-server"}));
  facts.settings.open_network = false;
  EXPECT_EQ(faults(facts),
            std::vector<std::string>{
                "nobody answers in domain 5 on the loopback interface (on the network too with "
                "--network-key, --security or --open-network)" +
                nobody});
  facts = good_network();
  facts.mismatches = {"rt/kl1/imu: control does not receive from plant: deadline"};
  facts.probe.silent_peers = {"10.0.0.9"};
  EXPECT_EQ(faults(facts), facts.mismatches);
  EXPECT_TRUE(findings(facts).front().is_fault);
}

TEST(NetworkFindings, NameAKeyInPlaceOfAFirewallOrAnEmptyNetwork) {
  NetworkFacts facts = good_network();
  facts.probe.hosts.clear();
  facts.probe.silent_peers = {"10.0.0.9"};
  facts.refused_keys = {"datagrams from 10.0.0.9 are refused, sealed with another network key"};
  EXPECT_EQ(faults(facts), facts.refused_keys);
  EXPECT_TRUE(hints(facts).empty());
  facts.processes = {{"control", "lab2", 7}};
  EXPECT_TRUE(faults(facts).empty());
  EXPECT_EQ(hints(facts), facts.refused_keys) << "of another network, perhaps";
}

}  // namespace swiftlet::ground::network_findings_test

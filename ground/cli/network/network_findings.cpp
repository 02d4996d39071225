#include "swiftlet/ground/cli/network/network_findings.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/services/dds/discovery/discovery_ports.hpp"
#include "swiftlet/services/dds/reach.hpp"

namespace swiftlet::ground {
namespace {

using ground::ProbedHost;

constexpr int kUsualMtu_bytes = 1500;
constexpr double kClockOffset_ms = 100.0;  // more confuses who compares logs
constexpr double kRoundTrip_ms = 10.0;     // a period of the motion capture

std::string ports_text(int domain) {
  const dds::DiscoveryPorts ports = dds::discovery_ports(domain);
  return fmt::format("UDP {} to {} and 7000 to 7399", ports.first - 10, ports.last() + 1);
}

void judge_interfaces(const NetworkFacts& facts, std::vector<NetworkFinding>& found) {
  const bool reaches_others = std::any_of(facts.interfaces.begin(), facts.interfaces.end(),
                                          [](const io::Interface& it) { return !it.is_loopback; });
  if (!reaches_others && !facts.settings.on_loopback())
    found.push_back({true,
                     "no IPv4 address on an interface to other hosts that is up: they cannot be reached; "
                     "IPv6 is not used"});
  for (const io::Interface& it : facts.interfaces) {
    if (it.mtu_bytes > 0 && it.mtu_bytes < kUsualMtu_bytes)
      found.push_back(
          {false, fmt::format("{} has an MTU of {} bytes: longer datagrams are sent in fragments, and "
                              "lost with each of them",
                              it.name, it.mtu_bytes)});
  }
}

bool uses_multicast(const NetworkFacts& facts) {
  return !facts.settings.on_loopback() && facts.settings.network.uses_multicast();
}

void judge_multicast(const NetworkFacts& facts, std::vector<NetworkFinding>& found) {
  if (!uses_multicast(facts)) return;
  const std::vector<std::string>& heard = facts.probe.own_multicast;
  for (const io::Interface& it : facts.interfaces) {
    if (!it.is_loopback && std::count(heard.begin(), heard.end(), it.address) == 0)
      found.push_back(
          {true, fmt::format("multicast that was sent on {} ({}) did not come back{}: use --peer or "
                             "--discovery-server",
                             it.name, it.address,
                             it.has_multicast ? "" : ", as the interface is set to carry none")});
  }
  for (const ProbedHost& host : facts.probe.hosts) {
    const std::string name = host.name + " (" + host.address + ")";
    if (!host.multicast_heard && !host.multicast_answered) {
      found.push_back(
          {true, "no multicast between this host and " + name + ": use --peer or --discovery-server"});
    } else if (!host.multicast_heard) {
      found.push_back(
          {true, "multicast reaches " + name + ", but none comes from there: look at its firewall"});
    } else if (!host.multicast_answered) {
      found.push_back({true, "multicast comes from " + name +
                                 ", but none of this host is answered there: look at "
                                 "the firewall, and at IGMP snooping of the switch"});
    }
  }
}

void judge_hosts(const NetworkFacts& facts, std::vector<NetworkFinding>& found) {
  for (const ProbedHost& host : facts.probe.hosts) {
    const std::string name = host.name + " (" + host.address + ")";
    if (host.answered == 0) {
      found.push_back({true, "datagrams come from " + name +
                                 ", but none is answered there: its firewall has to let " +
                                 ports_text(facts.settings.domain) + " through"});
      continue;
    }
    if (host.answered < host.sent)
      found.push_back(
          {false, fmt::format("{} lost {} of {} datagrams", name, host.sent - host.answered, host.sent)});
    if (host.round_trip_median_ms > kRoundTrip_ms)
      found.push_back(
          {false, fmt::format("{} answers after {:.1f} ms: too late for control of a vehicle there", name,
                              host.round_trip_median_ms)});
    if (std::abs(host.clock_offset_ms) > kClockOffset_ms)
      found.push_back(
          {false, fmt::format("the clock of {} is {:.0f} ms off: logs do not compare; flights do not need it",
                              name, host.clock_offset_ms)});
    if (host.clock_steps > 0)
      found.push_back({false, "the clock of " + name + " stepped while it was measured: something sets it"});
  }
  if (!facts.refused_keys.empty()) return;  // the peers may be silent for want of a key
  for (const std::string& peer : facts.probe.silent_peers)
    found.push_back(
        {false, "peer " + peer + " did not answer: run `swiftlet doctor network` there at the same time; " +
                    "if it runs, a firewall has to let " + ports_text(facts.settings.domain) + " through"});
}

}  // namespace

std::vector<NetworkFinding> findings(const NetworkFacts& facts) {
  std::vector<NetworkFinding> found;
  judge_interfaces(facts, found);
  judge_multicast(facts, found);
  judge_hosts(facts, found);
  // Beside processes that are found, they may be those of others.
  for (const std::string& refused : facts.refused_keys) found.push_back({facts.processes.empty(), refused});
  for (const std::string& mismatch : facts.mismatches) found.push_back({true, mismatch});
  if (facts.processes.empty() && facts.probe.hosts.empty() && facts.refused_keys.empty())
    found.push_back(
        {true, fmt::format("nobody answers in domain {}{}: no process, and no `swiftlet doctor network` on "
                           "another host; {}",
                           facts.settings.domain, dds::search_text(facts.settings),
                           dds::search_advice(facts.settings, {}))});
  std::stable_partition(found.begin(), found.end(), [](const NetworkFinding& it) { return it.is_fault; });
  return found;
}

}  // namespace swiftlet::ground

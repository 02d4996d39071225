#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/network/network_findings.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/io/network/host_address.hpp"

namespace swiftlet::ground {
namespace {

using nlohmann::ordered_json;

struct DoctorNetworkOptions {
  dds::NodeSettings network;
  double time_s = 3.0;
  bool json = false;
};

// With the options of the interface; otherwise all to other hosts.
std::vector<io::Interface> used_interfaces(const dds::NodeSettings& settings) {
  std::vector<io::Interface> used = io::interfaces_up();
  const std::vector<std::string>& chosen = settings.network.interfaces;
  const auto is_unused = [&](const io::Interface& it) {
    if (settings.on_loopback()) return !it.is_loopback;
    if (chosen.empty()) return it.is_loopback;
    return std::count(chosen.begin(), chosen.end(), it.name) +
               std::count(chosen.begin(), chosen.end(), it.address) ==
           0;
  };
  used.erase(std::remove_if(used.begin(), used.end(), is_unused), used.end());
  return used;
}

std::vector<std::string> peer_addresses(const dds::NetworkSettings& network) {
  std::vector<std::string> hosts;
  for (const std::string& peer : network.peers) hosts.push_back(io::parse_host_address(peer).host);
  if (!network.discovery_servers.empty()) {
    for (const auto& server : io::parse_discovery_servers(network.discovery_servers))
      hosts.push_back(server.address.host);
  }
  std::vector<std::string> addresses;
  for (const std::string& host : hosts) {
    for (const std::string& address : io::ipv4_addresses_of(host)) addresses.push_back(address);
  }
  return addresses;
}

NetworkFacts examine(const DoctorNetworkOptions& options) {
  NetworkFacts facts;
  facts.settings = options.network;
  facts.interfaces = used_interfaces(options.network);
  std::vector<std::string> addresses;
  for (const io::Interface& it : facts.interfaces) addresses.push_back(it.address);
  const dds::Participant participant(options.network);  // discovers while the probe runs
  ground::NetworkProbe probe(options.network.domain, addresses, peer_addresses(options.network.network));
  facts.probe = probe.run(std::chrono::milliseconds(static_cast<std::int64_t>(options.time_s * 1e3)));
  facts.processes = participant.processes_seen();
  facts.mismatches = participant.mismatches_seen();
  facts.refused_keys = participant.refused_keys();
  return facts;
}

const char* multicast_text(const ground::ProbedHost& host) {
  if (host.multicast_heard && host.multicast_answered) return "multicast both ways";
  if (host.multicast_heard) return "multicast from there only";
  return host.multicast_answered ? "multicast to there only" : "no multicast";
}

void print(const NetworkFacts& facts) {
  for (const io::Interface& it : facts.interfaces) {
    const auto& heard = facts.probe.own_multicast;
    fmt::print(
        "interface {} ({}): MTU {} bytes, multicast {}\n", it.name, it.address, it.mtu_bytes,
        std::count(heard.begin(), heard.end(), it.address) > 0 ? "sent and received" : "does not come back");
  }
  for (const ground::ProbedHost& host : facts.probe.hosts) {
    fmt::print("host {} ({}): {}; {} of {} datagrams answered", host.name, host.address, multicast_text(host),
               host.answered, host.sent);
    if (host.answered > 0) {
      fmt::print(
          ", round trip {:.3f} ms ({:.3f} to {:.3f}), its clock {:+.3f} ms (within {:.3f} ms), drift {:+.1f} "
          "ppm (within {:.1f} ppm)",
          host.round_trip_median_ms, host.round_trip_min_ms, host.round_trip_max_ms, host.clock_offset_ms,
          host.clock_uncertainty_ms, host.clock_drift_ppm, host.clock_drift_uncertainty_ppm);
    }
    fmt::print("\n");
  }
  for (const dds::ProcessIdentity& process : facts.processes) fmt::print("process {}\n", process.to_string());
  for (const NetworkFinding& finding : findings(facts))
    fmt::print("{}: {}\n", finding.is_fault ? "FAULT" : "hint", finding.sentence);
}

ordered_json to_json(const ground::ProbedHost& host) {
  ordered_json json = {{"host", host.name},
                       {"address", host.address},
                       {"multicast_from_there", host.multicast_heard},
                       {"multicast_to_there", host.multicast_answered},
                       {"sent", host.sent},
                       {"answered", host.answered},
                       {"round_trip_median_ms", nullptr},
                       {"round_trip_min_ms", nullptr},
                       {"round_trip_max_ms", nullptr},
                       {"clock_offset_ms", nullptr},
                       {"clock_uncertainty_ms", nullptr},
                       {"clock_drift_ppm", nullptr},
                       {"clock_drift_uncertainty_ppm", nullptr},
                       {"clock_steps", nullptr}};
  if (host.answered == 0) return json;
  json["round_trip_median_ms"] = host.round_trip_median_ms;
  json["round_trip_min_ms"] = host.round_trip_min_ms;
  json["round_trip_max_ms"] = host.round_trip_max_ms;
  json["clock_offset_ms"] = host.clock_offset_ms;
  json["clock_uncertainty_ms"] = host.clock_uncertainty_ms;
  json["clock_drift_ppm"] = host.clock_drift_ppm;
  json["clock_drift_uncertainty_ppm"] = host.clock_drift_uncertainty_ppm;
  json["clock_steps"] = host.clock_steps;
  return json;
}

ordered_json to_json(const NetworkFacts& facts) {
  ordered_json json = {{"domain", facts.settings.domain}};
  json["interfaces"] = ordered_json::array();
  for (const io::Interface& it : facts.interfaces) {
    const auto& heard = facts.probe.own_multicast;
    json["interfaces"].push_back({{"name", it.name},
                                  {"address", it.address},
                                  {"mtu_bytes", it.mtu_bytes},
                                  {"own_multicast", std::count(heard.begin(), heard.end(), it.address) > 0}});
  }
  json["hosts"] = ordered_json::array();
  for (const ground::ProbedHost& host : facts.probe.hosts) json["hosts"].push_back(to_json(host));
  json["processes"] = ordered_json::array();
  for (const dds::ProcessIdentity& it : facts.processes)
    json["processes"].push_back({{"name", it.name}, {"host", it.host}, {"process", it.pid}});
  json["faults"] = ordered_json::array();
  json["hints"] = ordered_json::array();
  for (const NetworkFinding& finding : findings(facts))
    json[finding.is_fault ? "faults" : "hints"].push_back(finding.sentence);
  return json;
}

int diagnose(const DoctorNetworkOptions& options) {
  const NetworkFacts facts = examine(options);
  if (options.json) {
    std::printf("%s\n", io::json_text(to_json(facts), 2).c_str());
  } else {
    print(facts);
  }
  const std::vector<NetworkFinding> found = findings(facts);
  return !found.empty() && found.front().is_fault ? io::kFailed : io::kDone;
}

}  // namespace

io::Command add_doctor_network_command(runtime::CommandLine doctor) {
  const auto options = std::make_shared<DoctorNetworkOptions>();
  const runtime::CommandLine app = doctor.add_subcommand(
      "network",
      "Examine the network: interfaces, multicast, processes, and other hosts that run this command");
  add_network_options(app, options->network);
  app.remove_option("--vehicle-name");
  app.add_option("--time", options->time_s, "duration, s").range(0.5, 600.0).show_default();
  app.add_flag("--json", options->json, "print the findings as JSON");
  app.footer(
      "Run it on two hosts at the same time, with the options of the network of the other processes: it "
      "measures "
      "multicast both ways, round trip, loss, and offset and drift of the clocks between them.\nExit code 1 "
      "if "
      "there is a "
      "fault.\nexample: swiftlet doctor network --time 10");
  return {app, [options] { return diagnose(*options); }};
}

}  // namespace swiftlet::ground

#include "swiftlet/services/dds/node_options.hpp"

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "swiftlet/io/config.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/network/host_address.hpp"
#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/io/network_key.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/dds/security/security_qos.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::dds {
namespace {

// ---- the network file

using io::ConfigNode;

constexpr std::size_t kMaxPeers = 64;  // each costs an announcement to 17 ports and more
constexpr std::size_t kMaxInterfaces = 16;

std::vector<std::string> texts(const ConfigNode& list, std::size_t max_count,
                               const std::function<std::string(const std::string&)>& fault_of) {
  std::vector<std::string> found;
  for (const ConfigNode& item : list.items(1, max_count)) {
    const std::string text = item.text();
    if (const std::string fault = fault_of(text); !fault.empty()) item.fail(fault);
    found.push_back(text);
  }
  return found;
}

void read_discovery(const ConfigNode& root, NodeSettings& settings) {
  const auto peers = root.find("peers");
  const auto servers = root.find("discovery_servers");
  if (peers && servers) servers->fail("excludes peers");
  if (!peers && !servers) return;
  settings.network.peers.clear();
  settings.network.discovery_servers.clear();
  if (peers) settings.network.peers = texts(*peers, kMaxPeers, io::fault_of_host_address);
  if (servers)
    settings.network.discovery_servers =
        io::joined(texts(*servers, io::kMaxDiscoveryServers, io::fault_of_host_address), ";");
}

std::string path_beside(const ConfigNode& file) {
  return std::filesystem::path(file.file()).parent_path() / file.text();
}

void read(const ConfigNode& root, NodeSettings& settings) {
  read_discovery(root, settings);
  if (const auto open = root.find("open_network")) settings.open_network = open->boolean();
  if (const auto interfaces = root.find("interfaces"))
    settings.network.interfaces = texts(*interfaces, kMaxInterfaces, io::fault_of_interface);
  if (const auto profile = root.find("dds_profile")) settings.network.dds_profile = path_beside(*profile);
  if (const auto key = root.find("network_key")) {
    settings.network_key_file = path_beside(*key);
    io::read_network_keys(settings.network_key_file);  // throws for an invalid one
  }
  if (const auto folder = root.find("security")) {
    settings.security = path_beside(*folder);
    const std::string fault = fault_of_security(settings.security, settings.name);
    if (!fault.empty()) folder->fail(fault);
  }
}

// ---- the options

std::string fault_of_key_file(const std::string& file) {
  try {
    io::read_network_keys(file);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

std::string environment(const char* variable) {
  const char* const value = std::getenv(variable);
  return value == nullptr ? "" : value;
}

// The variables by which ROS 2 is told where to look for others, and that of the own network.
void apply_environment(NodeSettings& settings) {
  settings.open_network = environment("SWIFTLET_OPEN_NETWORK") == "1";
  settings.network.peers.clear();
  settings.network.discovery_servers = environment("ROS_DISCOVERY_SERVER");
  if (!settings.network.discovery_servers.empty()) return;
  for (const std::string& peer : io::split_text(environment("ROS_STATIC_PEERS"), ';')) {
    if (!peer.empty()) settings.network.peers.push_back(peer);
  }
}

// Applies the file.
std::string fault_of_network_file(const std::string& file, NodeSettings& settings) {
  try {
    apply_network_file(io::read_text_file(file), file, settings);
    return "";
  } catch (const io::ConfigError& error) {
    return error.what();
  }
}

// The options of this host's network: each wins over the environment.
void add_network_options(runtime::CommandLine app, NodeSettings& settings) {
  runtime::Option localhost_only = app.add_flag(
      "--localhost-only",
      [&settings] {
        settings.localhost_only = true;
        settings.network.peers.clear();
        settings.network.discovery_servers.clear();
        settings.network.interfaces.clear();
      },
      "Use the loopback interface only, also with --network-key or --security");
  runtime::Option peer =
      app.add_option("--peer", settings.network.peers,
                     "Find the processes of this host without multicast; once for each other host; default: "
                     "$ROS_STATIC_PEERS");
  peer.repeated()
      .check(io::fault_of_host_address, "HOST[:PORT]")
      .excludes(localhost_only)
      .when_given([&settings] { settings.network.discovery_servers.clear(); });
  app.add_option("--discovery-server", settings.network.discovery_servers,
                 "Find the other processes by `swiftlet discovery-server` at this address (port 11811 unless "
                 "given), without multicast; default: $ROS_DISCOVERY_SERVER")
      .check(io::fault_of_discovery_servers, "HOST[:PORT]")
      .excludes(localhost_only)
      .excludes(peer)
      .when_given([&settings] { settings.network.peers.clear(); });
  app.add_option("--interface", settings.network.interfaces,
                 "Use this network interface, and that of the loopback, only; may be repeated")
      .repeated()
      .check(io::fault_of_interface, "NAME|ADDRESS")
      .excludes(localhost_only);
}

void add_profile_option(runtime::CommandLine app, NodeSettings& settings) {
  settings.network.dds_profile = environment("FASTDDS_DEFAULT_PROFILES_FILE");
  if (settings.network.dds_profile.empty())
    settings.network.dds_profile = environment("FASTRTPS_DEFAULT_PROFILES_FILE");
  app.add_option("--dds-profile", settings.network.dds_profile,
                 "Participant profile of Fast DDS: buffers, transport, properties; default: "
                 "$FASTDDS_DEFAULT_PROFILES_FILE or $FASTRTPS_DEFAULT_PROFILES_FILE")
      .type_name("FILE");
}

}  // namespace

void apply_network_file(std::string_view text, const std::string& file_name, NodeSettings& settings) {
  const ConfigNode root = io::parse_config(text, file_name);
  NodeSettings changed = settings;
  root.read_known([&] { read(root, changed); });
  settings = changed;
}

void add_node_options(runtime::CommandLine app, NodeSettings& settings, const NameCheck& name) {
  apply_environment(settings);
  // First, so that other options win over the file.
  app.add_option("--network", settings.network.file,
                 "File of the options of the network (YAML); other options win over it")
      .check([&settings](const std::string& file) { return fault_of_network_file(file, settings); }, "FILE");
  app.add_option("--domain", settings.domain, "DDS domain")
      .environment("ROS_DOMAIN_ID")
      .range(0, 232)
      .show_default();
  app.add_option("--vehicle-name", settings.vehicle, "Namespace of the topics")
      .show_default()
      .check(name.fault_of, name.value_name);
  add_network_options(app, settings);
  add_profile_option(app, settings);
  add_network_key_option(app, settings.network_key_file);
  app.add_flag("--open-network", settings.open_network,
               "Use the network without --network-key or --security: anyone in it can command the vehicles; "
               "default: the loopback interface only, unless $SWIFTLET_OPEN_NETWORK is 1")
      .excludes(app.option("--localhost-only"));
  app.add_option("--security", settings.security,
                 "Authenticate, encrypt, and let each role write its own topics only: folder made by "
                 "`swiftlet keys create`; not with --discovery-server")
      .environment("SWIFTLET_SECURITY")
      .excludes(app.option("--discovery-server"))
      .check(
          [process = settings.name](const std::string& given) { return fault_of_security(given, process); },
          "DIR");
}

void add_service_options(runtime::CommandLine app, NodeSettings& settings) {
  add_node_options(app, settings, {messages::fault_of_vehicle_list, "NAME[,NAME...]"});
  runtime::Option name = app.option("--vehicle-name");
  name.describe(name.description() + "; several as kl1,kl2 or kl1..kl4");
}

void add_network_key_option(runtime::CommandLine app, std::string& file) {
  app.add_option("--network-key", file,
                 "Key that all processes of the network share, made by `swiftlet keys network`")
      .environment("SWIFTLET_NETWORK_KEY")
      .check(fault_of_key_file, "FILE");
}

}  // namespace swiftlet::dds

#include "swiftlet/services/dds/network_file.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "swiftlet/io/config.hpp"
#include "swiftlet/io/network/host_address.hpp"
#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/io/network_key.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/dds/security/security_qos.hpp"

namespace swiftlet::comms {
namespace {

using runtime::ConfigNode;

constexpr std::size_t kMaxPeers = 64;  // each costs an announcement to 17 ports and more
constexpr std::size_t kMaxInterfaces = 16;

// At most one of the three.
constexpr const char* kLocalhostOnly = "localhost_only";
constexpr const char* kPeers = "peers";
constexpr const char* kDiscoveryServers = "discovery_servers";

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
  const auto local = root.find(kLocalhostOnly);
  const auto peers = root.find(kPeers);
  const auto servers = root.find(kDiscoveryServers);
  const bool localhost_only = local && local->boolean();
  if (localhost_only && peers) peers->fail("excludes localhost_only: true");
  if (localhost_only && servers) servers->fail("excludes localhost_only: true");
  if (peers && servers) servers->fail("excludes peers");
  if (!local && !peers && !servers) return;
  settings.localhost_only = localhost_only;
  settings.network.peers.clear();
  settings.network.discovery_servers.clear();
  if (peers) settings.network.peers = texts(*peers, kMaxPeers, runtime::fault_of_host_address);
  if (servers)
    settings.network.discovery_servers =
        runtime::joined(texts(*servers, runtime::kMaxDiscoveryServers, runtime::fault_of_host_address), ";");
}

std::string path_beside(const ConfigNode& file) {
  return std::filesystem::path(file.file()).parent_path() / file.text();
}

void read(const ConfigNode& root, NodeSettings& settings) {
  read_discovery(root, settings);
  if (const auto open = root.find("open_network")) {
    settings.open_network = open->boolean();
    if (settings.open_network && settings.localhost_only) open->fail("excludes localhost_only: true");
  }
  if (const auto interfaces = root.find("interfaces")) {
    if (settings.localhost_only) interfaces->fail("excludes localhost_only: true");
    settings.network.interfaces = texts(*interfaces, kMaxInterfaces, runtime::fault_of_interface);
  }
  if (const auto profile = root.find("dds_profile")) settings.network.dds_profile = path_beside(*profile);
  if (const auto key = root.find("network_key")) {
    settings.network_key_file = path_beside(*key);
    runtime::read_network_keys(settings.network_key_file);  // throws for an invalid one
  }
  if (const auto folder = root.find("security")) {
    settings.security = path_beside(*folder);
    const std::string fault = fault_of_security(settings.security, settings.name);
    if (!fault.empty()) folder->fail(fault);
  }
}

}  // namespace

void apply_network_file(std::string_view text, const std::string& file_name, NodeSettings& settings) {
  const ConfigNode root = runtime::parse_config(text, file_name);
  NodeSettings changed = settings;
  root.read_known([&] { read(root, changed); });
  settings = changed;
}

void load_network_file(const std::string& path, NodeSettings& settings) {
  apply_network_file(runtime::read_text_file(path), path, settings);
}

}  // namespace swiftlet::comms

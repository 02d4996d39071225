#include "swiftlet/services/dds/discovery/discovery_servers.hpp"

#include <algorithm>
#include <cstddef>

#include "swiftlet/services/runtime/split_text.hpp"

namespace swiftlet::comms {

std::string fault_of_discovery_servers(const std::string& list) {
  const std::vector<std::string> parts = runtime::split_text(list, ';');
  const bool valid = std::all_of(parts.begin(), parts.end(), [](const std::string& part) {
    return part.empty() || fault_of_host_address(part).empty();
  });
  const bool has_one =
      std::any_of(parts.begin(), parts.end(), [](const std::string& part) { return !part.empty(); });
  if (valid && has_one && parts.size() <= kMaxDiscoveryServers) return "";
  return "is '" + list +
         "', must be HOST or HOST:PORT, a name or IPv4 address and a port from 1 to 65535; several, "
         "separated "
         "by ';', are the servers 0, 1, ...";
}

std::vector<DiscoveryServerAddress> parse_discovery_servers(const std::string& list) {
  std::vector<DiscoveryServerAddress> servers;
  const std::vector<std::string> parts = runtime::split_text(list, ';');
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) continue;
    HostAddress address = parse_host_address(parts[i]);
    if (address.port == 0) address.port = kDiscoveryServerPort;
    servers.push_back({static_cast<int>(i), address});
  }
  return servers;
}

}  // namespace swiftlet::comms

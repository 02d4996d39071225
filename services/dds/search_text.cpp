#include "swiftlet/services/dds/search_text.hpp"

#include <vector>

namespace swiftlet::comms {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

std::string search_text(const NodeSettings& settings) {
  if (settings.localhost_only) return " on the loopback interface";
  const NetworkSettings& network = settings.network;
  std::string text;
  if (!network.peers.empty()) {
    text = " at the peers " + listed(network.peers);
  } else if (!network.discovery_servers.empty()) {
    text = " by the discovery server " + network.discovery_servers;
  }
  if (!network.interfaces.empty()) text += " on " + listed(network.interfaces);
  return text;
}

}  // namespace swiftlet::comms

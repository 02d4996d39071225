#include "swiftlet/services/dds/reach.hpp"

#include <vector>

#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::comms {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

std::string search_text(const NodeSettings& settings) {
  if (settings.on_loopback())
    return settings.localhost_only
               ? " on the loopback interface"
               : " on the loopback interface (--network-key FILE or --open-network: on the network too)";
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

void log_reach(const NodeSettings& settings) {
  if (settings.localhost_only || !settings.network_key_file.empty() || !settings.security.empty()) return;
  if (settings.open_network) {
    std::vector<std::string> others;
    for (const runtime::Interface& it : runtime::interfaces_up())
      if (!it.is_loopback) others.push_back(it.name);
    runtime::log_warning("--open-network: who is in the network of {} can command these vehicles",
                         others.empty() ? "the loopback interface" : listed(others));
  } else {
    runtime::log_info("on this host only: --network-key FILE or --security DIR opens the network");
  }
}

}  // namespace swiftlet::comms

#include "swiftlet/services/dds/reach.hpp"

#include <vector>

#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/log_label.hpp"

namespace swiftlet::dds {

std::string search_text(const NodeSettings& settings) {
  if (settings.on_loopback())
    return settings.localhost_only ? " on the loopback interface"
                                   : " on the loopback interface (on the network too with --network-key, "
                                     "--security or --open-network)";
  const NetworkSettings& network = settings.network;
  std::string text;
  if (!network.peers.empty()) {
    text = " at the peers " + io::joined(network.peers, ", ");
  } else if (!network.discovery_servers.empty()) {
    text = " by the discovery server " + network.discovery_servers;
  }
  if (!network.interfaces.empty()) text += " on " + io::joined(network.interfaces, ", ");
  return text;
}

std::string search_advice(const NodeSettings& settings, const std::vector<std::string>& refused_keys) {
  if (!refused_keys.empty()) return io::joined(refused_keys, "; ");
  std::string advice =
      "check that it runs, with this domain (--domain, ROS_DOMAIN_ID) and the key of this process "
      "(--network-key, --security)";
  if (!settings.on_loopback() && settings.network.uses_multicast())
    advice += "; in a network without multicast give --peer or --discovery-server";
  return advice;
}

void log_reach(const NodeSettings& settings) {
  if (settings.localhost_only || !settings.network_key_file.empty() || !settings.security.empty()) return;
  if (settings.open_network) {
    std::vector<std::string> others;
    for (const io::Interface& it : io::interfaces_up())
      if (!it.is_loopback) others.push_back(it.name);
    runtime::log_warning("--open-network: who is in the network of {} can command these vehicles",
                         others.empty() ? "the loopback interface" : io::joined(others, ", "));
  } else {
    runtime::log_info("on this host only: --network-key FILE or --security DIR opens the network");
  }
}

void log_peers(Node& node) {
  node.on_peer([own = runtime::LogLabel::current()](const PeerEvent& event) {
    const runtime::LogLabel label(own);
    if (event.alive) {
      runtime::log_info("{} joined", event.name);
    } else if (event.said_goodbye) {
      runtime::log_info("{} left", event.name);
    } else {
      runtime::log_warning("{} died or was cut off", event.name);
    }
  });
}

}  // namespace swiftlet::dds

#include "swiftlet/ground/client/network_options.hpp"

#include <filesystem>

#include "swiftlet/services/dds/node_options.hpp"

namespace swiftlet::ground {

void add_network_options(runtime::CommandLine app, dds::NodeSettings& network, Vehicles vehicles) {
  network.name = "ground";
  if (vehicles == Vehicles::kOne) return dds::add_node_options(app, network);
  dds::add_service_options(app, network);
}

std::vector<std::string> network_arguments(const dds::NodeSettings& network) {
  std::vector<std::string> arguments = {"--domain", std::to_string(network.domain)};
  const auto append = [&arguments](const char* option, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {option, value});
  };
  const auto absolute = [](const std::string& file) {
    return file.empty() ? file : std::filesystem::absolute(file).string();
  };
  if (network.on_loopback()) {
    arguments.emplace_back("--localhost-only");
  } else {
    if (network.open_network) arguments.emplace_back("--open-network");
    for (const std::string& peer : network.network.peers) append("--peer", peer);
    append("--discovery-server", network.network.discovery_servers);
    for (const std::string& interface : network.network.interfaces) append("--interface", interface);
  }
  append("--dds-profile", absolute(network.network.dds_profile));
  append("--network-key", absolute(network.network_key_file));
  append("--security", absolute(network.security));
  return arguments;
}

}  // namespace swiftlet::ground

#include "swiftlet/ground/command_line/network_options.hpp"

#include "swiftlet/services/dds/node_options.hpp"

namespace swiftlet::ground {

void add_network_options(runtime::CommandLine app, comms::NodeSettings& network, Vehicles vehicles) {
  network.name = "ground";
  if (vehicles == Vehicles::kOne) return comms::add_node_options(app, network);
  comms::add_service_options(app, network);
}

std::string to_string(comms::Transport transport) {
  return transport == comms::Transport::kSharedMemory ? "shm" : "udp";
}

}  // namespace swiftlet::ground

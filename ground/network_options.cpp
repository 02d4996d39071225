#include "ground/network_options.hpp"

#include <CLI/CLI.hpp>

#include "services/comms/node_options.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::size_t kMaxName = 64;
constexpr const char* kNameCharacters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

std::string fault_of_name(const std::string& name) {
  const bool plain = name.find_first_not_of(kNameCharacters) == std::string::npos;
  return plain && !name.empty() && name.size() <= kMaxName ? "" : "must be 1 to 64 letters, digits and _";
}

}  // namespace

void add_network_options(CLI::App& app, comms::NodeSettings& network) {
  network.name = "ground";
  comms::add_node_options(app, network);
  app.get_option("--vehicle-name")->check(CLI::Validator(fault_of_name, "NAME"));
}

std::string to_string(comms::Transport transport) {
  return transport == comms::Transport::kSharedMemory ? "shm" : "udp";
}

}  // namespace swiftlet::ground

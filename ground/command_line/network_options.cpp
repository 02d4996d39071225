#include "swiftlet/ground/command_line/network_options.hpp"

#include <algorithm>

#include "swiftlet/services/dds/node_options.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::size_t kMaxName = 64;
constexpr const char* kNameCharacters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

std::string fault_of_name(const std::string& name) {
  const bool plain = name.find_first_not_of(kNameCharacters) == std::string::npos;
  return plain && !name.empty() && name.size() <= kMaxName ? "" : "must be 1 to 64 letters, digits and _";
}

std::string fault_of_names(const std::string& list) {
  const std::vector<std::string> names = split_list(list);
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (const std::string fault = fault_of_name(*name); !fault.empty()) return "each name " + fault;
    if (std::find(names.begin(), name, *name) != name) return "names " + *name + " twice";
  }
  return "";
}

}  // namespace

void add_network_options(runtime::CommandLine app, comms::NodeSettings& network, Vehicles vehicles) {
  network.name = "ground";
  comms::add_node_options(app, network);
  runtime::Option name = app.option("--vehicle-name");
  if (vehicles == Vehicles::kOne) {
    name.check(fault_of_name, "NAME");
  } else {
    name.check(fault_of_names, "NAME[,NAME...]");
    name.describe(name.description() + "; separate several names with commas");
  }
}

std::vector<std::string> split_list(const std::string& list) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t comma = list.find(','); comma != std::string::npos; comma = list.find(',', begin)) {
    parts.push_back(list.substr(begin, comma - begin));
    begin = comma + 1;
  }
  parts.push_back(list.substr(begin));
  return parts;
}

std::string to_string(comms::Transport transport) {
  return transport == comms::Transport::kSharedMemory ? "shm" : "udp";
}

}  // namespace swiftlet::ground

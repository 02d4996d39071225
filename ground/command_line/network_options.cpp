#include "swiftlet/ground/command_line/network_options.hpp"

#include <algorithm>

#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/dds/vehicle_name.hpp"

namespace swiftlet::ground {
namespace {

std::string fault_of_names(const std::string& list) {
  const std::vector<std::string> names = split_list(list);
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (const std::string fault = comms::fault_of_vehicle_name(*name); !fault.empty())
      return "each name " + fault;
    if (std::find(names.begin(), name, *name) != name) return "names " + *name + " twice";
  }
  return "";
}

}  // namespace

void add_network_options(runtime::CommandLine app, comms::NodeSettings& network, Vehicles vehicles) {
  network.name = "ground";
  if (vehicles == Vehicles::kOne) return comms::add_node_options(app, network);
  comms::add_node_options(app, network, {fault_of_names, "NAME[,NAME...]"});
  runtime::Option name = app.option("--vehicle-name");
  name.describe(name.description() + "; separate several names with commas");
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

// The command-line options of every program that joins the network.
#pragma once

#include <functional>
#include <string>

#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::comms {

// The check of --vehicle-name, as for runtime::Option::check().
struct NameCheck {
  std::function<std::string(const std::string&)> fault_of = fault_of_vehicle_name;
  std::string value_name = "NAME";
};

// --domain (default $ROS_DOMAIN_ID or 0), --vehicle-name; --localhost-only (default $ROS_LOCALHOST_ONLY, or
// $ROS_AUTOMATIC_DISCOVERY_RANGE), --network, --peer (default $ROS_STATIC_PEERS), --discovery-server (default
// $ROS_DISCOVERY_SERVER), --interface,
// --dds-profile (default $FASTDDS_DEFAULT_PROFILES_FILE, else $FASTRTPS_DEFAULT_PROFILES_FILE), --network-key
// (default $SWIFTLET_NETWORK_KEY), --open-network (default
// $SWIFTLET_OPEN_NETWORK), --security (default $SWIFTLET_SECURITY).
void add_node_options(runtime::CommandLine app, NodeSettings& settings, const NameCheck& name = {});

// The same for a program that serves vehicles: --vehicle-name takes a list (vehicle_names.hpp), which it leaves in
// settings.vehicle.
void add_service_options(runtime::CommandLine app, NodeSettings& settings);

// --network-key alone.
void add_network_key_option(runtime::CommandLine app, std::string& file);

}  // namespace swiftlet::comms
